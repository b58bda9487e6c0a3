"""Types of primitives: what the function of an entry of `[primitives]` takes and gives."""

from __future__ import annotations

from pn2code.cell.axes_types import is_axes
from pn2code.cell.config import GOING, CommandName, Primitive
from pn2code.cell.pose_types import is_pose
from pn2code.ml.core.types import INT, REAL, UNIT, TFun, TRecord, TVar, Type

TAKES: dict[CommandName, str] = {
    "move_joint": "POSE -> unit` or `POSE * real -> unit",
    "move_linear": "POSE -> unit` or `POSE * real -> unit",
    "move_axes": "AXES -> unit` or `AXES * real -> unit",
    "move_circular": "POSE * POSE -> unit` or `POSE * POSE * real -> unit",
    "move_external": "real -> unit` or `real * real -> unit",
    "move_home": "unit -> unit",
    "measure": "POSE -> POSE",
    "tool": "unit -> unit",
    "wait": "real -> unit",
}
"""Type of the function of each command; POSE and AXES are records of six reals."""


def result_of(t: Type) -> Type:
    """What a function gives when all its arguments have come."""
    while isinstance(t, TFun):
        t = t.result
    return t


def carries_nothing(t: Type) -> bool:
    """Whether a value of a type says nothing: it is made of units alone."""
    return isinstance(t, TRecord) and all(carries_nothing(x) for _, x in t.fields)


def _is_pose(t: Type) -> bool:
    return isinstance(t, TVar) or is_pose(t)


def takes_any_pose(t: Type) -> bool:
    """Whether a function that is told a pose takes anything in its place."""
    match t:
        case TFun(TRecord((("1", pose), ("2", _))), _) | TFun(pose, _):
            return isinstance(pose, TVar)
        case _:
            return False


RECORDS = {
    "POSE": "POSE is a record of six reals x y z rx ry rz",
    "AXES": "AXES is a record of a real for each axis, a1 .. a6 or j1 .. j6 (of an arm with four axes to a4, with "
    "seven to a7), in degrees, of axes that slide in mm",
}
"""What the names of records in these types stand for."""


def taking(primitive: Primitive) -> str:
    """The type of the function of an entry."""
    text = TAKES[primitive.command]
    count = len(primitive.along)
    if primitive.to is not None:
        return "unit -> unit"
    if not count and not primitive.via:
        return text
    places = {"move_axes": ["AXES"], "move_external": []}
    poses = ["POSE"] * primitive.places
    own = [*places.get(primitive.command, poses), *["real"] * count]
    return f"{' * '.join(own)} -> unit` or `{' * '.join([*own, 'real'])} -> unit"


def _parts(t: Type, primitive: Primitive) -> list[Type] | None:
    """What a function takes: poses or axes, positions of external axes, and a speed; None: not so many."""
    count = primitive.takes
    is_tuple = isinstance(t, TRecord) and t.fields and t.fields[0][0] == "1"
    parts = [x for _, x in t.fields] if isinstance(t, TRecord) and is_tuple else [t]
    return parts if len(parts) in (count, count + 1) else None


def moves_at_speed(t: Type, primitive: Primitive) -> bool:
    """Whether a function takes a speed beside where to go: mm/s of the TCP, or percent of the speeds of the axes."""
    if not isinstance(t, TFun) or primitive.command not in GOING or primitive.to is not None:
        return False
    parts = _parts(t.argument, primitive)
    return parts is not None and len(parts) > primitive.takes and _goes(parts, primitive)


def _goes(parts: list[Type], primitive: Primitive) -> bool:
    """Whether these say where a move goes: places, then numbers."""
    places, numbers = parts[: primitive.places], parts[primitive.places :]
    match primitive.command:
        case "move_axes":
            fit = all(map(is_axes, places))
        case "move_circular":
            fit = all(map(is_pose, places))
        case "move_linear" if primitive.via:
            fit = all(map(is_pose, places))
        case _:
            fit = all(map(_is_pose, places))
    return fit and all(x in (REAL, INT) for x in numbers)


def fits(t: Type, primitive: Primitive) -> bool:
    """Whether a function of a type can be what an entry says."""
    if not isinstance(t, TFun):
        return False
    takes, gives = t.argument, t.result
    match primitive.command:
        case "move_external" if primitive.to is not None:
            return (takes == UNIT or isinstance(takes, TVar)) and gives == UNIT
        case "move_joint" | "move_linear" | "move_axes" | "move_circular" | "move_external":
            parts = _parts(takes, primitive)
            return parts is not None and _goes(parts, primitive) and gives == UNIT
        case "measure":
            return _is_pose(takes) and _is_pose(gives)
        case "wait":
            return takes in (REAL, INT, UNIT) and gives == UNIT
        case "move_home" | "tool":
            return (takes == UNIT or isinstance(takes, TVar)) and gives == UNIT


def other_commands(t: Type) -> str:
    """Which commands a function of this type can be."""
    known = [c for c in TAKES if c != "move_external" and fits(t, Primitive("", c))]
    if not known:
        return "change the function's declaration in the net"
    return f"a function of this type can be {' or '.join(f'`{c}`' for c in known)}"
