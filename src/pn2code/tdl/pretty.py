"""Syntax tree -> text. `parse(print(tree)) == tree`; only the parentheses that are needed are written.

`expression(Binary("*", Binary("+", a, b), c))` is `(a + b) * c`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import Final, assert_never

from pn2code.robot.commands import Handling
from pn2code.tdl import tree as t
from pn2code.tdl.grammar import KEYWORDS
from pn2code.tdl.types import ELEMENT, MAX_INT, MIN_INT, ROWS

INDENT: Final = "  "

_LEVEL: Final[dict[str, int]] = {
    "or": 1, "and": 2,
    "=": 4, "<>": 4, "<": 4, "<=": 4, ">": 4, ">=": 4,
    "+": 5, "-": 5, "&": 5, "*": 6, "/": 6, "div": 6, "mod": 6,
}  # fmt: skip
_NOT, _NEGATE, _POSTFIX = 3, 7, 8
_ESCAPES: Final = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def _handled(handling: Handling | None) -> str:
    if handling is None:
        return ""
    at = f" at {word(handling.place)}" if handling.place else ""
    return f" {handling.effect} {word(handling.part)}{at}"


def is_name(text: str) -> bool:
    """Whether a text can stand as a name."""
    return text.isascii() and text.isidentifier() and text not in KEYWORDS


def quoted(text: str) -> str:
    """A text in quotes."""
    return f'"{"".join(_ESCAPES.get(c, c) for c in text)}"'


def number(value: int | float) -> str:
    """A number that is not negative, in the shortest form that reads back to the same value."""
    if isinstance(value, int):
        return str(value)
    if not math.isfinite(value):
        raise ValueError("scripts have no literal for numbers that are not finite")
    text = repr(value)
    return text.replace("e+", "e")


def quantity(value: float, unit: str) -> str:
    """A number with its unit; whole numbers without `.0`."""
    text = number(value)
    return f"{text.removesuffix('.0')} {unit}"


def expression(e: t.Expression, level: int = 0) -> str:
    """The text of an expression, in parentheses if it binds less tightly than `level`."""
    text, own = _expression(e)
    return f"({text})" if own < level else text


def _expression(e: t.Expression) -> tuple[str, int]:
    match e:
        case t.Value(value):
            if isinstance(value, bool):
                return ("true" if value else "false"), 9
            if isinstance(value, str):
                return quoted(value), 9
            if value == MIN_INT and isinstance(value, int):
                # its magnitude is no literal
                return f"-{number(MAX_INT)} - 1", _LEVEL["-"]
            if value < 0:
                return f"-{number(-value)}", _NEGATE
            return number(value), 9
        case t.Quantity(value, unit):
            if value < 0:
                return f"-{quantity(-value, unit)}", _NEGATE
            return quantity(value, unit), 9
        case t.Name(name):
            return name, 9
        case t.Field(record, label):
            return f"{expression(record, _POSTFIX)}.{label}", _POSTFIX
        case t.Unary("not", operand):
            return f"not {expression(operand, _NOT)}", _NOT
        case t.Unary(_, operand):
            # `--` would begin a comment.
            inner = expression(operand, _NEGATE)
            return f"-({inner})" if inner.startswith("-") else f"-{inner}", _NEGATE
        case t.Binary(operator, left, right):
            own = _LEVEL[operator]
            first = own + 1 if own == 4 else own  # comparisons do not chain
            return f"{expression(left, first)} {operator} {expression(right, own + 1)}", own
        case t.CallExpression(function, arguments):
            return f"{function}({', '.join(expression(a) for a in arguments)})", 9
        case t.Conditional(condition, then, otherwise):
            return (
                f"if {expression(condition)} then {expression(then)} else {expression(otherwise)}",
                0,
            )
        case _:
            assert_never(e)


def datum(e: t.Datum) -> str:
    """The text of a value in a `mark`."""
    match e:
        case t.RecordDatum(fields):
            return "{" + ", ".join(_binding(f) for f in fields) + "}"
        case t.TupleDatum(items):
            return "[" + ", ".join(datum(i) for i in items) + "]"
        case t.EachDatum(item):
            return f"each {datum(item)}"
        case t.NullDatum():
            return "null"
        case _:
            return expression(e)


def _binding(item: tuple[str, t.Datum]) -> str:
    return f"{word(item[0])} = {datum(item[1])}"


def word(text: str) -> str:
    """A name, in quotes unless it can do without."""
    return text if is_name(text) else quoted(text)


def transition(name: str) -> str:
    """The name of a net transition: dotted words, or in quotes."""
    return name if all(is_name(part) for part in name.split(".")) else quoted(name)


def _goal(target: t.Expression | t.Axes | None) -> str:
    match target:
        case None:
            return "home"
        case t.Axes(angles):
            return f"axes({', '.join(map(expression, angles))})"
        case _:
            return expression(target)


def _external(a: t.Along) -> str:
    return f"${'track' if a.is_track else 'turntable'} {a.axis} = {expression(a.position)}"


def _frame(name: str) -> str:
    return name if name == "tool" or is_name(name) else quoted(name)


def simple(s: t.Simple) -> str:
    """The line of a statement that has no body."""
    match s:
        case t.Move(motion, target, frame, speed, via, acceleration, along, tcp, elbow, zone):
            text = f"move {motion.value}"
            text += f" {_goal(target)}" if motion is not t.Motion.EXTERNAL else ""
            text += f" via {', '.join(map(expression, via))}" if via else ""
            text += f" in {_frame(frame)}" if frame else ""
            more = [*([f"$tool {tcp}"] if tcp else []), *map(_external, along)]
            more += [f"$arm angle = {expression(elbow)}"] if elbow is not None else []
            more += [f"$blend = {expression(zone)}"] if zone is not None else []
            text += f" with {', '.join(more)}" if more else ""
            text += f" at {expression(speed)}" if speed else ""
            return text + (f" acceleration {expression(acceleration)}" if acceleration else "")
        case t.Speed(motion, value):
            return f"speed {motion.value} {'default' if value is None else expression(value)}"
        case t.WaitTime(duration):
            return f"wait {expression(duration)}"
        case t.WaitUntil(condition):
            return f"wait until {expression(condition)}"
        case t.Read(file, targets):
            return f"read {file.name} into {', '.join(x.name for x in targets)}"
        case t.Clear(file):
            return f"clear {file.name}"
        case t.Write(file, values):
            return f"write {file.name} {', '.join(expression(v) for v in values) or 'signal'}"
        case t.Assign(target, value):
            return f"{target.name} := {expression(value)}"
        case t.Compute(values):
            return f"compute {', '.join(expression(v) for v in values)}"
        case t.Tool(action, duration, handling):
            return f"tool {word(action)}{_handled(handling)} for {expression(duration)}"
        case t.Measure(nominal, target):
            return f"measure {expression(nominal)} into {target.name}"
        case t.Sense(sensor, target):
            return f"sense {word(sensor)} into {target.name}"
        case t.Mark(name, binding):
            bound = f" with {', '.join(_binding(b) for b in binding)}" if binding else ""
            return f"mark {transition(name)}{bound}"
        case t.Stop(message):
            return f"stop {', '.join(expression(m) for m in message)}"
        case t.Call(procedure):
            return f"call {procedure.name}"
        case t.Return():
            return "return"
        case t.Label(name):
            return f"{name}:"
        case t.Goto(label):
            return f"goto {label.name}"
        case t.Exit(condition):
            return f"exit when {expression(condition)}" if condition else "exit"
        case _:
            assert_never(s)


def statements(body: Iterable[t.Statement], indent: str = "") -> Iterator[str]:
    """The lines of statements."""
    deeper = indent + INDENT
    for s in body:
        match s:
            case t.If(branches, otherwise):
                for i, b in enumerate(branches):
                    yield f"{indent}{'elsif' if i else 'if'} {expression(b.condition)} then"
                    yield from statements(b.body, deeper)
                if otherwise is not None:
                    yield f"{indent}else"
                    yield from statements(otherwise, deeper)
                yield f"{indent}end if"
            case t.While(condition, inner):
                yield f"{indent}while {expression(condition)} loop"
                yield from statements(inner, deeper)
                yield f"{indent}end loop"
            case t.Loop(inner):
                yield f"{indent}loop"
                yield from statements(inner, deeper)
                yield f"{indent}end loop"
            case _:
                yield indent + simple(s)


def type_name(name: t.TypeName) -> str:
    """`pose single`; of a column of a list of records, that of its items."""
    kind = ELEMENT[name.type] if name.row else name.type
    return f"{kind}{' single' if name.single else ''}"


def held(types: Iterable[t.TypeName]) -> str:
    """What a file holds: `int, rows(pose single, word)`."""
    out: list[str] = []
    for row, columns in groupby(types, lambda x: x.row):
        names = map(type_name, columns)
        out += [f"{ROWS}({', '.join(names)})"] if row else names
    return ", ".join(out)


def declaration(x: t.Declaration) -> str:
    """The line of a declaration."""
    match x:
        case t.File(direction, name, path, types):
            return f"{direction.value} {name} {quoted(path)} : {held(types)}"
        case t.Const(name, value):
            return f"const {name} = {expression(value)}"
        case t.Variable(name, kind, initial):
            start = f" := {expression(initial)}" if initial is not None else ""
            return f"var {name} : {type_name(kind)}{start}"
        case _:
            assert_never(x)


def program(p: t.Program) -> str:
    """The whole script."""
    lines = [f"program {p.name}", *(declaration(x) for x in p.declarations)]
    for procedure in p.procedures:
        lines += [
            "",
            f"procedure {procedure.name}",
            *statements(procedure.body, INDENT),
            "end procedure",
        ]
    lines += ["", "begin", *statements(p.body, INDENT), "end program", ""]
    return "\n".join(lines)
