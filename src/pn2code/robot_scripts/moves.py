"""The moves that a call of a primitive makes an arm do, as statements of a script.

moves.of(primitive, argument, at, span)     # [Move(JOINT, before(p, 100 mm)), Move(LINEAR, p, "world")]

`pn2code.primitive_calls.told` says the same of what the net calls, in commands; `conform` compares the two.
"""

from __future__ import annotations

from pn2code.cell.axes_types import are_axes
from pn2code.cell.config import CommandName, Primitive
from pn2code.diagnostics import Span
from pn2code.robot_scripts import codes
from pn2code.robot_scripts.values import Rec, Scalar, UnsupportedError, Value, as_quantity
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl


def with_speed(command: CommandName, argument: Value) -> tuple[Value, Value | None]:
    """What a function takes, without the speed beside it; and the speed, if it takes one."""
    takes = 2 if command == "move_circular" else 1
    if not isinstance(argument, Rec) or len(argument.fields) != takes + 1:
        return argument, None
    speed = argument.get(str(takes + 1))
    if takes == 1:
        return argument.get("1"), speed
    return Rec(argument.fields[:takes]), speed


def of(primitive: Primitive, argument: Value, at: t.Expression | None, span: Span) -> list[t.Move]:
    """The moves of a call.

    Args:
        primitive: the command.
        argument: where the arm goes.
        at: how fast.
        span: of the call.

    Raises:
        UnsupportedError: the argument says no place to go to.
    """
    name, frame = primitive.function, primitive.frame
    ramp = None if primitive.acceleration is None else t.Quantity(primitive.acceleration, "%")
    out: list[t.Move] = []
    if primitive.depart:
        speed = at if primitive.is_linear else None
        back = _pose(0.0, 0.0, -primitive.depart)
        out.append(t.Move(t.Motion.LINEAR, back, "tool", speed, None, ramp))
    match primitive.command:
        case "move_linear":
            goal = pose(argument, name, span)
            if primitive.approach:
                distance = t.Quantity(primitive.approach, "mm")
                before = t.CallExpression("before", (goal, distance))
                out.append(t.Move(t.Motion.JOINT, before, frame, _ALL, None, ramp))
            out.append(t.Move(t.Motion.LINEAR, goal, frame, at, None, ramp))
        case "move_circular":
            assert isinstance(argument, Rec), "the cell has been checked"
            via, goal = (pose(argument.get(label), name, span) for label in ("1", "2"))
            out.append(t.Move(t.Motion.CIRCULAR, goal, frame, at, via, ramp))
        case "move_axes":
            out.append(t.Move(t.Motion.JOINT, _axes(argument, name, span), None, at, None, ramp))
        case "move_joint":
            goal = pose(argument, name, span)
            out.append(t.Move(t.Motion.JOINT, goal, frame, at, None, ramp))
        case _:
            out.append(t.Move(t.Motion.JOINT, None, None, at, None, ramp))
    return out


_ALL = t.Quantity(100.0, "%")


def pose(argument: Value, name: str, span: Span) -> t.Expression:
    """The pose that a function is told."""
    if not (isinstance(argument, Scalar) and argument.type is tdl.Type.POSE):
        raise UnsupportedError(
            f"`{name}` takes a pose: a record of six reals x y z rx ry rz", span, codes.PRIMITIVE
        )
    return argument.exp


def _axes(argument: Value, name: str, span: Span) -> t.Axes:
    angles: list[t.Expression] = []
    if isinstance(argument, Rec) and are_axes(label for label, _ in argument.fields):
        for _, value in sorted(argument.fields, key=lambda field: field[0]):
            if isinstance(value, Scalar):
                angles.append(as_quantity(value, tdl.Type.ANGLE).exp)
    if len(angles) != len(getattr(argument, "fields", ())) or not angles:
        raise UnsupportedError(
            f"`{name}` takes a joint position: a record of six reals a1 .. a6 or j1 .. j6",
            span,
            codes.PRIMITIVE,
        )
    return t.Axes(tuple(angles))


def _pose(x: float, y: float, z: float) -> t.CallExpression:
    """An increment without a turn."""
    lengths = tuple(t.Quantity(v, "mm") for v in (x, y, z))
    return t.CallExpression("pose", (*lengths, *(t.Quantity(0.0, "deg"),) * 3))
