"""Where things come from: `Origin`, and texts that know the position of each character.

Every node of every stage carries an `Origin` (or a `Span`, from which one is made on demand), from
the XML reader to the last emitted line of C, so that each message and each generated block can
name the net element it came from.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import field

from pn2code.base.frozen import frozen, replace


@frozen
class Origin:
    """A place in the user's files.

    Args:
        file: path as the user gave it.
        line: 1-based line, 0 when unknown.
        column: 1-based column, 0 when unknown.
        page: page name, for net elements.
        element: readable name, e.g. "place `Buffer`" or "arc `Buffer` -> `Pick`".
        element_id: the XML id.
        part: which inscription: "inscription", "guard", "delay", "code segment", "priority",
            "initial marking", "colour set", "declaration", "name".
        instance: page-instance path, e.g. "Top/Robot1", once flattened.
    """

    file: str
    line: int = 0
    column: int = 0
    page: str = ""
    element: str = ""
    element_id: str = ""
    part: str = ""
    instance: str = ""

    def location(self) -> str:
        """`file:line:column`, leaving out what is unknown."""
        parts = [self.file]
        if self.line:
            parts.append(str(self.line))
            if self.column:
                parts.append(str(self.column))
        return ":".join(parts)

    def describe(self) -> str:
        """Page, element and part in one readable phrase."""
        words = []
        if self.page:
            words.append(f"page `{self.page}`")
        if self.element:
            words.append(self.element + (f" ({self.element_id})" if self.element_id else ""))
        elif self.element_id:
            words.append(self.element_id)
        if self.part:
            words.append(self.part)
        return ", ".join(words)


NOWHERE = Origin("<pn2code>")
"""Origin of things that pn2code itself defines: built-in functions, the standard colour sets."""


class PlacedText(str):
    """A text that knows where it stands, for what is given beside the net."""

    origin: Origin

    def __new__(cls, text: str, origin: Origin) -> PlacedText:
        """The text, at its place."""
        made = super().__new__(cls, text)
        made.origin = origin
        return made


@frozen
class SourceText:
    """A piece of text of the user's (an inscription, a declaration, a script) with its origin.

    Args:
        text: the text, entities resolved, newlines as ``\\n``.
        origin: the element; its line and column are those of the first character.
        marks: sorted `(offset, line, column)`: from `offset` on, the text stands at that
            line and column, one column a character, until a newline or the next mark. Empty: the
            text is contiguous from `origin`.
    """

    text: str
    origin: Origin
    marks: tuple[tuple[int, int, int], ...] = ()

    def position(self, offset: int) -> tuple[int, int]:
        """Line and column (both 1-based, 0 if unknown) of a character offset."""
        offset = max(0, min(offset, len(self.text)))
        base, line, column = 0, self.origin.line, self.origin.column
        if self.marks:
            i = bisect_right(self.marks, (offset, 1 << 60, 1 << 60)) - 1
            if i >= 0:
                base, line, column = self.marks[i]
        if line == 0:
            return 0, 0
        between = self.text[base:offset]
        newlines = between.count("\n")
        if newlines == 0:
            return line, column + len(between)
        return line + newlines, len(between) - between.rfind("\n")

    def origin_at(self, offset: int) -> Origin:
        """The element's origin moved to the position of a character."""
        line, column = self.position(offset)
        return replace(self.origin, line=line, column=column)

    def span(self, start: int = 0, end: int | None = None) -> Span:
        """The part from `start` to `end` (exclusive; the whole text by default)."""
        return Span(self, start, len(self.text) if end is None else end)


@frozen
class Span:
    """A stretch `[start, end)` of a `SourceText`. Syntax trees carry spans."""

    source: SourceText = field(repr=False)
    start: int
    end: int

    @property
    def line(self) -> int:
        """That of `origin`, without making one."""
        return self.source.position(self.start)[0]

    @property
    def origin(self) -> Origin:
        """The origin of the first character."""
        return self.source.origin_at(self.start)

    @property
    def text(self) -> str:
        """The text covered."""
        return self.source.text[self.start : self.end]

    def to(self, other: Span) -> Span:
        """From the beginning of this span to the end of another in the same text."""
        return Span(self.source, min(self.start, other.start), max(self.end, other.end))
