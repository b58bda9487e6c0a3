"""A robot or device of a run, and what stops the whole cell."""

from __future__ import annotations

import numpy as np

from pn2code.base.frozen import record
from pn2code.emission.output import Block
from pn2code.robot.active_motion import Motion
from pn2code.robot.commands import ToolAction
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.transforms import Array
from pn2code.run.device import DeviceExecutor
from pn2code.run.files import RobotFiles
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import AwaitFile, Sense


@record
class RobotRunner:
    """One robot or device: its script's interpreter, its arm if it has one, and what it is doing.

    Args:
        script: file name, for messages.
        blocks: which lines of the script implement which net element.
    """

    name: str
    script: str
    interpreter: Interpreter
    files: RobotFiles
    executor: RobotExecutor | DeviceExecutor
    blocks: tuple[Block, ...] = ()
    motion: Motion | None = None
    line: int = 0
    activity: str = ""
    waiting: AwaitFile | None = None
    asking: Sense | None = None
    finished: bool = False

    def element_at(self, line: int) -> str:
        """The net transition that a script line implements, "" if none."""
        inside = [b for b in self.blocks if b.kind == "transition" and b.first <= line <= b.last]
        return min(inside, key=lambda b: b.last - b.first).element if inside else ""

    def at(self, line: int) -> str:
        """A line of its script, for messages, with the net transition that it implements."""
        where = self.element_at(line)
        return f"{self.script}:{line}" + (f" (net transition {where})" if where else "")

    def tool_action(self) -> str:
        """The tool action under way, "" if none."""
        command = self.motion.command if self.motion else None
        return command.action if isinstance(command, ToolAction) else ""

    @property
    def arm(self) -> RobotExecutor | None:
        """What moves; None: a device."""
        return self.executor if isinstance(self.executor, RobotExecutor) else None

    def is_moving(self, t: float) -> bool:
        """Whether its motion goes on after a time."""
        return self.motion is not None and self.motion.ends > t + 1e-12

    def joints(self, t: float) -> Array:
        """Joint position (rad) of an arm at a time not before the last event."""
        assert self.arm is not None
        return self.arm.q if self.motion is None else self.motion.q(t)

    def path(self, times: Array) -> Array:
        """Joint positions (n, 6) of an arm at many times, none before the last event."""
        assert self.arm is not None
        if self.motion is None:
            return np.tile(self.arm.q, (len(times), 1))
        return self.motion.sample(times)


class CellStoppedError(Exception):
    """The cell must stop; the message says why, in full."""


class StoppedByHand(CellStoppedError):
    """Somebody wants the cell to stop."""
