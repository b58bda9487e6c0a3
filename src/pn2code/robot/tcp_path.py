"""Paths of the TCP in space, without time: straight, and through three places on a circle."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.transforms import Array, pose_of, rotation_about, rotation_vector

_SAME = 1e-12
# m: places that are nearer to each other are one; of a chord's length: so flat, an arc is a line.
_NEAR = 1e-6
_FLAT = 1e-5


class TcpPath(Protocol):
    """A way of the TCP, by the fraction s of it.

    Attributes:
        start: where it begins; length: m; angle: rad, how far the tool turns; axis: about which, in its own frame.
            For one unit of s neither place nor orientation goes faster anywhere.
        bend: a bound on how fast the twist of the TCP for one unit of s changes, but for what turns with the tool, m.
        name: for messages.
    """

    start: Array
    length: float
    angle: float
    axis: Array
    bend: float
    name: str

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way."""

    def shifts(self, s: Array) -> Array:
        """Velocity of the TCP's place (m) for one unit of s, (n, 3)."""

    def spins(self, turns: Array, s: Array) -> Array:
        """How the tool turns (rad) for one unit of s, where its rotations are (n, 3, 3): (n, 3)."""


def turning(start: Array, target: Array) -> tuple[Array, float]:
    """Axis (in the start's frame, so that R(s) = R_start * Rot(axis, s * angle)) and angle from one pose to another."""
    turn = rotation_vector(start[:3, :3].T @ target[:3, :3])
    angle = float(np.linalg.norm(turn))
    return (turn / angle if angle > _SAME else np.array([0.0, 0.0, 1.0])), angle


def own_spins(axis: Array, angle: float, turns: Array) -> Array:
    """Of a tool that turns evenly about an axis in its own frame."""
    spin = axis * angle
    return np.asarray(turns @ spin)


class Line:
    """Straight from one pose to another, turning about one axis at constant ratio (slerp)."""

    bend = 0.0
    name = "line"

    def __init__(self, start: Array, target: Array) -> None:
        self.start, self.target = start, target
        self.shift = target[:3, 3] - start[:3, 3]
        self.length = float(np.linalg.norm(self.shift))
        self.axis, self.angle = turning(start, target)

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way."""
        out = np.repeat(self.start[None], len(s), axis=0)
        out[:, :3, 3] += s[:, None] * self.shift
        if self.angle > _SAME:
            out[:, :3, :3] = self.start[:3, :3] @ rotation_about(self.axis, s * self.angle)
        out[s >= 1.0] = self.target
        return out

    def shifts(self, s: Array) -> Array:
        """The same everywhere."""
        return np.broadcast_to(self.shift, (len(s), 3))

    def spins(self, turns: Array, s: Array) -> Array:
        """About its axis."""
        return own_spins(self.axis, self.angle, turns)


class Arc:
    """A piece of a circle through three places, from one pose to another, turning as a line does.

    Args:
        start: a pose; via: only its place matters; target: a pose.

    Raises:
        MotionFault: no circle, or every one, goes through the places.
    """

    name = "arc"

    def __init__(self, start: Array, via: Array, target: Array) -> None:
        self.start, self.target = start, target
        a, b, c = (pose[:3, 3] for pose in (start, via, target))
        chord = c - a
        long = float(np.linalg.norm(chord))
        if long < _NEAR:
            raise MotionFault(
                "bad-command",
                "a circular move ends where it begins, so that every circle through these places would do; make "
                "two moves of it",
                pose=pose_of(target),
            )
        off = (b - a) - chord * float((b - a) @ chord) / long**2
        bent = float(np.linalg.norm(off))
        if bent < max(_NEAR, _FLAT * long):
            raise MotionFault(
                "bad-command",
                f"the places of a circular move lie on a line (the one on the way is {1000.0 * bent:.4f} mm off it), "
                "so there is no circle through them; move on a line",
                pose=pose_of(via),
            )
        # In the plane with x along the chord and y towards the place on the way.
        x_axis, y_axis = chord / long, off / bent
        x = float((b - a) @ x_axis)
        centre_y = (x * x + bent * bent - x * long) / (2.0 * bent)
        self._centre = a + 0.5 * long * x_axis + centre_y * y_axis
        self.radius = math.hypot(0.5 * long, centre_y)
        self._u = (a - self._centre) / self.radius
        # The arc runs on the side of the chord on which the place on the way is: first along y, then down again.
        self._v = (0.5 * long * y_axis - centre_y * x_axis) / self.radius
        self.sweep = 2.0 * math.atan2(0.5 * long, -centre_y)
        self.length = self.radius * self.sweep
        self.axis, self.angle = turning(start, target)
        self.bend = self.length * self.sweep

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way."""
        out = np.repeat(self.start[None], len(s), axis=0)
        t = (s * self.sweep)[:, None]
        out[:, :3, 3] = self._centre + self.radius * (np.cos(t) * self._u + np.sin(t) * self._v)
        if self.angle > _SAME:
            out[:, :3, :3] = self.start[:3, :3] @ rotation_about(self.axis, s * self.angle)
        out[s >= 1.0] = self.target
        return out

    def shifts(self, s: Array) -> Array:
        """Along the tangents."""
        t = (s * self.sweep)[:, None]
        return np.asarray(self.length * (np.cos(t) * self._v - np.sin(t) * self._u))

    def spins(self, turns: Array, s: Array) -> Array:
        """About its axis."""
        return own_spins(self.axis, self.angle, turns)
