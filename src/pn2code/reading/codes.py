"""Diagnostic codes of reading files."""

from pn2code.diagnostics.codes import register

FILE_MISSING = register(
    "file-missing",
    "a file is missing",
    "The file or folder given on the command line does not exist.",
)
FILE_UNREADABLE = register(
    "file-unreadable",
    "the file cannot be read",
    "The operating system refused: the path is a directory or a device, or permission is missing. "
    "The message gives the reason in the system's words.",
)
FILE_TOO_LARGE = register(
    "file-too-large",
    "the file is larger than any net",
    "Real nets have a few megabytes at most (the largest of more than a thousand collected nets has "
    "3.6 MB). Larger files are refused before they are parsed, so that a wrong or hostile file "
    "cannot fill the memory.",
)
TOO_MANY = register(
    "too-many-messages",
    "there are too many messages",
    "After ten thousand messages about one file pn2code gives up: it is not the right kind of file, or one mistake in "
    "a declaration must be corrected first.",
)
XML_SYNTAX = register(
    "xml-syntax",
    "the file is not well-formed XML",
    "A .cpn file is XML. The message gives the position of the first mistake as the XML parser reports it.",
)
XML_TRUNCATED = register(
    "xml-truncated",
    "the file ends too early",
    "The file ends while elements are still open: it was cut off, perhaps by an interrupted copy or a full disk.",
)
XML_ENTITY = register(
    "xml-entity",
    "the file declares or uses an XML entity of its own",
    "CPN Tools never writes entity declarations. Entities can read other files or grow to gigabytes "
    '("billion laughs"), so pn2code refuses every declaration and every use of an entity other than '
    "the five of XML (&lt; &gt; &amp; &apos; &quot;).",
)
XML_LIMIT = register(
    "xml-limit",
    "the XML is nested too deeply, or has too many elements or too long texts",
    "Nets of CPN Tools are nested about ten levels deep, have some ten thousand elements, and texts of some thousand "
    "characters. Files far beyond this are refused, so that a hostile file cannot fill memory or stack.",
)
NOT_CPN = register(
    "not-cpn",
    "the file is XML but not a CPN Tools net",
    "The root element of a .cpn file is `workspaceElements`, with a `cpnet` inside.",
)
CPN_ELEMENT = register(
    "cpn-element",
    "an element of the .cpn file is not as CPN Tools writes it",
    "An element lacks an attribute or a child that it needs, or has one with an impossible value: a "
    "place without id, an arc without ends. The file was probably edited by hand or written by "
    "another program.",
)
CPN_UNKNOWN_ELEMENT = register(
    "cpn-unknown-element",
    "an element of the .cpn file is not known",
    "pn2code does not know this XML element and ignores it. Each kind of unknown element is reported once.",
)
CPN_STRAY_TEXT = register(
    "cpn-stray-text",
    "a text of the .cpn file is not where texts are read",
    "The texts of a place, a transition or an inscription are in a `text` element of their own, as in "
    "<initmark><text>1`3</text></initmark>. Text written directly into the element is not read: the place "
    "has no initial marking then. Each kind of element is reported once.",
)
CPN_FORMAT = register(
    "cpn-format",
    "the format number of the .cpn file is not known",
    "CPN Tools has written the formats 2 to 6. Another number is read like format 6.",
)
DUPLICATE_ID = register(
    "duplicate-id",
    "two elements of the net have the same id",
    "Arcs, fusion sets and substitution transitions refer to elements by id, so pages, places and "
    "transitions need different ones. Nothing refers to arcs: two of one id both count. Of two "
    "declarations of one id CPN Tools forgets the first when it reads the second.",
)
ARC_DANGLING = register(
    "arc-dangling",
    "an arc leads to something that does not exist on its page",
    "Each arc names a place and a transition of its own page by id (`placeend`, `transend`). The id "
    "is missing, or no such place or transition is on the page. An arc of which the transition is "
    "nowhere in the file is left over from one that was removed, and is left out.",
)
ARC_ORIENTATION = register(
    "arc-orientation",
    "the orientation of an arc is not known",
    "Arcs are oriented PtoT, TtoP, BOTHDIR, Inhibitor or Reset.",
)
UNSUPPORTED_CONSTRAINT = register(
    "unsupported-constraint",
    "declarative constraints are not supported",
    "CPN Tools 4 can restrict the order of transitions on a page by declarative constraints. "
    "pn2code has no translation for them yet.",
)
