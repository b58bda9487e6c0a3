"""A command under way: where the joints are at any time, and which turntables and belts it moves."""

from __future__ import annotations

from typing import Literal
from weakref import WeakKeyDictionary

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.commands import Command, Pose
from pn2code.robot.external import ExternalAxis
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.trajectories import LinearTrajectory, Trajectory
from pn2code.robot.transforms import Array

_MOVED: WeakKeyDictionary[Trajectory, Array] = WeakKeyDictionary()
"""What `moved` has worked out."""
MotionKind = Literal["ptp", "lin", "circ", "blend", "axis", "tool", "measure", "wait"]
PATHS: frozenset[MotionKind] = frozenset({"lin", "circ", "blend"})
"""Those that lead a TCP along a path: to a part, and away from it."""
_STILL = 1e-9  # rad: a turntable that turns by less stands


@frozen(eq=False)
class Motion:
    """A command under way.

    Args:
        robot: its name.
        command: what was asked for.
        began: time of the beginning, s; it ends at `began + duration`.
        trajectory: joint positions, time from 0.
        start: TCP pose in the world at the beginning; target: at the end.
        result: of a measurement.
        step: s, how often to look while it lasts: on a line the TCP goes 5 mm meanwhile.
    """

    robot: str
    command: Command
    kind: MotionKind
    began: float
    trajectory: Trajectory
    start: Pose
    target: Pose
    result: Pose | None = None
    step: float = 0.02

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.trajectory.duration

    @property
    def ends(self) -> float:
        """Time of the end."""
        return self.began + self.duration

    def q(self, now: float) -> Array:
        """Joint position (rad) at a time on the clock of `began`."""
        return self.trajectory.q(now - self.began)

    def sample(self, times: Array) -> Array:
        """Joint positions (n, 6) at many times: much faster than one by one."""
        return self.trajectory.sample(np.clip(times - self.began, 0.0, self.duration))


def turned(robot: CellRobot, motion: Motion) -> frozenset[str]:
    """The turntables, belts and other axes of devices that a motion moves, as `left/plate`."""
    return turned_by(robot, motion.trajectory)


def turned_by(
    robot: CellRobot, path: Trajectory, axes: tuple[ExternalAxis, ...] | None = None
) -> frozenset[str]:
    """The same of a trajectory; `axes`: of these alone."""
    axes = robot.carrying if axes is None else axes
    tables = {robot.index(axis.name): axis.name for axis in axes}
    if not tables:
        return frozenset()
    off = np.abs(moved(path))
    return frozenset(f"{robot.name}/{name}" for i, name in tables.items() if off[i] > _STILL)


def moved(path: Trajectory) -> Array:
    """How far a trajectory moves each axis; of one whose ends are poses it is worked out once, not at each look."""
    if not isinstance(path, LinearTrajectory | AlongTrajectory):
        return np.asarray(path.q(path.duration) - path.q(0.0))
    if path not in _MOVED:
        _MOVED[path] = np.asarray(path.q(path.duration) - path.q(0.0))
    return _MOVED[path]
