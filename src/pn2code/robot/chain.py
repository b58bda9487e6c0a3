"""The kinematic chain of an arm: frames of many joint positions at once, and what follows from the axes.

Axes turn or slide; how many there are the URDF says.

Also derives the parameters of the closed-form inverse from the URDF's axes (`derive`).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from pn2code.robot.model import AXES, Arm
from pn2code.robot.opw import KinematicModel, Robot
from pn2code.robot.transforms import Array, inverse, skew


def cross(a: Array, b: Array) -> Array:
    """Cross product of arrays (..., 3); numpy's own is ten times slower on short arrays."""
    x = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    out = np.empty((*x.shape, 3))
    out[..., 0] = x
    out[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    out[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return out


class Chain:
    """Forward kinematics of n joint positions (n, axes) at once; arrays of frames are (n, 4, 4).

    Attributes:
        count: how many axes there are; slides: which of them are no rotations.
        zero: `T_base_joint` of the axes and `T_base_flange` with all axes at zero.
    """

    def __init__(self, arm: Arm) -> None:
        before: list[Array] = []
        slides: list[bool] = []
        self.axes: list[Array] = []
        fixed = np.eye(4)
        for joint in arm.chain:
            fixed = fixed @ joint.T_parent_joint
            if joint.type != "fixed":
                before.append(fixed)
                slides.append(joint.type == "prismatic")
                self.axes.append(np.array(joint.axis))
                fixed = np.eye(4)
        self.before = np.stack(before)
        self.count = len(before)
        self.slides = np.array(slides)
        self.end = fixed
        self._sliding = np.flatnonzero(self.slides)
        self._k = np.stack([skew(a) for a in self.axes])
        self._kk = self._k @ self._k
        self.zero = np.stack([f[0] for f in self.frames(np.zeros((1, self.count)))])
        self.is_six = self.count == AXES and not slides.count(True)
        if self.is_six:
            self.p2, self.p3, self.wrist_centre = self._points()
            self._centre_in_4 = (np.linalg.inv(self.zero[3]) @ np.append(self.wrist_centre, 1.0))[
                :3
            ]

    def frames(self, q: Array) -> list[Array]:
        """`T_base_joint` of all axes (after their own motion) and `T_base_flange`."""
        # Rodrigues: R = I + sin K + (1 - cos) K^2, all axes at once.
        turns = np.zeros((len(q), self.count, 4, 4))
        turns[:, :, 3, 3] = 1.0
        sine, versine = np.sin(q)[..., None, None], (1.0 - np.cos(q))[..., None, None]
        turns[:, :, :3, :3] = np.eye(3) + sine * self._k + versine * self._kk
        for i in self._sliding.tolist():
            turns[:, i, :3, :3] = np.eye(3)
            turns[:, i, :3, 3] = q[:, i, None] * self.axes[i]
        steps = self.before @ turns
        out = [steps[:, 0]]
        for i in range(1, self.count):
            out.append(out[-1] @ steps[:, i])
        out.append(out[-1] @ self.end)
        return out

    def axis(self, i: int, frames: Sequence[Array]) -> Array:
        """Direction of axis i (from 0) in the base frame, (n, 3)."""
        return np.asarray(frames[i][:, :3, :3] @ self.axes[i])

    def all_axes(self, frames: Sequence[Array]) -> Array:
        """Directions of all axes in the base frame, (n, axes, 3)."""
        return np.stack([frames[i][:, :3, :3] @ self.axes[i] for i in range(self.count)], axis=1)

    def _points(self) -> tuple[Array, Array, Array]:
        """At zero: points on axes 2 and 3, and where axes 4 and 5 meet (least squares)."""
        zero = [f[None] for f in self.zero]
        p4, p5 = self.zero[3, :3, 3], self.zero[4, :3, 3]
        h4, h5 = self.axis(3, zero)[0], self.axis(4, zero)[0]
        st = np.linalg.lstsq(np.stack([h4, -h5], axis=1), p5 - p4, rcond=None)[0]
        return self.zero[1, :3, 3], self.zero[2, :3, 3], p4 + st[0] * h4

    def elbow(self, frames: Sequence[Array]) -> Array:
        """Angle between the upper arm and the line from axis 3 to the wrist centre, in [0, pi]."""
        axis = self.axis(1, frames)
        # The wrist centre is on axis 4, so it stands still in frame 4.
        centre = frames[3][:, :3, :3] @ self._centre_in_4 + frames[3][:, :3, 3]
        u = frames[2][:, :3, 3] - frames[1][:, :3, 3]
        v = centre - frames[2][:, :3, 3]
        u = u - (u * axis).sum(1, keepdims=True) * axis
        v = v - (v * axis).sum(1, keepdims=True) * axis
        return np.asarray(np.abs(np.arctan2((cross(u, v) * axis).sum(1), (u * v).sum(1))))

    def wrist(self, frames: Sequence[Array]) -> Array:
        """Angle between the lines of axes 4 and 6, in [0, pi/2]."""
        a, b = self.axis(3, frames), self.axis(5, frames)
        sine = np.sqrt((cross(a, b) ** 2).sum(1))
        return np.asarray(np.arctan2(sine, np.abs((a * b).sum(1))))


def derive(chain: Chain) -> tuple[Any, Array] | str:
    """For `py-opw-kinematics`: the parameters of its model and the constant turn of its flange, or what is wrong.

    The library's zero: upper arm and forearm upright, axes 1, 4, 6 along z, axes 2, 3, 5 along y;
    theta = (+-q) - offset. Angles of the URDF's zero against that give the offsets. The result is
    then compared with the URDF's forward kinematics, so a mistake here cannot go unnoticed.
    """
    if not chain.is_six:
        return "it does not have six axes that turn"
    zero = [f[None] for f in chain.zero]
    h = [chain.axis(i, zero)[0] for i in range(AXES)]
    tool = chain.zero[6]
    x, y, z = np.eye(3)
    if np.linalg.norm(np.cross(h[0], z)) > 1e-9:
        return "axis 1 is not the z axis of its base"
    if np.hypot(*chain.zero[0, :2, 3]) > 1e-9:
        return "axis 1 does not run through the origin of its base"
    if np.linalg.norm(np.cross(h[1], h[2])) > 1e-9:
        return "axes 2 and 3 are not parallel"
    if abs(float(h[1] @ h[0])) > 1e-9:
        return "axes 1 and 2 are not at right angles"
    if np.linalg.norm(np.cross(h[1], y)) > 1e-9:
        return "axis 2 is not along the base's y at zero"
    centre = chain.wrist_centre
    for i in (3, 4, 5):
        away = np.linalg.norm(np.cross(h[i], centre - chain.zero[i, :3, 3]))
        if away > 1e-9:
            return f"axes 4, 5 and 6 do not meet in one point (axis {i + 1} is {away:.3g} m off)"

    def upright(v: Array) -> float:
        """Angle of a direction in the arm's plane from z, about y."""
        return math.atan2(float(v @ x), float(v @ z))

    upper = chain.p3 - chain.p2
    # The forearm's direction is that of axis 4 that looks from the elbow to the wrist.
    forearm = h[3] if float(h[3] @ (centre - chain.p3)) > 0.0 else -h[3]
    out = h[5] if float(h[5] @ (tool[:3, 3] - centre)) > 0.0 else -h[5]
    if abs(float(forearm @ y)) > 1e-9:
        return "the forearm is not in the plane of the upper arm at zero"
    along = float(forearm @ (centre - chain.p3))
    # Perpendicular to the forearm in the arm's plane; at the library's zero this is the x axis.
    side = np.cross(y, forearm)
    phi2 = upright(upper)
    phi3 = upright(forearm) - phi2
    sign5 = float(h[4] @ y)
    if abs(abs(sign5) - 1.0) > 1e-9:
        return "axis 5 is not parallel to axis 2 at zero"
    phi5 = upright(out) - upright(forearm)
    model = KinematicModel(
        a1=float(chain.p2 @ x),
        a2=float((centre - chain.p3) @ side),
        b=float(centre @ y),
        c1=float(chain.p2 @ z),
        c2=float(np.hypot(upper @ x, upper @ z)),
        c3=along,
        c4=float((tool[:3, 3] - centre) @ out),
        offsets=(0.0, -phi2, -phi3, 0.0, -phi5, 0.0),
        flip_axes=(
            float(h[0] @ z) < 0.0,
            float(h[1] @ y) < 0.0,
            float(h[2] @ y) < 0.0,
            float(h[3] @ forearm) < 0.0,
            sign5 < 0.0,
            float(h[5] @ out) < 0.0,
        ),
    )
    robot = Robot(model)
    correction: Array | None = None
    # A few joint positions in general position; equality there is equality everywhere.
    for q in itertools.islice(itertools.permutations((0.0, 0.3, -0.7, 1.1, 0.5, -0.2)), 0, 720, 90):
        theirs = robot.forward(q)
        turn = inverse(theirs) @ chain.frames(np.array([q]))[-1][0]
        if correction is None:
            correction = turn
        if np.abs(turn - correction).max() > 1e-9 or np.abs(turn[:3, 3]).max() > 1e-9:
            return "its axes do not fit the model of an arm with a spherical wrist"
    assert correction is not None
    return model, correction
