"""XML, read without trust: bytes in, a tree of `Node`s with exact positions out.

Two parsers see the same bytes. First `xml.parsers.expat` walks through: it refuses entities,
excessive depth and excessive numbers of elements before anything is built, and notes line and
column of every element and of every run of characters (lxml knows only an element's line). Then
lxml builds the tree, with DTD loading, network access and entity resolution switched off.

Example: `<text>1`x &lt; 2</text>` at line 3, column 1 gives a node with text ``1`x < 2`` whose
`source` knows that `<` stands at column 11 and ` 2` at column 15.
"""

from __future__ import annotations

import stat
import sys
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from lxml import etree

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.reading.codes import (
    FILE_MISSING,
    FILE_TOO_LARGE,
    FILE_UNREADABLE,
    XML_ENTITY,
    XML_LIMIT,
    XML_SYNTAX,
    XML_TRUNCATED,
)

MAX_BYTES = 100 * 1024 * 1024
MAX_DEPTH = 200  # below libxml2's own limit of 256
MAX_ELEMENTS = 800_000
"""The largest real net seen has 50,000; one of 10,000 places some 500,000."""
MAX_SPACE = 5_000_000
"""Characters of white space at the beginning of one element; libxml2 refuses 10 million."""
MAX_TEXT = 250_000
"""Characters of one text or of the attributes of one element; the longest of real nets have some thousand."""

_SIGNATURES = {
    b"\x89PNG": "a picture (PNG)",
    b"\xff\xd8\xff": "a picture (JPEG)",
    b"%PDF": "a PDF document",
    b"PK\x03\x04": "a ZIP archive",
    b"\x1f\x8b": "a compressed file (gzip)",
    b"\x7fELF": "a program",
    b"MZ": "a program",
}
"""How files begin that are given by mistake."""

Marks = tuple[tuple[int, int, int], ...]


@dataclass(slots=True)
class Node:
    """An element.

    Args:
        tag: its name.
        attributes: as written.
        children: elements in order.
        text: all characters directly inside, those around children joined; not white space at the beginning.
        line, column: of its `<`.
        marks: positions of `text`, as in `SourceText`.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    column: int
    text: str = ""
    marks: Marks = ()
    children: list[Node] = field(default_factory=list)

    def child(self, tag: str) -> Node | None:
        """The first child with a tag."""
        return next((c for c in self.children if c.tag == tag), None)

    def all(self, tag: str) -> list[Node]:
        """All children with a tag."""
        return [c for c in self.children if c.tag == tag]

    def get(self, name: str, default: str = "") -> str:
        """An attribute, trimmed."""
        return self.attributes.get(name, default).strip()

    def at(self, base: Origin) -> Origin:
        """`base` moved to the element's position."""
        return Origin(
            base.file, self.line, self.column, base.page, base.element, base.element_id, base.part
        )

    def source(self, base: Origin) -> SourceText:
        """The text without surrounding white space, its origin being `base` moved to the first character."""
        text = self.text
        start = len(text) - len(text.lstrip())
        whole = SourceText(text, self.at(base), self.marks)
        line, column = whole.position(start)
        origin = Origin(
            base.file, line, column, base.page, base.element, base.element_id, base.part
        )
        marks = [(0, line, column)]
        marks += [(o - start, ln, col) for o, ln, col in self.marks if o > start]
        return SourceText(text.strip(), origin, tuple(marks))


def read_bytes(path: Path, d: Diagnostics) -> bytes | None:
    """The bytes of a regular file of at most `MAX_BYTES`."""
    origin = Origin(str(path))
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            kind = "a directory" if stat.S_ISDIR(status.st_mode) else "not a regular file"
            d.error(FILE_UNREADABLE, f"`{path}` is {kind}", origin, hint="name a .cpn file")
            return None
        with path.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        d.error(FILE_MISSING, f"there is no file `{path}`", origin, hint="check the path")
        return None
    except (OSError, ValueError) as e:  # ValueError: a null character in the path
        reason = e.strerror if isinstance(e, OSError) and e.strerror else str(e)
        d.error(FILE_UNREADABLE, f"cannot read `{path}`: {reason.lower()}", origin)
        return None
    if len(data) > MAX_BYTES:
        d.error(
            FILE_TOO_LARGE,
            f"`{path}` has {status.st_size:,} bytes, more than the {MAX_BYTES:,} allowed",
            origin,
            hint="real nets have a few megabytes at most: is this the right file?",
        )
        return None
    return data


def parse(data: bytes, file: str, d: Diagnostics) -> Node | None:
    """The root element of a document; errors are reported with line and column."""
    if not data.strip():
        d.error(XML_TRUNCATED, "the file is empty", Origin(file), hint="save the net again")
        return None
    places = _Surveyor(file, d).survey(data)
    if places is None:
        return None
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        attribute_defaults=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
        recover=False,
    )
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as e:
        line, column = e.position
        if "HUGE" in str(e.msg):
            d.error(
                XML_LIMIT,
                "a text is too long for the XML parser",
                Origin(file, line, column),
                hint="no net of CPN Tools has this: the file is damaged or hostile",
            )
            return None
        d.error(XML_SYNTAX, f"not well-formed XML: {_lower(e.msg)}", Origin(file, line, column))
        return None
    return _build(root, places)


def _lower(message: str | None) -> str:
    text = (message or "syntax error").strip().rstrip(".")
    return text[:1].lower() + text[1:]


def _build(root: etree._Element, places: list[_Place]) -> Node:
    """The `Node` tree of an lxml tree; `places` is in document order, as is `root.iter()`."""
    nodes: list[Node] = []
    used = _Place(0, -1, 0, 0)
    for number, element in enumerate(root.iter()):
        place = places[number]
        places[number] = used  # large nets need the memory
        text = ""
        if place.length:  # most elements hold other elements only, with white space between
            text = (element.text or "") + "".join(child.tail or "" for child in element)
        node = Node(
            sys.intern(str(element.tag)),
            dict(element.attrib),  # type: ignore[arg-type]
            place.line,
            place.column,
            text[place.skipped :],
            tuple(place.marks or ()),
        )
        nodes.append(node)
        if place.parent >= 0:
            nodes[place.parent].children.append(node)
    assert len(nodes) == len(places), "both parsers see the same elements"
    return nodes[0]


@dataclass(slots=True)
class _Place:
    """Where an element stands, and marks of its direct text; the rest is the state of the survey.

    Args:
        number: of the element, in document order; parent: that of the element around it, -1 for the root.
        skipped: characters of white space before the text; length: of the text without them.
    """

    number: int
    parent: int
    line: int
    column: int
    marks: list[tuple[int, int, int]] | None = None
    skipped: int = 0
    length: int = 0
    expected: tuple[int, int] = (0, 0)


class _RefusedError(Exception):
    """Ends a survey; the diagnostic has been reported."""


class _Surveyor:
    """The first pass: positions, and refusal of what is hostile."""

    def __init__(self, file: str, d: Diagnostics) -> None:
        self.file = file
        self.d = d
        self.places: list[_Place] = []
        self.open: list[_Place] = []
        self.tags: list[str] = []
        self.parser = expat.ParserCreate()
        self.parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._characters
        self.parser.EntityDeclHandler = self._entity_declaration
        self.parser.SkippedEntityHandler = self._skipped_entity
        self.parser.ExternalEntityRefHandler = self._external_entity

    def survey(self, data: bytes) -> list[_Place] | None:
        try:
            self.parser.Parse(data, True)
        except _RefusedError:
            return None
        except expat.ExpatError as e:
            self._syntax_error(e.code, e.lineno, e.offset + 1, data)
            return None
        except (LookupError, ValueError) as e:
            # pyexpat asks Python for encodings that expat does not know.
            self.d.error(
                XML_SYNTAX,
                f"the character encoding that the file declares is not known: {_lower(str(e))}",
                self._here(),
                hint="CPN Tools writes iso-8859-1",
            )
            return None
        return self.places

    def _here(self) -> Origin:
        return Origin(self.file, self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1)

    def _syntax_error(self, code: int, line: int, column: int, data: bytes) -> None:
        origin = Origin(self.file, line, column)
        ends = {
            expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS],
            expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_TOKEN],
            expat.errors.codes[expat.errors.XML_ERROR_PARTIAL_CHAR],
            expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION],
        }
        if code in ends and (self.places or data.lstrip().startswith(b"<")):
            inside = " in the middle of an element" if self.places else " before its first element"
            if self.tags:
                inside = f" inside element `{self.tags[-1]}`"
            self.d.error(
                XML_TRUNCATED,
                f"the file ends too early,{inside}",
                origin,
                notes=[f"element `{self.tags[-1]}` begins on line {self.open[-1].line}"]
                if self.tags
                else [],
                hint="the file was cut off: save or copy the net again",
            )
            return
        if code == expat.errors.codes[expat.errors.XML_ERROR_UNDEFINED_ENTITY]:
            self.d.error(XML_ENTITY, "the file uses an undeclared XML entity", origin)
            return
        words, hint = self._explain(code, data)
        notes = []
        if code == expat.errors.codes[expat.errors.XML_ERROR_TAG_MISMATCH] and self.tags:
            notes = [f"element `{self.tags[-1]}` begins on line {self.open[-1].line}"]
        self.d.error(XML_SYNTAX, f"not well-formed XML: {words}", origin, notes=notes, hint=hint)

    def _explain(self, code: int, data: bytes) -> tuple[str, str]:
        """A syntax error in words, and what to do."""
        words = expat.ErrorString(code) or "syntax error"
        hint = "a .cpn file is XML: is this a net saved by CPN Tools?"
        errors = expat.errors
        if not self.places:
            for start, what in _SIGNATURES.items():
                if data.startswith(start):
                    return f"this is {what}", "give the .cpn file itself"
        if code == errors.codes[errors.XML_ERROR_TAG_MISMATCH] and self.tags:
            words = f"element `{self.tags[-1]}` is not closed before the end of another one"
            hint = "the file was edited by hand or damaged: save the net again in CPN Tools"
        elif code == errors.codes[errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT]:
            words = "something follows after the end of the root element"
            hint = "a .cpn file has one root element, `workspaceElements`; remove what follows it"
        elif code == errors.codes[errors.XML_ERROR_INVALID_TOKEN] and self.places:
            return self._invalid(data)
        elif code == errors.codes[errors.XML_ERROR_DUPLICATE_ATTRIBUTE]:
            words = "an element has the same attribute twice"
            hint = "remove one of them"
        return words, hint

    def _invalid(self, data: bytes) -> tuple[str, str]:
        """For a byte that cannot stand where it does."""
        at = self.parser.ErrorByteIndex
        byte = data[at : at + 1]
        before = data[max(0, at - 1) : at]
        if before == b"&" or byte == b"&":
            return "`&` stands for itself nowhere", "in XML it is written `&amp;`"
        if before == b"<" or byte == b"<":
            return "`<` does not begin a tag here", "in texts it is written `&lt;`"
        if byte and byte < b" ":
            return f"an invisible control character (U+{byte[0]:04X})", "remove it"
        if byte >= b"\x80":
            return (
                f"byte 0x{byte[0]:02X} is no character of the file's encoding",
                "declare the encoding in which it was written, e.g. "
                "<?xml version='1.0' encoding='iso-8859-1'?>",
            )
        words = "a tag is not written as XML demands"
        return words, 'attributes are written name="value", with quotes'

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if sum(map(len, attributes.values())) > MAX_TEXT:
            self._refuse(XML_LIMIT, f"an attribute has more than {MAX_TEXT:,} characters")
        if len(self.open) >= MAX_DEPTH:
            self._refuse(XML_LIMIT, f"elements are nested more than {MAX_DEPTH} levels deep")
        if len(self.places) >= MAX_ELEMENTS:
            self._refuse(XML_LIMIT, f"there are more than {MAX_ELEMENTS:,} elements")
        parent = self.open[-1].number if self.open else -1
        parser = self.parser
        line, column = parser.CurrentLineNumber, parser.CurrentColumnNumber + 1
        place = _Place(len(self.places), parent, line, column)
        self.places.append(place)
        self.open.append(place)
        self.tags.append(tag)

    def _end(self, _tag: str) -> None:
        self.open.pop()
        self.tags.pop()

    def _characters(self, text: str) -> None:
        place = self.open[-1]
        if place.length > MAX_TEXT:  # white space between elements is free
            self._refuse(XML_LIMIT, f"a text has more than {MAX_TEXT:,} characters")
        if not place.length and text.isspace():
            place.skipped += len(text)
            if place.skipped > MAX_SPACE:
                self._refuse(
                    XML_LIMIT, f"there are more than {MAX_SPACE:,} characters of white space"
                )
            return
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        if (line, column) != place.expected:
            if place.marks is None:
                place.marks = []
            place.marks.append((place.length, line, column))
        place.length += len(text)
        # expat gives each line end as a chunk of its own
        place.expected = (line + 1, 1) if text == "\n" else (line, column + len(text))

    def _entity_declaration(
        self,
        name: str,
        _parameter: bool,
        _value: str | None,
        _base: str | None,
        _system: str | None,
        _public: str | None,
        _notation: str | None,
    ) -> None:
        self._refuse(XML_ENTITY, f"the file declares an XML entity, `{name}`")

    def _skipped_entity(self, name: str, _parameter: bool) -> None:
        self._refuse(XML_ENTITY, f"the file uses an undeclared XML entity, `{name}`")

    def _external_entity(
        self, _context: str, _base: str | None, system: str | None, _public: str | None
    ) -> int:
        self._refuse(XML_ENTITY, f"the file refers to an external XML entity, `{system}`")
        return 0

    def _refuse(self, code: str, message: str) -> None:
        hint = "no net of CPN Tools has this: the file is damaged or hostile"
        self.d.error(code, message, self._here(), hint=hint)
        raise _RefusedError
