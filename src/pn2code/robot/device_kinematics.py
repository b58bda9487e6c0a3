"""Kinematics of a device: external axes beside each other, and no arm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from pn2code.robot.external import Externals
from pn2code.robot.kinematics import Conditioning, Kinematics
from pn2code.robot.model import Arm
from pn2code.robot.transforms import Array

_NONE = Conditioning(1.0, 1.0, 0.0, 0.0)
"""Nothing is singular where there is no arm."""


class DeviceKinematics(Kinematics):
    """Where the axes of a device are; its base is the world, and its TCP stands there."""

    def __init__(self, arm: Arm, axes: Externals) -> None:
        self.arm = arm
        self.axes = axes
        self.T_flange_tcp = np.eye(4)
        self.slides = np.zeros(0, bool)
        self._sliding = np.zeros(0, int)
        self.branches = ()
        self.alone = self
        self.joints = slice(0, 0)

    def link_frames(self, q: Array) -> list[Array]:
        """`T_base_axis` of each axis, after its own motion, and of the base, which is the flange."""
        out = [axis.at(q[:, i]) for i, axis in enumerate(self.axes.tables)]
        return [*out, self.forward_many(q)]

    def joint_frames(self, q: ArrayLike) -> Array:
        """The same of one joint position."""
        return np.stack([f[0] for f in self.link_frames(np.asarray(q, float)[None])])

    def axes_of(self, frames: Sequence[Array]) -> Array:
        """Directions of all axes in the base frame."""
        rows = [f[:, :3, :3] @ a.direction for f, a in zip(frames, self.axes.tables, strict=False)]
        return np.stack(rows, axis=1)

    def forward_many(self, q: Array) -> Array:
        """The base."""
        return np.repeat(np.eye(4)[None], len(q), axis=0)

    def conditioning_many(self, q: Array) -> list[Conditioning]:
        """Of nothing."""
        return [_NONE] * len(q)

    def states(self, q: Array) -> tuple[Array, list[Conditioning]]:
        """The base, and nothing."""
        return self.forward_many(q), self.conditioning_many(q)

    def arm_angle_of(self, q: ArrayLike) -> float | None:
        """There is none."""
        return None

    def limit_margin(self, q: ArrayLike) -> tuple[float, int]:
        """Of an axis that is outside; else inf."""
        margins = self.arm.margins(np.asarray(q, float))
        axis = int(np.argmin(margins))
        return (float(margins[axis]), axis) if margins[axis] < -1e-9 else (np.inf, axis)
