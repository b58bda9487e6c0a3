"""Where the parts of a curved panel are: what its solids (`geometry`) and its looks (`looks`) have in common."""

from __future__ import annotations

import math

import numpy as np

from pn2code.robot.robot_cell import PanelConfig
from pn2code.robot.transforms import Array

SEGMENT = math.radians(2.5)
"""Arc of one flat piece of the skin."""
FLANGE = 0.022
"""Width of a rib's flange beside it, m."""
Ends = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Two opposite corners of an upright box."""


def cut(start: float, end: float) -> list[tuple[float, float]]:
    """Equal arcs, none longer than `SEGMENT`."""
    count = max(1, math.ceil((end - start) / SEGMENT))
    edges = np.linspace(start, end, count + 1).tolist()
    return list(zip(edges, edges[1:], strict=False))


def point_at(p: PanelConfig, angle: float, radius: float) -> tuple[float, float]:
    """(y, z) at an arc angle and a radius."""
    a = p.facing + angle
    return p.axis_y + radius * math.cos(a), p.axis_z + radius * math.sin(a)


def frame(p: PanelConfig, angle: float, x: float, radius: float) -> Array:
    """A frame on the shell: x along the axis, y around, z outwards... as a 4x4."""
    a = p.facing + angle
    y, z = point_at(p, angle, radius)
    out = np.eye(4)
    sine, cosine = math.sin(a), math.cos(a)
    out[:3, 1] = (0.0, -sine, cosine)
    out[:3, 2] = (0.0, cosine, sine)
    # Right-handed: x = y cross z.
    out[:3, 0] = (-sine * sine - cosine * cosine, 0.0, 0.0)
    out[:3, 3] = (x, y, z)
    return out


def stringers(p: PanelConfig) -> list[float]:
    """Arc angles of the stringers."""
    if p.stringer_pitch <= 0.0:
        return []
    # Half a pitch beside angle 0, where the work is done.
    first = math.ceil(p.arc_from / p.stringer_pitch - 0.5)
    last = math.floor(p.arc_to / p.stringer_pitch - 0.5)
    return [(k + 0.5) * p.stringer_pitch for k in range(first, last + 1)]


def stand_places(p: PanelConfig) -> tuple[tuple[float, float], tuple[float, float]]:
    """From where to where along x the two stands are."""
    return (p.x_from - 0.06, p.x_from), (p.x_to, p.x_to + 0.06)


def stand_parts(p: PanelConfig, x0: float, x1: float) -> tuple[list[Ends], Ends]:
    """The posts of a stand and its floor beam."""
    ends = [point_at(p, a, p.radius - 0.04) for a in (p.arc_from, p.arc_to)]
    low, high = sorted(ends, key=lambda e: e[1])
    # The post of the upper edge stands inside, clear of the arc.
    posts: list[Ends] = [
        ((x0, y - 0.05, 0.02), (x1, y + 0.05, z)) for y, z in (low, high) if z > 0.15
    ]
    middles = [y for y, z in (low, high) if z > 0.15]
    inward = 0.6 if high[0] >= low[0] else -0.6
    y_low, y_high = min([*middles, low[0]]) - 0.25, max([*middles, high[0] + inward]) + 0.1
    return posts, ((x0 - 0.03, y_low, 0.0), (x1 + 0.03, y_high, 0.08))
