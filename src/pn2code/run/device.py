"""What carries out the commands of a device: time passes, nothing moves."""

from __future__ import annotations

import math

import numpy as np

from pn2code.robot.active_motion import Motion, MotionKind
from pn2code.robot.commands import Command, Pose, ToolAction, Wait
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.trajectories import Still

_NOWHERE = Pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class DeviceExecutor:
    """The counterpart of `RobotExecutor` for a conveyor, a gauge, an operator's panel: no arm, no place."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.motion: Motion | None = None

    def begin(self, command: Command, now: float) -> Motion:
        """Begins an action or a wait; MotionFault for whatever needs an arm."""
        if not isinstance(command, ToolAction | Wait):
            raise MotionFault("bad-command", f"device `{self.name}` has no arm")
        seconds = command.duration
        if not (seconds >= 0.0 and math.isfinite(seconds)):
            raise MotionFault(
                "bad-command", f"device `{self.name}`: a duration of {seconds:g} s is not possible"
            )
        kind: MotionKind = "tool" if isinstance(command, ToolAction) else "wait"
        self.motion = Motion(
            self.name, command, kind, now, Still(np.zeros(0), seconds), _NOWHERE, _NOWHERE,
            step=max(seconds, 0.02),
        )  # fmt: skip
        return self.motion

    def finish(self) -> None:
        """The action has ended."""
        self.motion = None

    def stop(self, now: float) -> None:
        """The action is broken off."""
        self.motion = None
