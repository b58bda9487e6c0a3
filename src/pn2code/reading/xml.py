"""XML, read without trust: bytes in, a tree of `Node`s with exact positions out.

`xml.parsers.expat` walks through once: entities are refused where they are declared, before any can be used, as are
excessive depth and excessive numbers of elements; nothing outside the bytes is ever opened. Line and column of every
element and of every run of characters are kept.

Example: `<text>1`x &lt; 2</text>` at line 3, column 1 gives a node with text ``1`x < 2`` whose
`source` knows that `<` stands at column 11 and ` 2` at column 15.
"""

from __future__ import annotations

import stat
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

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
MAX_ELEMENTS = 2_000_000


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
    marks: list[tuple[int, int, int]] = field(default_factory=list)
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
        whole = SourceText(text, self.at(base), tuple(self.marks))
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
    return _Reader(file, d).read(data)


def _lower(message: str) -> str:
    text = message.strip().rstrip(".")
    return text[:1].lower() + text[1:]


class _RefusedError(Exception):
    """Ends the reading; the diagnostic has been reported."""


class _Reader:
    """Builds the tree while expat walks through, and refuses what is hostile."""

    def __init__(self, file: str, d: Diagnostics) -> None:
        self.file = file
        self.d = d
        self.top: Node | None = None
        self.open: list[Node] = []
        self.number = 0
        self.expected = (
            0,
            0,
            0,
        )  # where the text of the innermost element would go on: offset, line, column
        self.parser = expat.ParserCreate(namespace_separator="}")
        self.parser.specified_attributes = True
        self.parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._characters
        self.parser.EntityDeclHandler = self._entity_declaration
        self.parser.SkippedEntityHandler = self._skipped_entity
        self.parser.ExternalEntityRefHandler = self._external_entity

    def read(self, data: bytes) -> Node | None:
        try:
            self.parser.Parse(data, True)
        except _RefusedError:
            return None
        except expat.ExpatError as e:
            self._syntax_error(e.code, e.lineno, e.offset + 1)
            return None
        except (LookupError, ValueError) as e:
            # pyexpat asks Python for encodings that expat does not know.
            self.d.error(XML_SYNTAX, f"unknown character encoding: {_lower(str(e))}", self._here())
            return None
        return self.top

    def _here(self) -> Origin:
        return Origin(self.file, self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1)

    def _syntax_error(self, code: int, line: int, column: int) -> None:
        origin = Origin(self.file, line, column)
        ends = {
            expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS],
            expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_TOKEN],
            expat.errors.codes[expat.errors.XML_ERROR_PARTIAL_CHAR],
            expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION],
        }
        if code in ends and self.top is not None:
            inside = f" inside element `{self.open[-1].tag}`" if self.open else ""
            self.d.error(
                XML_TRUNCATED,
                f"the file ends too early,{inside or ' in the middle of an element'}",
                origin,
                notes=[f"element `{e.tag}` begins on line {e.line}" for e in self.open[-1:]],
                hint="the file was cut off: save or copy the net again",
            )
            return
        words = expat.ErrorString(code) or "syntax error"
        if code == expat.errors.codes[expat.errors.XML_ERROR_UNDEFINED_ENTITY]:
            self.d.error(XML_ENTITY, "the file uses an undeclared XML entity", origin)
            return
        self.d.error(
            XML_SYNTAX,
            f"not well-formed XML: {words}",
            origin,
            hint="a .cpn file is XML: is this a net saved by CPN Tools?",
        )

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if len(self.open) >= MAX_DEPTH:
            self._refuse(XML_LIMIT, f"elements are nested more than {MAX_DEPTH} levels deep")
        self.number += 1
        if self.number > MAX_ELEMENTS:
            self._refuse(XML_LIMIT, f"there are more than {MAX_ELEMENTS:,} elements")
        parser = self.parser
        node = Node(tag, attributes, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        if self.open:
            self.open[-1].children.append(node)
        else:
            self.top = node
        self.open.append(node)

    def _end(self, _tag: str) -> None:
        self.open.pop()
        self.expected = (0, 0, 0)

    def _characters(self, text: str) -> None:
        node = self.open[-1]
        if not node.text and text.isspace():
            return  # most elements hold other elements only, with line ends and indentation between
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        offset = len(node.text)
        if (offset, line, column) != self.expected:
            node.marks.append((offset, line, column))
        node.text += text
        offset += len(text)
        # expat gives each line end as a chunk of its own
        self.expected = (
            (offset, line + 1, 1) if text == "\n" else (offset, line, column + len(text))
        )

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
