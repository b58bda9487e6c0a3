"""XML, read without trust: bytes in, a tree of `Node`s with exact positions out.

`xml.parsers.expat` walks through the bytes once. Every handler refuses what is hostile (entities, excessive depth,
excessive numbers of elements, endless texts) before it adds to the tree, and notes line and column of every element
and of every run of characters. Nothing outside the bytes is ever looked at: no DTD, no network, no other file.

Example: `<text>1`x &lt; 2</text>` at line 3, column 1 gives a node with text ``1`x < 2`` whose
`source` knows that `<` stands at column 11 and ` 2` at column 15.
"""

from __future__ import annotations

import stat
from dataclasses import field
from pathlib import Path
from xml.parsers import expat

from pn2code.base.frozen import record
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
MAX_DEPTH = 200
"""Elements inside one another; those of real nets have fewer than ten levels."""
MAX_TERM_DEPTH = 40_000
"""The same inside a term of a PNML file, where a chain of ten thousand `or`s is as many levels."""
MAX_ELEMENTS = 800_000
"""The largest real net seen has 50,000; one of 10,000 places some 500,000."""
MAX_PNML_ELEMENTS = 4_000_000
"""Of a PNML file: place/transition nets that were made from coloured ones have a hundred thousand transitions."""
MAX_SPACE = 5_000_000
"""Characters of white space at the beginning of one element."""
MAX_TEXT = 250_000
"""Characters of one text or of the attributes of one element; the longest of real nets have some thousand."""

_TERMS = frozenset({"condition", "hlinscription", "hlinitialMarking"})
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


@record
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
        for child in self.children:
            if child.tag == tag:
                return child
        return None

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
    builder = _Builder(file, d)
    try:
        return builder.build(data)
    finally:
        del (
            builder.parser
        )  # it calls the builder: nothing would free the two, and all elements with them


def _qualified(name: str) -> str:
    """`{namespace}name`, of which expat gives `namespace}name`."""
    return "{" + name if "}" in name else name


def _local(tag: str) -> str:
    return tag.rpartition("}")[2]


def _lower(message: str | None) -> str:
    text = (message or "syntax error").strip().rstrip(".")
    return text[:1].lower() + text[1:]


@record
class _Text:
    """The characters of an element so far.

    Args:
        parts: in order; length: of all of them.
        marks: as in `SourceText`.
        line, column: of the next character if nothing comes between.
    """

    parts: list[str] = field(default_factory=list)
    length: int = 0
    marks: list[tuple[int, int, int]] = field(default_factory=list)
    line: int = 0
    column: int = 0


class _RefusedError(Exception):
    """Ends the building; the diagnostic has been reported."""


class _Builder:
    """Makes the tree, and refuses what is hostile."""

    def __init__(self, file: str, d: Diagnostics) -> None:
        self.file = file
        self.d = d
        self.root: Node | None = None
        self.elements = 0
        self.namespaces = False
        self.open: list[Node] = []
        # Of the innermost open element: its text, and white space before that.
        self.text: _Text | None = None
        self.space = 0
        self.outer: list[tuple[_Text | None, int]] = []  # the same of those around it
        self.parser = expat.ParserCreate(namespace_separator="}")
        self.parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._characters
        self.parser.StartNamespaceDeclHandler = self._namespace
        self.parser.EntityDeclHandler = self._entity_declaration
        self.parser.SkippedEntityHandler = self._skipped_entity
        self.parser.ExternalEntityRefHandler = self._external_entity

    def build(self, data: bytes) -> Node | None:
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
        return self.root

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
        if code in ends and (self.root or data.lstrip().startswith(b"<")):
            inside = " in the middle of an element" if self.root else " before its first element"
            if self.open:
                inside = f" inside element `{_local(self.open[-1].tag)}`"
            self.d.error(
                XML_TRUNCATED,
                f"the file ends too early,{inside}",
                origin,
                notes=[f"element `{_local(self.open[-1].tag)}` begins on line {self.open[-1].line}"]
                if self.open
                else [],
                hint="the file was cut off: save or copy the net again",
            )
            return
        if code == expat.errors.codes[expat.errors.XML_ERROR_UNDEFINED_ENTITY]:
            self.d.error(XML_ENTITY, "the file uses an undeclared XML entity", origin)
            return
        words, hint = self._explain(code, data)
        if self.file.lower().endswith(".pnml"):
            hint = "a .pnml file is XML: save the net again with the tool that wrote it"
        notes = []
        if code == expat.errors.codes[expat.errors.XML_ERROR_TAG_MISMATCH] and self.open:
            notes = [f"element `{_local(self.open[-1].tag)}` begins on line {self.open[-1].line}"]
        self.d.error(XML_SYNTAX, f"not well-formed XML: {words}", origin, notes=notes, hint=hint)

    def _explain(self, code: int, data: bytes) -> tuple[str, str]:
        """A syntax error in words, and what to do."""
        words = expat.ErrorString(code) or "syntax error"
        hint = "a .cpn file is XML: is this a net saved by CPN Tools?"
        errors = expat.errors
        if not self.root:
            for start, what in _SIGNATURES.items():
                if data.startswith(start):
                    return f"this is {what}", "give the .cpn file itself"
        if code == errors.codes[errors.XML_ERROR_TAG_MISMATCH] and self.open:
            name = _local(self.open[-1].tag)
            words = f"element `{name}` is not closed before the end of another one"
            hint = "the file was edited by hand or damaged: save the net again in CPN Tools"
        elif code == errors.codes[errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT]:
            words = "something follows after the end of the root element"
            hint = "a .cpn file has one root element, `workspaceElements`; remove what follows it"
        elif code == errors.codes[errors.XML_ERROR_INVALID_TOKEN] and self.root:
            return self._invalid(data)
        elif code == errors.codes[errors.XML_ERROR_UNBOUND_PREFIX]:
            words = "a name has a prefix, before `:`, that is declared nowhere"
            hint = "no name of CPN Tools has one: the file was edited by hand or damaged"
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
            return "`&` cannot be used by itself", "in XML it is written `&amp;`"
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
        if attributes and sum(map(len, attributes.values())) > MAX_TEXT:
            self._refuse(XML_LIMIT, f"an attribute has more than {MAX_TEXT:,} characters")
        if len(self.open) >= MAX_DEPTH and len(self.open) >= (most := self._most_deep()):
            self._refuse(XML_LIMIT, f"elements are nested more than {most:,} levels deep")
        if self.elements >= MAX_ELEMENTS and self.elements >= (most := self._most_elements()):
            self._refuse(XML_LIMIT, f"there are more than {most:,} elements")
        self.elements += 1
        if self.namespaces:
            tag = _qualified(tag)
            attributes = {_qualified(name): value for name, value in attributes.items()}
        parser = self.parser
        node = Node(
            tag, attributes, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1, "", (), []
        )
        if self.open:
            self.open[-1].children.append(node)
        else:
            self.root = node
        self.open.append(node)
        self.outer.append((self.text, self.space))
        self.text, self.space = None, 0

    def _is_pnml(self) -> bool:
        return _local(self.open[0].tag) == "pnml"

    def _most_deep(self) -> int:
        """How deep elements may be here."""
        is_term = self._is_pnml() and any(_local(n.tag) in _TERMS for n in self.open[:MAX_DEPTH])
        return MAX_TERM_DEPTH if is_term else MAX_DEPTH

    def _most_elements(self) -> int:
        return MAX_PNML_ELEMENTS if self._is_pnml() else MAX_ELEMENTS

    def _end(self, _tag: str) -> None:
        node, text = self.open.pop(), self.text
        if text is not None:
            node.text, node.marks = "".join(text.parts), tuple(text.marks)
        self.text, self.space = self.outer.pop()

    def _characters(self, characters: str) -> None:
        text = self.text
        if text is None:
            if characters.isspace():  # nearly always: white space between elements is free
                self.space += len(characters)
                if self.space > MAX_SPACE:
                    self._refuse(
                        XML_LIMIT, f"there are more than {MAX_SPACE:,} characters of white space"
                    )
                return
            text = self.text = _Text()
        elif text.length > MAX_TEXT:
            self._refuse(XML_LIMIT, f"a text has more than {MAX_TEXT:,} characters")
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        if line != text.line or column != text.column:
            text.marks.append((text.length, line, column))
        text.parts.append(characters)
        text.length += len(characters)
        # expat gives each line end as a chunk of its own
        if characters == "\n":
            text.line, text.column = line + 1, 1
        else:
            text.line, text.column = line, column + len(characters)

    def _namespace(self, _prefix: str | None, _uri: str | None) -> None:
        self.namespaces = True

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
