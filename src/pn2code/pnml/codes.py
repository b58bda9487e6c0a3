"""Diagnostic codes of PNML files."""

from pn2code.diagnostics.codes import register

NOT_PNML = register(
    "not-pnml",
    "the file is XML but not a PNML net",
    "The root element of a .pnml file is `pnml`, with a `net` inside.",
)
PNML_ELEMENT = register(
    "pnml-element",
    "an element of the PNML file is not as ISO/IEC 15909-2 demands",
    "An element lacks an attribute or a child that it needs, or has one with an impossible value: a "
    "place without id, a tuple with too few parts, a weight that is no positive number.",
)
PNML_UNKNOWN_ELEMENT = register(
    "pnml-unknown-element",
    "an element of the PNML file is not known",
    "pn2code does not know this XML element and ignores it. Each kind of unknown element is reported once. "
    "What belongs to one tool only stands inside `toolspecific` and is passed over silently.",
)
PNML_NET_TYPE = register(
    "pnml-net-type",
    "the type of the PNML net is not known",
    "The attribute `type` of `net` says which kind of net follows: place/transition nets (`ptnet`), "
    "symmetric nets (`symmetricnet`), high-level nets (`highlevelnet`, `pt-hlpng`). Another one is read "
    "by what its places have: a `type` makes it a high-level net.",
)
PNML_REFERENCE = register(
    "pnml-reference",
    "a reference of the PNML file leads nowhere",
    "Sorts, variables, operators, and the nodes that reference places and transitions stand for are named "
    "by their ids. Nothing suitable has this id.",
)
PNML_SORT = register(
    "pnml-sort",
    "a term of the PNML net has another sort than its place or operator demands",
    "The terms on arcs and in initial markings are multi-sets over the sort of their place, conditions are "
    "Boolean, and each operator has its own demands: `successor` wants an element of an enumeration, "
    "`lessthan` two of the same sort.",
)
PNML_SEVERAL_NETS = register(
    "pnml-several-nets",
    "a PNML file has more than one net",
    "A PNML file may hold several nets. pn2code reads the first.",
)
UNSUPPORTED_PNML = register(
    "unsupported-pnml",
    "a feature of PNML is not supported",
    "Place/transition nets and symmetric nets are read completely, of high-level nets what has numbers, Booleans, "
    "enumerations, products and multi-sets. Lists, strings and sorts without definition are not translated.",
)
