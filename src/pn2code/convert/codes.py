"""Diagnostic codes of converting nets."""

from pn2code.diagnostics.codes import register

UNSUPPORTED_IN_PNML = register(
    "unsupported-in-pnml",
    "the net has something that symmetric nets cannot express",
    "PNML has place/transition nets and symmetric nets: colour sets that are enumerations, integer ranges, Booleans, "
    "unit and products of these; on arcs sums of tuples of variables, constants, successors and predecessors; guards "
    "that compare such values. `--unfold` writes any net with finitely many colours as a place/transition net.",
)
UNSUPPORTED_IN_PROMELA = register(
    "unsupported-in-promela",
    "the net has something that its Promela model cannot express",
    "The Promela model of a net counts tokens: the numbers of tokens must fit into its variables, and transitions "
    "have no priorities.",
)
UNSUPPORTED_IN_CPN = register(
    "unsupported-in-cpn",
    "the net cannot be written as a file of CPN Tools",
    "A .cpn file is written from a PNML net or a net as text. Nets that are already .cpn files are not rewritten.",
)
CONVERT_FORMAT = register(
    "convert-format",
    "the format to convert to is not known",
    "`pn2code convert` chooses the format by the ending of the output file: `.pnml`, `.pml` (SPIN), `.cpn` or `.cpnt` "
    "(text).",
)
