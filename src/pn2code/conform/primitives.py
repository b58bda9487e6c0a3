"""What a transition of a robot tells the robot to do, by the net: the calls of its primitives, in order.

calls: list[Command] = []
with noting(game, config.primitives, calls):
    marking, element = game.occur(marking, element)
calls        # [MoveJoint(Pose(...))]
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from pn2code.cell.config import Primitive
from pn2code.robot import commands
from pn2code.semantics.evaluate import Evaluator
from pn2code.semantics.game import Game
from pn2code.semantics.values import Native, Value

_NAMES = ("x", "y", "z", "rx", "ry", "rz")


Calls = list[commands.Command]


@contextmanager
def noting(game: Game, primitives: Mapping[str, Primitive], calls: Calls) -> Iterator[None]:
    """Appends each call of a primitive, as long as the block lasts; what the primitives give stays the same."""
    values = game.evaluator.globals
    symbols = game.net.program.globals
    own = {
        symbols[name].uid: (primitive, values[symbols[name].uid])
        for name, primitive in primitives.items()
        if name in symbols and symbols[name].uid in values
    }

    def noted(primitive: Primitive, function: Value) -> Native:
        def note(evaluator: Evaluator, argument: Value) -> Any:
            calls.append(command(primitive, argument))
            return evaluator.call(function, argument)

        return Native(primitive.function, 1, note)

    values.update({uid: noted(*found) for uid, found in own.items()})
    try:
        yield
    finally:
        values.update({uid: function for uid, (_, function) in own.items()})


def command(primitive: Primitive, argument: Any) -> commands.Command:
    """What the robot is told by a call: poses in m and rad."""
    match primitive.command:
        case "move_joint":
            return commands.MoveJoint(_pose(argument))
        case "move_linear":
            assert primitive.frame is not None, "an entry without a frame is an error"
            return commands.MoveLinear(_pose(argument), primitive.frame)
        case "move_home":
            return commands.MoveHome()
        case "measure":
            return commands.Measure(_pose(argument))
        case "tool":
            return commands.ToolAction(primitive.action, primitive.duration_s)
        case "wait":
            seconds = argument if isinstance(argument, int | float) else primitive.duration_s
            return commands.Wait(float(seconds))


def _pose(argument: Any) -> commands.Pose:
    """A record in mm and degrees. Values of records lie in the order of SML: by label."""
    parts = dict(zip(sorted(_NAMES), argument, strict=True))
    x, y, z, *angles = (float(parts[name]) for name in _NAMES)
    return commands.Pose(x / 1000.0, y / 1000.0, z / 1000.0, *map(math.radians, angles))
