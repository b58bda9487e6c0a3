"""How far the TCP is from where it should be (m)."""

from __future__ import annotations

import numpy as np

from pn2code.robot.commands import Pose


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
