"""Lines of a net as text: what is deeper belongs to the line above.

Texts in CPN ML keep where each of their lines stands, so that messages point into the file.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import field, replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin, SourceText
from pn2code.text_form.scan import Open, after

_TAB = 8
A_NOTE_INSIDE = (
    "a line that begins with `#` stands inside a text of CPN ML",
    "write comments inside a text as `(* ... *)`; a selector without a blank: `#x p`",
)
"""What is said of a note where it would leave a hole, and what to write."""


@frozen
class Line:
    """A line and the deeper ones that follow it.

    Args:
        number, column: of its first character that is not white space, from 1.
        indent: how deep it stands; a tab goes to the next multiple of 8.
        inside: whether it begins inside a comment of CPN ML.
    """

    number: int
    column: int
    indent: int
    text: str
    inside: bool = False
    below: list[Line] = field(default_factory=list)

    @property
    def word(self) -> str:
        """Its first word."""
        return self.text.split(None, 1)[0]

    @property
    def is_note(self) -> bool:
        """Whether it is a comment of the file: `# ...`."""
        return not self.inside and (self.text == "#" or self.text.startswith("# "))

    @property
    def goes_on(self) -> bool:
        """Whether more than notes stands below it."""
        return any(not x.is_note for x in self.below)

    def deeper(self) -> Iterator[Line]:
        """All deeper lines, in the order of the file."""
        todo = self.below[::-1]
        while todo:
            line = todo.pop()
            yield line
            todo += line.below[::-1]


def read(text: str) -> tuple[Line, Line | None]:
    """The lines of a file below one that is none, and the line in which a comment begins that never ends."""
    root = Line(0, 0, -1, "")
    stack = [root]
    state, opened = Open(), None
    for number, raw in enumerate(text.split("\n"), start=1):
        content = raw.strip()
        if not content:
            continue
        before = len(raw) - len(raw.lstrip())
        indent = len(raw[:before].expandtabs(_TAB))
        line = Line(number, before + 1, indent, content, inside=state.comments > 0)
        if line.is_note:  # it ends nothing, wherever it stands
            next(s for s in reversed(stack) if s.indent < indent).below.append(line)
            continue
        if state.comments:
            stack[-1].below.append(line)
        else:
            opened = line
            while stack[-1].indent >= indent:
                stack.pop()
            stack[-1].below.append(line)
            stack.append(line)
        state = after(content, state)
    return root, opened if state.comments else None


def notes_in(line: Line, notes: list[Line]) -> list[Line]:
    """Those of the file's notes, in its order, that stand between a line and the end of what is deeper."""
    last = max((x.number for x in line.deeper()), default=line.number)
    begin = bisect_right(notes, line.number, key=lambda x: x.number)
    return notes[begin : bisect_right(notes, last, key=lambda x: x.number)]


def text_of(line: Line, start: int, origin: Origin) -> SourceText:
    """The text of a line from an offset on, with all deeper lines; they keep how deep they stand beside one another.

    Args:
        origin: of the element; the text's is the same at another place.
    """
    rest = line.text[start:]
    start += len(rest) - len(rest.lstrip())
    pieces: list[str] = []
    marks: list[tuple[int, int, int]] = []
    length = 0

    def add(piece: str, at: Line, column: int, blanks: int) -> None:
        nonlocal length
        if pieces:
            pieces.append("\n" + " " * blanks)
            length += 1 + blanks
        marks.append((length, at.number, column))
        pieces.append(piece)
        length += len(piece)

    if rest.strip():
        add(rest.strip(), line, line.column + start, 0)
    deeper = list(line.deeper())
    least = min((x.indent for x in deeper if not x.inside), default=0)
    for one in deeper:
        add(one.text, one, one.column, max(0, one.indent - least))
    _, number, column = marks[0] if marks else (0, line.number, line.column)
    return SourceText("".join(pieces), replace(origin, line=number, column=column), tuple(marks))
