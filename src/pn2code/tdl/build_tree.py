"""The parser's tree -> syntax tree of a script, with what the grammar alone cannot see to be wrong."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, cast

from lark import Token, Transformer, Tree, v_args
from lark.exceptions import VisitError
from lark.tree import Meta

from pn2code.diagnostics import Diagnostics, SourceText, Span
from pn2code.robot.commands import Effect, Handling
from pn2code.tdl import codes
from pn2code.tdl import tree as t
from pn2code.tdl.types import LIST_OF, MAX_INT, ROWS, TYPES_BY_NAME, UNITS, Type

_EXTERNAL = ("$track", "$turntable")
_With = t.Along | str | t.Expression | tuple[t.Expression]
"""What stands after `with`: an external axis, a tool frame, an arm angle, and (in a tuple) the zone of corners."""


def build(tree: Tree[Token], source: SourceText, d: Diagnostics) -> t.Program:
    """The script that a tree of the parser stands for; mistakes are reported."""
    try:
        return cast(t.Program, _Builder(source, d).transform(tree))
    except VisitError as problem:  # lark wraps what the builder raises; that is a bug of ours
        raise problem.orig_exc from None


@v_args(meta=True)
class _Builder(Transformer[Token, Any]):
    """Lark's tree -> ours; mistakes that the grammar cannot see are reported here."""

    def __init__(self, source: SourceText, d: Diagnostics) -> None:
        super().__init__()
        self._source = source
        self._d = d

    def _span(self, meta: Meta) -> Span:
        if meta.empty:
            return self._source.span(0, 0)
        return self._source.span(meta.start_pos, meta.end_pos)

    def _at(self, token: Token) -> Span:
        return self._source.span(cast(int, token.start_pos), cast(int, token.end_pos))

    def _target(self, token: Token) -> t.Target:
        return t.Target(str(token), self._at(token))

    # declarations

    def start(self, meta: Meta, c: list[Any]) -> t.Program:
        name, *rest, body = c
        declarations: list[t.Declaration] = []
        procedures = []
        for item in rest:
            if isinstance(item, t.Procedure):
                procedures.append(item)
            elif isinstance(item, tuple):
                declarations.extend(item)
            else:
                declarations.append(item)
        return t.Program(str(name), tuple(declarations), tuple(procedures), body, self._span(meta))

    def file(self, meta: Meta, c: list[Any]) -> t.File:
        direction, name, path, *held = c
        types: list[t.TypeName] = []
        row = 0
        for x in held:
            if isinstance(x, t.TypeName):
                types.append(x)
            else:
                row += 1
                types += (replace(column, row=row) for column in x)
        return t.File(
            t.Direction(str(direction)), str(name), _unquote(path), tuple(types), self._at(name)
        )

    def rows(self, meta: Meta, c: list[Any]) -> list[t.TypeName]:
        """The columns of a list of records."""
        word, *columns = c
        if str(word) != ROWS:
            self._d.error(
                codes.UNKNOWN_TYPE,
                f"there is no type `{word}(...)`",
                self._at(word),
                hint=f"a list of records is `{ROWS}(int, word)`, with the types of their fields",
            )
            return []
        out: list[t.TypeName] = []
        for x in columns:
            if x.type not in LIST_OF:
                self._d.error(
                    codes.TYPE,
                    f"`{x.type}` cannot be a part of an item of a list",
                    x.span,
                    hint=f"it can be {', '.join(f'`{of}`' for of in LIST_OF)}",
                )
                continue
            out.append(replace(x, type=LIST_OF[x.type]))
        return out

    def const(self, meta: Meta, c: list[Any]) -> t.Const:
        return t.Const(str(c[0]), c[1], self._at(c[0]))

    def var(self, meta: Meta, c: list[Any]) -> tuple[t.Variable, ...]:
        names = [x for x in c if isinstance(x, Token)]
        type_name = c[len(names)]
        initial = c[len(names) + 1] if len(c) > len(names) + 1 else None
        return tuple(t.Variable(str(n), type_name, initial, self._at(n)) for n in names)

    def type(self, meta: Meta, c: list[Token]) -> t.TypeName:
        name = str(c[0])
        found = TYPES_BY_NAME.get(name)
        if found is None:
            self._d.error(
                codes.UNKNOWN_TYPE,
                f"there is no type `{name}`",
                self._at(c[0]),
                hint=f"types are {', '.join(t for t in TYPES_BY_NAME)}",
            )
        return t.TypeName(found or Type.INT, len(c) > 1, span=self._span(meta))

    def procedure(self, meta: Meta, c: list[Any]) -> t.Procedure:
        return t.Procedure(str(c[0]), c[1], self._at(c[0]))

    # statements

    def block(self, meta: Meta, c: list[t.Statement]) -> tuple[t.Statement, ...]:
        return tuple(c)

    def _motion(self, token: Token) -> t.Motion:
        known = {m.value: m for m in t.Motion}
        if str(token) not in known:
            self._d.error(
                codes.UNKNOWN_MOTION,
                f"there is no motion `{token}`",
                self._at(token),
                hint=f"motions are {' and '.join(f'`{k}`' for k in known)}",
            )
        return known.get(str(token), t.Motion.JOINT)

    def move(self, meta: Meta, c: list[Any]) -> t.Move:
        motion, *rest = c
        moved = self._motion(motion)
        target: Any = None
        if isinstance(rest[0], list):  # nothing but external axes
            if moved is not t.Motion.EXTERNAL:
                self._d.error(
                    codes.EXTERNAL,
                    f"`move {motion}` says nowhere to go",
                    self._at(motion),
                    hint="write `move $external with ...` where external axes alone move",
                )
        else:
            target, *rest = rest
            if moved is t.Motion.EXTERNAL:
                self._d.error(
                    codes.EXTERNAL,
                    "on an external move the arm stands still, so it goes nowhere",
                    self._at(motion),
                    hint="write `move $joint ... with ...` or `move $linear ... with ...` for both",
                )
        told: list[_With] = next((x for x in rest if isinstance(x, list)), [])
        along = tuple(x for x in told if isinstance(x, t.Along))
        tcps = [x for x in told if isinstance(x, str)]
        elbows = [x for x in told if not isinstance(x, t.Along | str | tuple)]
        zones = [x[0] for x in told if isinstance(x, tuple)]
        to_pose = target is not None and not isinstance(target, Token | t.Axes)
        for found, article, what, example in (
            (tcps, "a", "tool frame", "$linear p with $tool NAME"),
            (elbows, "an", "arm angle", "$joint p with $arm angle = 30 deg"),
            (zones, "a", "zone of its corners", "$linear q via p with $blend = 20 mm"),
        ):
            if len(found) > 1 or (found and not to_pose):
                self._d.error(
                    codes.EXTERNAL,
                    f"a move has one {what}"
                    if to_pose
                    else f"only a move to a pose has {article} {what}",
                    self._at(motion),
                    hint=f"write `move {example}`",
                )
        frame = next((x for x in rest if isinstance(x, t.Target)), None)
        said: dict[str, Any] = dict(x for x in rest if isinstance(x, tuple))
        return t.Move(
            moved,
            None if isinstance(target, Token) else target,
            frame.name if frame else None,
            said.get("at"),
            said.get("via", ()),
            said.get("acceleration"),
            along,
            tcps[0] if tcps else "",
            elbows[0] if elbows else None,
            zones[0] if zones else None,
            frame.span if frame else None,
            self._span(meta),
        )

    def along(self, meta: Meta, c: list[_With]) -> list[_With]:
        return c

    def external(self, meta: Meta, c: list[Any]) -> _With:
        kind, name, *rest = c
        if str(kind) == "$tool" and not rest:
            return str(name)
        if str(kind) == "$arm" and str(name) == "angle" and rest:
            expression: t.Expression = rest[0]
            return expression
        position = rest[0] if rest else t.Quantity(0.0, "mm")
        if str(kind) not in _EXTERNAL or not rest:
            self._d.error(
                codes.EXTERNAL,
                f"there is no external axis of the kind `{kind}`"
                if rest
                else f"`{kind} {name}` says nowhere to go",
                self._at(kind),
                hint="write `$track NAME = 1200 mm`, `$turntable NAME = 30 deg`, `$tool NAME`, "
                "or `$arm angle = 30 deg`",
            )
        return t.Along(str(name), position, str(kind) != "$turntable", self._span(meta))

    def axes(self, meta: Meta, c: list[t.Expression]) -> t.Axes:
        return t.Axes(tuple(c), self._span(meta))

    def zone(self, meta: Meta, c: list[Any]) -> tuple[t.Expression]:
        if str(c[0]) != "$blend":
            self._d.error(
                codes.EXTERNAL,
                f"`{c[0]}` says nothing of a move",
                self._at(c[0]),
                hint="write `$blend = 20 mm`, or `$track NAME = 1200 mm`",
            )
        return (c[1],)

    def via(self, meta: Meta, c: list[t.Expression]) -> tuple[str, tuple[t.Expression, ...]]:
        return "via", tuple(c)

    def pace(self, meta: Meta, c: list[t.Expression]) -> tuple[str, t.Expression]:
        return "at", c[0]

    def ramp(self, meta: Meta, c: list[t.Expression]) -> tuple[str, t.Expression]:
        return "acceleration", c[0]

    def frame(self, meta: Meta, c: list[Token]) -> t.Target:
        return t.Target(_word(c[0]), self._at(c[0]))

    def speed(self, meta: Meta, c: list[Any]) -> t.Speed:
        value = None if isinstance(c[2], Token) else c[2]
        return t.Speed(self._motion(c[1]), value, self._span(meta))

    def wait_time(self, meta: Meta, c: list[Any]) -> t.WaitTime:
        return t.WaitTime(c[0], self._span(meta))

    def wait_until(self, meta: Meta, c: list[Any]) -> t.WaitUntil:
        return t.WaitUntil(c[0], self._span(meta))

    def read(self, meta: Meta, c: list[Token]) -> t.Read:
        return t.Read(self._target(c[0]), tuple(self._target(x) for x in c[1:]), self._span(meta))

    def clear(self, meta: Meta, c: list[Token]) -> t.Clear:
        return t.Clear(self._target(c[0]), self._span(meta))

    def write(self, meta: Meta, c: list[Any]) -> t.Write:
        values = tuple(x for x in c[1:] if not isinstance(x, Token))
        return t.Write(self._target(c[0]), values, self._span(meta))

    def assign(self, meta: Meta, c: list[Any]) -> t.Assign:
        return t.Assign(self._target(c[0]), c[1], self._span(meta))

    def tool(self, meta: Meta, c: list[Any]) -> t.Tool:
        return t.Tool(_word(c[1]), c[-1], c[2] if len(c) > 3 else None, self._span(meta))

    def handling(self, _meta: Meta, c: list[Token]) -> Handling:
        return Handling(cast(Effect, str(c[0])), _word(c[1]), *map(_word, c[2:]))

    def measure(self, meta: Meta, c: list[Any]) -> t.Measure:
        return t.Measure(c[0], self._target(c[1]), self._span(meta))

    def sense(self, meta: Meta, c: list[Any]) -> t.Sense:
        return t.Sense(_word(c[0]), self._target(c[1]), self._span(meta))

    def mark(self, meta: Meta, c: list[Any]) -> t.Mark:
        names = [x for x in c if isinstance(x, Token)]
        return t.Mark(".".join(_word(n) for n in names), tuple(c[len(names) :]), self._span(meta))

    def binding(self, meta: Meta, c: list[Any]) -> tuple[str, t.Datum]:
        return _word(c[0]), c[1]

    def record(self, meta: Meta, c: list[Any]) -> t.RecordDatum:
        return t.RecordDatum(tuple(c), self._span(meta))

    def tuple(self, meta: Meta, c: list[Any]) -> t.TupleDatum:
        return t.TupleDatum(tuple(c), self._span(meta))

    def each(self, meta: Meta, c: list[Any]) -> t.EachDatum:
        return t.EachDatum(c[0], self._span(meta))

    def null(self, meta: Meta, c: list[Any]) -> t.NullDatum:
        return t.NullDatum(self._span(meta))

    def compute(self, meta: Meta, c: list[Any]) -> t.Compute:
        return t.Compute(tuple(c), self._span(meta))

    def stop(self, meta: Meta, c: list[Any]) -> t.Stop:
        return t.Stop(tuple(c), self._span(meta))

    def call(self, meta: Meta, c: list[Token]) -> t.Call:
        return t.Call(self._target(c[0]), self._span(meta))

    def label(self, meta: Meta, c: list[Token]) -> t.Label:
        return t.Label(str(c[0]), self._span(meta))

    def goto(self, meta: Meta, c: list[Token]) -> t.Goto:
        return t.Goto(self._target(c[0]), self._span(meta))

    def exit(self, meta: Meta, c: list[Any]) -> t.Exit:
        return t.Exit(c[0] if c else None, self._span(meta))

    def elsif(self, meta: Meta, c: list[Any]) -> t.Branch:
        return t.Branch(c[0], c[1], self._span(meta))

    def loop(self, meta: Meta, c: list[Any]) -> t.Loop:
        return t.Loop(c[0], self._span(meta))

    # expressions

    def conditional(self, meta: Meta, c: list[Any]) -> t.Conditional:
        return t.Conditional(c[0], c[1], c[2], self._span(meta))

    def binary(self, meta: Meta, c: list[Any]) -> t.Binary:
        return t.Binary(cast(t.Operator, str(c[1])), c[0], c[2], self._span(meta))

    def unary(self, meta: Meta, c: list[Any]) -> t.Unary:
        return t.Unary("not" if str(c[0]) == "not" else "-", c[1], self._span(meta))

    def field(self, meta: Meta, c: list[Any]) -> t.Field:
        return t.Field(c[0], str(c[1]), self._span(meta))

    def parenthesised(self, meta: Meta, c: list[Any]) -> t.Expression:
        return cast(t.Expression, c[0])

    def function(self, meta: Meta, c: list[Any]) -> t.CallExpression:
        return t.CallExpression(str(c[0]), tuple(c[1:]), self._span(meta))

    def name(self, meta: Meta, c: list[Token]) -> t.Name:
        return t.Name(str(c[0]), self._span(meta))

    def integer(self, meta: Meta, c: list[Token]) -> t.Value:
        # Not converted when it is far too long: Python refuses numerals of thousands of digits.
        digits = str(c[0]).lstrip("0") or "0"
        value = int(digits) if len(digits) <= 10 else MAX_INT + 2
        if value > MAX_INT:
            self._d.error(
                codes.TYPE,
                "the integer is out of range",
                self._span(meta),
                hint=f"integers have 31 bits, as in CPN Tools: at most {MAX_INT}",
            )
        return t.Value(value, self._span(meta))

    def real(self, meta: Meta, c: list[Token]) -> t.Value:
        return t.Value(self._number(str(c[0]), meta), self._span(meta))

    def quantity(self, meta: Meta, c: list[Token]) -> t.Quantity:
        text = str(c[0])
        unit = text.lstrip("0123456789.")
        if unit[:1] in ("e", "E") and unit[1:].lstrip("+-")[:1].isdigit():
            unit = unit[1:].lstrip("+-").lstrip("0123456789")
        number = text[: len(text) - len(unit)].rstrip(" \t")
        unit = unit.strip(" \t")
        if unit not in UNITS:
            start = cast(int, c[0].end_pos) - len(unit)
            self._d.error(
                codes.UNKNOWN_UNIT,
                f"there is no unit `{unit}`",
                self._source.span(start, start + len(unit)),
                hint=f"units are {', '.join(UNITS)}",
            )
            unit = "mm"
        return t.Quantity(self._number(number, meta), unit, self._span(meta))

    def _number(self, text: str, meta: Meta) -> float:
        value = float(text)
        if math.isinf(value):
            self._d.error(codes.TYPE, "the number is too large", self._span(meta))
        return value

    def string(self, meta: Meta, c: list[Token]) -> t.Value:
        return t.Value(_unquote(c[0]), self._span(meta))

    def true(self, meta: Meta, c: list[Token]) -> t.Value:
        return t.Value(True, self._span(meta))

    def false(self, meta: Meta, c: list[Token]) -> t.Value:
        return t.Value(False, self._span(meta))


def _if(self: _Builder, meta: Meta, c: list[Any]) -> t.If:
    condition, body, *rest = c
    otherwise = rest.pop() if rest and isinstance(rest[-1], tuple) else None
    first = t.Branch(condition, body, self._span(meta))
    return t.If((first, *rest), otherwise, self._span(meta))


def _while(self: _Builder, meta: Meta, c: list[Any]) -> t.While:
    return t.While(c[0], c[1], self._span(meta))


def _return(self: _Builder, meta: Meta, c: list[Any]) -> t.Return:
    return t.Return(self._span(meta))


def _else(self: _Builder, meta: Meta, c: list[Any]) -> tuple[t.Statement, ...]:
    return cast("tuple[t.Statement, ...]", c[0])


# Rules named by Python's key words cannot be written as methods.
for _name, _method in (("if", _if), ("while", _while), ("return", _return), ("else", _else)):
    setattr(_Builder, _name, v_args(meta=True)(_method))


def _word(token: Token) -> str:
    return _unquote(token) if token.type == "STRING" else str(token)


def _unquote(token: Token) -> str:
    out = []
    characters = iter(str(token)[1:-1])
    for c in characters:
        if c == "\\":
            following = next(characters)
            out.append({"n": "\n", "t": "\t", "r": "\r"}.get(following, following))
        else:
            out.append(c)
    return "".join(out)
