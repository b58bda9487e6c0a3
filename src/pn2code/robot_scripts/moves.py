"""The moves that a call of a primitive makes an arm do, as statements of a script.

moves.of(primitive, argument, at, span)     # [Move(JOINT, before(p, 100 mm)), Move(LINEAR, p, "world")]

`pn2code.primitive_calls.told` says the same of what the net calls, in commands; `conform` compares the two.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.cell.axes_types import are_axes
from pn2code.cell.config import Primitive
from pn2code.diagnostics import Span
from pn2code.robot_scripts import codes
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import Rec, Scalar, Value, as_quantity
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl


def parts_of(primitive: Primitive, argument: Value) -> tuple[Value, list[Value], Value | None]:
    """What a function takes: poses or a joint position, positions of external axes, and the speed, if it has one."""
    if primitive.to is not None:
        return Rec(()), [], None
    if not isinstance(argument, Rec) or not argument.fields or argument.fields[0][0] != "1":
        return (argument, [], None) if primitive.places else (Rec(()), [argument], None)
    fields = argument.fields
    takes, places = primitive.takes, primitive.places
    speed = fields[takes][1] if len(fields) > takes else None
    own = fields[0][1] if places == 1 else Rec(fields[:places])
    return own, [value for _, value in fields[places:takes]], speed


def of(
    primitive: Primitive,
    argument: Value,
    positions: Sequence[Value],
    at: t.Expression | None,
    span: Span,
) -> list[t.Move]:
    """The moves of a call.

    Args:
        primitive: the command.
        argument: where the arm goes; positions: where external axes go.
        at: how fast.
        span: of the call.

    Raises:
        UnsupportedError: the argument says no place to go to.
    """
    name, frame = primitive.function, primitive.frame
    ramp = None if primitive.acceleration is None else t.Quantity(primitive.acceleration, "%")
    along = tuple(_external(primitive, positions, span))
    tcp = primitive.tcp
    elbow = None if primitive.arm_angle is None else t.Quantity(primitive.arm_angle, "deg")
    out: list[t.Move] = []
    if primitive.depart:
        speed = at if primitive.is_linear else None
        back = _pose(0.0, 0.0, -primitive.depart)
        out.append(t.Move(t.Motion.LINEAR, back, "tool", speed, (), ramp, tcp=tcp))
    match primitive.command:
        case "move_linear" if primitive.via:
            assert isinstance(argument, Rec), "the cell has been checked"
            *through, goal = (pose(value, name, span) for _, value in argument.fields)
            zone, by = t.Quantity(primitive.blend, "mm"), tuple(through)
            out.append(t.Move(t.Motion.LINEAR, goal, frame, at, by, ramp, along, tcp, elbow, zone))
        case "move_linear":
            goal = pose(argument, name, span)
            if primitive.approach:
                distance = t.Quantity(primitive.approach, "mm")
                before = t.CallExpression("before", (goal, distance))
                out.append(t.Move(t.Motion.JOINT, before, frame, _ALL, (), ramp, along, tcp, elbow))
            out.append(t.Move(t.Motion.LINEAR, goal, frame, at, (), ramp, along, tcp, elbow))
        case "move_circular":
            assert isinstance(argument, Rec), "the cell has been checked"
            via, goal = (pose(argument.get(label), name, span) for label in ("1", "2"))
            out.append(t.Move(t.Motion.CIRCULAR, goal, frame, at, (via,), ramp, along, tcp, elbow))
        case "move_axes":
            axes = _axes(argument, name, span)
            out.append(t.Move(t.Motion.JOINT, axes, None, at, (), ramp, along))
        case "move_external":
            out.append(t.Move(t.Motion.EXTERNAL, None, None, at, (), ramp, along))
        case "move_joint":
            goal = pose(argument, name, span)
            out.append(t.Move(t.Motion.JOINT, goal, frame, at, (), ramp, along, tcp, elbow))
        case _:
            out.append(t.Move(t.Motion.JOINT, None, None, at, (), ramp))
    return out


def _external(primitive: Primitive, positions: Sequence[Value], span: Span) -> Iterator[t.Along]:
    if primitive.to is not None:
        ((axis, slides),) = primitive.along
        yield t.Along(axis, t.Quantity(primitive.to, "mm" if slides else "deg"), slides)
        return
    for (axis, is_track), value in zip(primitive.along, positions, strict=True):
        if not isinstance(value, Scalar):
            raise UnsupportedError(
                f"`{primitive.function}` takes the position of `{axis}`", span, codes.PRIMITIVE
            )
        kind = tdl.Type.LENGTH if is_track else tdl.Type.ANGLE
        yield t.Along(axis, as_quantity(value, kind).exp, is_track)


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
            f"`{name}` takes a joint position: a record of reals a1 .. a6 or j1 .. j6, one for each axis",
            span,
            codes.PRIMITIVE,
        )
    return t.Axes(tuple(angles))


def _pose(x: float, y: float, z: float) -> t.CallExpression:
    """An increment without a turn."""
    lengths = tuple(t.Quantity(v, "mm") for v in (x, y, z))
    return t.CallExpression("pose", (*lengths, *(t.Quantity(0.0, "deg"),) * 3))
