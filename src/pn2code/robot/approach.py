"""The pose before another one, from which a tool comes straight.

pose_before((500.0, 0.0, 300.0, 180.0, 0.0, 0.0), 100.0)     # (500.0, 0.0, 400.0, 180.0, 0.0, 0.0): the tool looks down

One function for scripts and for what the net says, so that both are equal to the last digit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence


def pose_before(pose: Sequence[float], distance: float) -> tuple[float, ...]:
    """A pose (x, y, z, and three angles in degrees) moved back along its own z; NaN where an angle is not finite."""
    x, y, z, rx, ry, rz = pose
    if not all(map(math.isfinite, (rx, ry, rz))):
        return (math.nan,) * 3 + (rx, ry, rz)
    a, b, c = (math.radians(v) for v in (rx, ry, rz))
    ahead = (
        math.cos(c) * math.sin(b) * math.cos(a) + math.sin(c) * math.sin(a),
        math.sin(c) * math.sin(b) * math.cos(a) - math.cos(c) * math.sin(a),
        math.cos(b) * math.cos(a),
    )
    return (
        x - distance * ahead[0],
        y - distance * ahead[1],
        z - distance * ahead[2],
        rx,
        ry,
        rz,
    )
