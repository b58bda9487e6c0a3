"""The arm of a robot that runs by itself: exact motions on the wall clock, without a simulator."""

from __future__ import annotations

import time

from pn2code.robot.commands import Command, Pose
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.transforms import describe
from pn2code.run.device import DeviceExecutor
from pn2code.run.robot import ArmError


class MovingArm:
    """Implements `pn2code.run.robot.Arm` with the motions of a cell's robot, or the actions of a device.

    Args:
        speed: seconds of the arm per second of the wall clock.
    """

    def __init__(self, executor: RobotExecutor | DeviceExecutor, speed: float = 1.0) -> None:
        self._executor = executor
        self._speed = speed

    def begin(self, command: Command) -> tuple[float, Pose | None]:
        """Plans the motion; `ArmError` when it cannot be done."""
        try:
            motion = self._executor.begin(command, self._now())
        except MotionFault as fault:
            raise ArmError(str(fault)) from None
        return motion.duration / self._speed, motion.result

    def finish(self) -> None:
        """The robot is where the motion ends."""
        self._executor.finish()

    def stop(self) -> str:
        """Stands where it is; says where if it was under way."""
        motion = self._executor.motion
        if motion is None:
            return ""
        now = min(self._now(), motion.ends)
        self._executor.stop(now)
        part = (now - motion.began) / motion.duration if motion.duration else 1.0
        text = f"`{motion.kind}` was broken off after {100 * part:.0f} %"
        if isinstance(self._executor, DeviceExecutor):
            return text
        return f"{text}, at TCP pose {describe(self._executor.pose)}"

    def joints(self) -> list[float] | None:
        """How the arm stands now (rad); None: a device has none."""
        if isinstance(self._executor, DeviceExecutor):
            return None
        motion = self._executor.motion
        q = self._executor.q if motion is None else motion.q(min(self._now(), motion.ends))
        return [float(v) for v in q]

    def _now(self) -> float:
        return time.monotonic() * self._speed
