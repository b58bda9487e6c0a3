"""Declarations of colour sets and variables as text, taken apart as in a `.cpn` file."""

from __future__ import annotations

import re
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import SourceText
from pn2code.reading.document import RawColset, RawVar
from pn2code.text_form.scan import first, masked, parts, stripped, uncommented

SIMPLE = ("unit", "bool", "int", "intinf", "time", "real", "string")
"""Those without parts. `standard` declares one of each, with its kind in capital letters as its name."""
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_']*")
_LABEL = re.compile(r"[A-Za-z0-9][A-Za-z0-9_']*")
_WORD = re.compile(r"\s*([A-Za-z]+)\b(?!')")


class NotReadableError(Exception):
    """A declaration that is none; `at` is the offset in its text, `hint` what to write."""

    def __init__(self, message: str, at: int, hint: str) -> None:
        super().__init__(message)
        self.message = message
        self.at = at
        self.hint = hint


@frozen
class _Piece:
    """A part of a declaration's text, without white space around it."""

    whole: SourceText
    start: int
    end: int

    @property
    def text(self) -> str:
        return self.whole.text[self.start : self.end]

    def part(self, start: int, end: int) -> _Piece:
        """Of this one, by offsets from its own beginning."""
        return _Piece(self.whole, *stripped(self.whole.text, self.start + start, self.start + end))

    def split(self, separator: str) -> list[_Piece]:
        return [self.part(*x) for x in parts(self.text, separator)]

    def name(self, kind: re.Pattern[str] = NAME) -> str:
        if kind.fullmatch(self.text):
            return self.text
        raise self.wrong(
            f"a name is expected, not `{self.text}`" if self.text else "a name is missing"
        )

    def source(self) -> SourceText:
        return piece(self.whole, self.start, self.end)

    def wrong(self, message: str) -> NotReadableError:
        return NotReadableError(message, self.start, _HINT)


_HINT = (
    "a colour set is written as in CPN Tools: `colset PART = int with 1..4;`, `colset J = product PART * INT timed;`, "
    "`colset C = with red | blue;`, `colset P = record x : REAL * y : REAL;`, `colset L = list PART;`, "
    "`colset U = union a : PART + b;`, `colset S = subset INT by even;`, `colset I = index i with 1..3;`"
)


def piece(text: SourceText, start: int, end: int) -> SourceText:
    """A part of a text, without white space around it, as a text of its own that knows where it stands."""
    start, end = stripped(text.text, start, end)
    line, column = text.position(start)
    marks = [(start, line, column), *(m for m in text.marks if start < m[0] < end)]
    moved = tuple((at - start, number, col) for at, number, col in marks)
    return SourceText(text.text[start:end], replace(text.origin, line=line, column=column), moved)


def variables(text: SourceText, identity: str) -> RawVar:
    """`var x, y : TYPE`, without the semicolon."""
    text = replace(text, text=uncommented(text.text))
    whole = _Piece(text, *stripped(text.text, 0, len(text.text)))
    colon = first(whole.text, ":")
    if colon < 0:
        raise NotReadableError(
            "the colour set of the variables is missing",
            whole.start,
            "variables are declared as `var x, y : PART;`",
        )
    names = tuple(p.name() for p in whole.part(len("var"), colon).split(","))
    words = " ".join(["variable", ", ".join(f"`{n}`" for n in names)])
    colset_name = whole.part(colon + 1, len(whole.text)).name()
    return RawVar(identity, names, colset_name, replace(text.origin, element=words))


def colset(text: SourceText, identity: str) -> RawColset:
    """`colset NAME = DEFINITION [timed] [declare ...]`, without the semicolon."""
    text = replace(text, text=uncommented(text.text))
    whole = _Piece(text, *stripped(text.text, 0, len(text.text)))
    equals = first(whole.text, "=")
    if equals < 0:
        raise whole.wrong("the definition of the colour set is missing")
    name = whole.part(len("colset"), equals).name()
    origin = replace(text.origin, element=f"colour set `{name}`")
    whole = _Piece(replace(text, origin=origin), whole.start, whole.end)
    body = whole.part(equals + 1, len(whole.text))
    declared: tuple[str, ...] = ()
    if (found := re.search(r"\sdeclare\s", masked(body.text))) is not None:
        names = body.part(found.end(), len(body.text)).split(",")
        declared = tuple(x.name() for x in names)
        body = body.part(0, found.start())
    timed = re.search(r"(^|\s)timed$", masked(body.text))
    if timed is not None:
        body = body.part(0, timed.start())
    kind, ids, fields, texts, by = _definition(body)
    return RawColset(
        id=identity,
        name=name,
        kind=kind,
        ids=tuple(ids),
        fields=tuple(fields),
        texts=tuple(t.source() for t in texts),
        timed=timed is not None,
        declare=declared,
        by_predicate=by,
        layout_text=f"{' '.join(whole.text.split())};",
        origin=origin,
    )


_Definition = tuple[str, list[str], list[tuple[str, str]], list[_Piece], bool]


def _definition(body: _Piece) -> _Definition:
    """Kind, ids, fields and texts of a definition, and whether a subset is one by predicate."""
    found = _WORD.match(body.text)
    word = found.group(1) if found else ""
    rest = body.part(found.end(), len(body.text)) if found else body
    before, limit = _with(rest)
    match word:
        case "unit" | "bool":
            if before.text:
                raise before.wrong(f"`{before.text}` is not expected here")
            return word, _listed(limit), [], [], False
        case "int" | "intinf" | "time" | "real" | "string":
            if before.text:
                raise before.wrong(f"`{before.text}` is not expected here")
            return word, [], [], _limits(limit, several=word == "string"), False
        case "with":
            colours = [x.strip() for x in rest.text.split(",")]
            if len(colours) > 1 and all(map(NAME.fullmatch, colours)):
                hint = f"colours are separated by `|`: `with {' | '.join(colours)}`"
                raise NotReadableError(f"a name is expected, not `{rest.text}`", rest.start, hint)
            return "enum", [p.name() for p in rest.split("|")], [], [], False
        case "index":
            return word, [before.name()], [], _limits(limit, needed=before), False
        case "product":
            return word, [p.name() for p in rest.split("*")], [], [], False
        case "record":
            return word, [], [_field(p, _LABEL) for p in rest.split("*")], [], False
        case "union":
            return word, [], [_field(p, NAME, optional=True) for p in rest.split("+")], [], False
        case "list":
            return word, [before.name()], [], _limits(limit), False
        case "subset":
            by = re.search(r"\s(by|with)\s", masked(rest.text))
            if by is None:
                raise rest.wrong("a subset has a function after `by`, or a list after `with`")
            base, what = rest.part(0, by.start()), rest.part(by.end(), len(rest.text))
            return word, [base.name()], [], [what], by.group(1) == "by"
    return "alias", [body.name()], [], [], False


def _with(rest: _Piece) -> tuple[_Piece, _Piece | None]:
    """What stands before and after `with`."""
    found = re.search(r"(^|\s)with\s", masked(rest.text))
    if found is None:
        return rest, None
    return rest.part(0, found.start()), rest.part(found.end(), len(rest.text))


def _listed(limit: _Piece | None) -> list[str]:
    """The names of the values of `unit` and `bool`: `(no, yes)`, `e`."""
    if limit is None:
        return []
    text = limit.text
    if text.startswith("(") and text.endswith(")"):
        limit = limit.part(1, len(text) - 1)
    return [p.name() for p in limit.split(",")]


def _limits(
    limit: _Piece | None, needed: _Piece | None = None, several: bool = False
) -> list[_Piece]:
    """The bounds `a..b`, of texts (`several`) also those of the length: `"a".."z" and 3..9`."""
    if limit is None:
        if needed is not None:
            raise needed.wrong("the bounds are missing: `with 1..3`")
        return []
    found: list[_Piece] = []
    between = [m.span() for m in re.finditer(r"\sand\s", masked(limit.text))]
    if len(between) > several:
        raise limit.wrong("more bounds than one `a..b`; strings have also those of their length")
    starts, ends = [0, *(b for _, b in between)], [*(a for a, _ in between), len(limit.text)]
    for start, end in zip(starts, ends, strict=True):
        piece = limit.part(start, end)
        bounds = piece.split("..")
        if len(bounds) != 2 or not all(b.text for b in bounds):
            raise piece.wrong(f"bounds are written `1..9`, not `{piece.text}`")
        found += bounds
    return found


def _field(piece: _Piece, kind: re.Pattern[str], optional: bool = False) -> tuple[str, str]:
    """`label : TYPE`; in a union the type may be missing."""
    colon = first(piece.text, ":")
    if colon < 0:
        if optional:
            return piece.name(kind), ""
        raise piece.wrong(f"`{piece.text}` has no colour set: `{piece.text or 'x'} : INT`")
    return piece.part(0, colon).name(kind), piece.part(colon + 1, len(piece.text)).name()
