"""How far the TCP is from where it should be (m)."""

from __future__ import annotations

import numpy as np

from pn2code.robot.active_motion import Motion
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.commands import Pose, tcp_of
from pn2code.robot.monitor import Sample
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import pose_of
from pn2code.run.stops import Paused


def _point(pose: Pose) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.array([pose.x, pose.y, pose.z])


def distance(a: Pose, b: Pose) -> float:
    """Between two positions."""
    return float(np.linalg.norm(_point(a) - _point(b)))


def distance_to_line(pose: Pose, start: Pose, end: Pose) -> float:
    """From the straight segment between two positions."""
    p, a, b = _point(pose), _point(start), _point(end)
    way = b - a
    length2 = float(way @ way)
    s = 0.0 if length2 == 0.0 else min(1.0, max(0.0, float((p - a) @ way) / length2))
    return float(np.linalg.norm(p - (a + s * way)))


def off_line(motion: Motion, seen: Sample) -> float:
    """How far the TCP is off its line, m; on a turntable off the line on its plate."""
    path = motion.trajectory
    if isinstance(path, Paused):
        path = path.trajectory
    if isinstance(path, LinearTrajectory) and tcp_of(motion.command):
        ends = path.line.at(np.array([0.0, 1.0]))
        return distance_to_line(pose_of(path.kinematics.forward(seen.q)), *map(pose_of, ends))
    if not isinstance(path, AlongTrajectory):
        return distance_to_line(seen.pose, motion.start, motion.target)
    now = path.on_plate(seen.q)
    first, last = (pose_of(x) for x in path.way.inner.at(np.array([0.0, 1.0])))
    return distance_to_line(pose_of(now), first, last)
