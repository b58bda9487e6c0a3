"""What a transition of a robot tells the robot to do, according to the net: the calls of its primitives, in order.

calls = Calls()
listener = Listener(game, config.primitives)
with listener.noting(calls):
    marking, element = game.occur(marking, element)
calls        # [MoveJoint(Pose(...))]

What counts is what the net calls, not what `[primitives]` names: a function that gives no value and is not made of
primitives can be called for no other reason than to be carried out. Such a call is an `Unknown`, which no script
commands.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import Any

import pn2code.robot.commands as commands
from pn2code.base.frozen import frozen
from pn2code.cell.config import GOING, Primitive
from pn2code.cell.reach import Reach
from pn2code.ml.core.types import UNIT, TFun
from pn2code.robot.approach import pose_before
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Native, Value

_NAMES = ("x", "y", "z", "rx", "ry", "rz")


@frozen
class Unknown:
    """A call of a function that is no command, and does nothing else."""

    function: str

    def __str__(self) -> str:
        """For people."""
        return f"`{self.function}`, which is no command"


Calls = list[commands.Command | Unknown]
Heard = tuple[commands.Command | Unknown, ...]


class Listener:
    """Hears the calls of a token game; what the functions give stays the same.

    Args:
        game: the token game.
        primitives: the functions that are commands, by name.
    """

    def __init__(self, game: Game, primitives: Mapping[str, Primitive]) -> None:
        self._values = game.evaluator.globals
        self._calls = Calls()
        symbols = game.net.program.globals
        own = {symbols[name].uid: primitive for name, primitive in primitives.items()}
        self._listening = {uid: self._noted(uid, partial(told, p)) for uid, p in own.items()}
        reach = Reach(game.net.program)
        for symbol in reach.functions():
            is_idle = isinstance(symbol.type, TFun) and symbol.type.result == UNIT
            acts = any(s.uid in own for s in reach.from_symbol(symbol))
            if is_idle and not acts and symbol.uid in self._values:
                self._listening[symbol.uid] = self._noted(
                    symbol.uid, partial(_unknown, symbol.name)
                )

    def _noted(self, uid: int, heard: Callable[[Any], Heard]) -> Native:
        function = self._values[uid]

        def note(evaluator: Evaluator, argument: Value) -> Any:
            self._calls.extend(heard(argument))
            return evaluator.call(function, argument)

        return Native("", 1, note)

    @contextmanager
    def noting(self, calls: Calls) -> Iterator[None]:
        """Appends each call, as long as the block lasts."""
        kept = {uid: self._values[uid] for uid in self._listening}
        self._calls = calls
        self._values.update(self._listening)
        try:
            yield
        finally:
            self._values.update(kept)


def _unknown(function: str, _argument: Any) -> Heard:
    return (Unknown(function),)


def told(primitive: Primitive, argument: Any) -> tuple[commands.Command, ...]:
    """What the robot is told by a call, in order: poses in m and rad."""
    speed = primitive.speed
    # A tuple whose first value is a tuple: that of a pose or a joint position is a number.
    is_several = isinstance(argument, tuple) and (
        (primitive.command == "move_external" and primitive.to is None)
        or (primitive.command in GOING and len(argument) > 0 and isinstance(argument[0], tuple))
    )
    values = argument if is_several else (argument,)
    if primitive.command in GOING and primitive.to is None and len(values) > primitive.takes:
        *values, speed = values
    along = _along(primitive, values)
    # The factors are those of scripts (`pn2code.tdl`), so that speeds are equal to the last digit.
    fraction = 1.0 if speed is None else speed * 0.01
    metres = None if speed is None else speed / 1000.0
    frame, tcp = primitive.frame or "world", primitive.tcp
    elbow = None if primitive.arm_angle is None else math.radians(primitive.arm_angle)
    ramp = 1.0 if primitive.acceleration is None else primitive.acceleration * 0.01
    match primitive.command:
        case "move_joint":
            pose = _pose(values[0])
            moved_to = commands.MoveJoint(pose, fraction, frame, ramp, along, tcp, elbow)
            return (*_departure(primitive, None, ramp), moved_to)
        case "move_axes":
            # By label, a1 .. a6: the order of SML.
            axes = tuple(math.radians(float(v)) for v in values[0])
            moved = commands.MoveAxes(axes, fraction, ramp, along)
            return (*_departure(primitive, None, ramp), moved)
        case "move_external":
            return (commands.MoveExternal(along, fraction, ramp),)
        case "move_linear":
            assert primitive.frame is not None, "an entry without a frame is an error"
            *through, pose = map(_pose, values[: primitive.places])
            way, zone = tuple(through), primitive.blend / 1000.0
            line = commands.MoveLinear(pose, frame, metres, ramp, along, tcp, elbow, way, zone)
            if not primitive.approach:
                return (*_departure(primitive, metres, ramp), line)
            before = _si(*pose_before(_numbers(values[0]), primitive.approach))
            there = commands.MoveJoint(before, 1.0, frame, ramp, along, tcp, elbow)
            return (*_departure(primitive, metres, ramp), there, line)
        case "move_circular":
            assert primitive.frame is not None, "an entry without a frame is an error"
            via, end = map(_pose, values[:2])
            return (commands.MoveCircular(via, end, frame, metres, ramp, along, tcp, elbow),)
        case "move_home":
            return (*_departure(primitive, None, ramp), commands.MoveHome(fraction, ramp))
        case "measure":
            return (commands.Measure(_pose(argument)),)
        case "tool":
            action = primitive.action
            return (commands.ToolAction(action, primitive.duration_s, primitive.handling),)
        case "wait":
            seconds = argument if isinstance(argument, int | float) else primitive.duration_s
            return (commands.Wait(float(seconds)),)


def _along(primitive: Primitive, values: Any) -> tuple[commands.Along, ...]:
    """Where external axes go: mm and degrees, behind the poses."""
    if not primitive.along:
        return ()
    if primitive.to is not None:
        values = (*[None] * primitive.places, primitive.to)
    return tuple(
        commands.Along(axis, float(v) / 1000.0 if is_track else math.radians(float(v)), is_track)
        for (axis, is_track), v in zip(primitive.along, values[primitive.places :], strict=True)
    )


def _departure(
    primitive: Primitive, speed: float | None, ramp: float
) -> tuple[commands.MoveLinear, ...]:
    """Straight back, before a move that says so."""
    if not primitive.depart:
        return ()
    back = _si(0.0, 0.0, -primitive.depart, 0.0, 0.0, 0.0)
    return (commands.MoveLinear(back, "tool", speed, ramp, tcp=primitive.tcp),)


def _numbers(argument: Any) -> tuple[float, ...]:
    """Of a pose, mm and degrees. Values of records lie in the order of SML: by label."""
    parts = dict(zip(sorted(_NAMES), argument, strict=True))
    return tuple(float(parts[name]) for name in _NAMES)


def _pose(argument: Any) -> commands.Pose:
    return _si(*_numbers(argument))


def _si(x: float, y: float, z: float, *angles: float) -> commands.Pose:
    return commands.Pose(x / 1000.0, y / 1000.0, z / 1000.0, *map(math.radians, angles))
