"""Three axes that meet, each at right angles to the next (a wrist, a shoulder): their angles from their rotation.

axes = ThreeAxes(h)                         # directions at zero, (3, 3)
axes.angles(rotation, side)                 # (n, 3); side 0: the second angle is positive

Counted from where they are straight (axes 1 and 3 on one line) the second angle is `axes.bend(second)`. Straight, only
the sum of the first and the third angle is known (or their difference); `angles` puts the first one at zero then.
"""

from __future__ import annotations

import math

import numpy as np

from pn2code.robot.transforms import Array, rotation_about

STRAIGHT = 1e-12
"""Sine of the second angle: nearer to straight, nothing is known of the first."""


class ThreeAxes:
    """Of the directions of the axes at zero, (3, 3)."""

    def __init__(self, h: Array, straight: float = STRAIGHT) -> None:
        z, y, last = h
        x = np.cross(y, z)
        self._straight = straight
        self._basis = np.stack([x, y, z], axis=1)
        self.ahead = math.atan2(float(last @ x), float(last @ z))
        """rad: axis 3 is axis 1 turned about axis 2 by this."""
        self._turn = rotation_about(y, self.ahead)

    def bend(self, second: Array) -> Array:
        """The second angle, counted from where axes 1 and 3 look the same way."""
        return second + self.ahead

    def angles(self, rotation: Array, side: int) -> Array:
        """(n, 3); `side` 0: the second angle is positive."""
        m = self._basis.T @ (rotation @ self._turn) @ self._basis
        sign = 1.0 if side == 0 else -1.0
        sine = np.hypot(m[:, 0, 2], m[:, 1, 2])
        second = np.arctan2(sign * sine, m[:, 2, 2])
        first = np.arctan2(sign * m[:, 1, 2], sign * m[:, 0, 2])
        third = np.arctan2(sign * m[:, 2, 1], -sign * m[:, 2, 0])
        # Straight: only the sum is known, and the first axis stands at zero.
        is_straight = sine < self._straight
        first = np.where(is_straight, 0.0, first)
        third = np.where(is_straight, np.arctan2(m[:, 1, 0], m[:, 1, 1]), third)
        return np.stack([first, second - self.ahead, third], axis=1)
