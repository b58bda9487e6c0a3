"""What a transition of a robot tells the robot to do, by the net: the calls of its primitives, in order.

with Primitives(game, config.primitives) as primitives:
    marking, element = game.occur(marking, element)
    primitives.taken()        # (MoveJoint(Pose(...)),)
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import TracebackType
from typing import Any, Self

from pn2code.cell.config import Primitive
from pn2code.robot import commands
from pn2code.semantics.evaluate import Evaluator
from pn2code.semantics.game import Game
from pn2code.semantics.values import Native, Value

_NAMES = ("x", "y", "z", "rx", "ry", "rz")


class Primitives:
    """Notes each call of a primitive, as long as the block lasts; what it gives stays the same."""

    def __init__(self, game: Game, primitives: Mapping[str, Primitive]) -> None:
        self._evaluator = game.evaluator
        self._called: list[commands.Command] = []
        self._own: dict[int, Value] = {}
        self._noting: dict[int, Value] = {}
        symbols = game.net.program.globals
        for name, primitive in primitives.items():
            symbol = symbols.get(name)
            if symbol is not None and symbol.uid in self._evaluator.globals:
                own = self._evaluator.globals[symbol.uid]
                self._own[symbol.uid] = own
                self._noting[symbol.uid] = Native(name, 1, self._noted(primitive, own))

    def __enter__(self) -> Self:
        self._evaluator.globals.update(self._noting)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._evaluator.globals.update(self._own)

    def taken(self) -> tuple[commands.Command, ...]:
        """The calls since the last time that this was asked."""
        called = tuple(self._called)
        self._called.clear()
        return called

    def _noted(self, primitive: Primitive, own: Value) -> Any:
        def noted(evaluator: Evaluator, argument: Value) -> Any:
            self._called.append(command(primitive, argument))
            return evaluator.call(own, argument)

        return noted


def command(primitive: Primitive, argument: Any) -> commands.Command:
    """What the robot is told by a call: poses in m and rad."""
    match primitive.command:
        case "move_joint":
            return commands.MoveJoint(_pose(argument))
        case "move_linear":
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
