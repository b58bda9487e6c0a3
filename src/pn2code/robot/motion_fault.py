"""What a motion can fail with: a command that cannot be carried out, a motion that must not go on."""

from __future__ import annotations

from typing import Literal

from pn2code.robot.commands import Pose

FaultKind = Literal[
    "unreachable",
    "joint-limit",
    "axis-speed",
    "singularity",
    "collision",
    "wrong-tool",
    "bad-command",
]


class MotionFault(Exception):
    """A command that cannot be carried out, or a motion that must not go on.

    Args:
        kind: the class of fault.
        message: lower case, no full stop; names robot, axis, pose.
        robot: name in the cell; filled in by the executor.
        pose: the TCP pose (world) it happens at, if any.
        q: the joint position, rad, if any.
        time: seconds from the beginning of the motion, if it was planned that far.
    """

    def __init__(
        self,
        kind: FaultKind,
        message: str,
        *,
        robot: str = "",
        pose: Pose | None = None,
        q: tuple[float, ...] = (),
        time: float | None = None,
    ) -> None:
        super().__init__(message)
        self.kind: FaultKind = kind
        self.message = message
        self.robot = robot
        self.pose = pose
        self.q = q
        self.time = time
