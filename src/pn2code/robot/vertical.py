"""Arms whose tool can only turn about the vertical.

These are SCARA (three axes turn, one slides) and gantries (three slide, one turns).

form = derive(chain, T_flange_tcp)          # a text: why not
form.branches(T_base_tcp)                   # (n, 2, 4), of a gantry (n, 1, 4)

The axes that turn are along the base's z, in any order among those that slide. A pose whose tool is tilted against what
the mounting of the tool makes possible cannot be had, and `refused` says so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pn2code.robot.branches import GANTRY, SCARA
from pn2code.robot.chain import Chain
from pn2code.robot.closed_form import ClosedForm
from pn2code.robot.transforms import Array, inverse

AXES = 4
_TASK = [0, 1, 2, 5]
"""Of a twist: the place, and the turn about the vertical."""
_TILT = 1e-9  # rad: the tool is not turned but about the vertical
_UPRIGHT = np.array([0.0, 0.0, 1.0])


class Vertical(ClosedForm):
    """What both kinds have in common."""

    def __init__(self, chain: Chain, T_flange_tcp: Array) -> None:
        super().__init__(chain)
        self._T_tcp_flange = inverse(T_flange_tcp)
        zero = [f[None] for f in chain.zero]
        self._signs = np.array([float(np.sign(chain.axis(i, zero)[0][2])) for i in range(AXES)])
        self._R_flange = chain.zero[AXES][:3, :3]

    def _flanges(self, T_base_tcp: Array) -> tuple[Array, Array, Array]:
        """Of poses: the places of the flange, its turn about the vertical, and the tilt that is left (rad)."""
        flange = T_base_tcp @ self._T_tcp_flange
        turn = flange[:, :3, :3] @ self._R_flange.T
        yaw = np.arctan2(turn[:, 1, 0] - turn[:, 0, 1], turn[:, 0, 0] + turn[:, 1, 1])
        tilt = np.arctan2(np.hypot(turn[:, 0, 2], turn[:, 1, 2]), turn[:, 2, 2])
        return flange[:, :3, 3], yaw, tilt

    def refused(self, T_base_tcp: Array) -> str:
        """Why the pose cannot be had: its tool is tilted."""
        tilt = float(self._flanges(T_base_tcp[None])[2][0])
        if tilt <= _TILT:
            return ""
        return (
            f"the pose cannot be had: it tilts the tool by {math.degrees(tilt):.4g} deg, but this arm can only turn "
            "it about the vertical"
        )

    def square(self, jacobian: Array, frames: Sequence[Array]) -> Array:
        """The rows of the place and of the turn about the vertical."""
        return jacobian[:, _TASK]

    def wanted(self, twist: Array, swivel: float | Array = 0.0) -> Array:
        """The same of a twist."""
        return twist[..., _TASK]

    def wrist(self, frames: Sequence[Array]) -> Array:
        """There is none that could be straight."""
        return np.full(len(frames[0]), math.pi / 2.0)


class Scara(Vertical):
    """Three axes turn and one slides, all vertical."""

    known = SCARA
    bends = ("elbow",)

    def __init__(self, chain: Chain, T_flange_tcp: Array) -> None:
        super().__init__(chain, T_flange_tcp)
        self._slide = int(np.flatnonzero(chain.slides)[0])
        self._turning = [i for i in range(AXES) if i != self._slide]
        places = chain.zero[:, :2, 3]
        # What slides vertically moves nothing in the plane, so places at zero are enough.
        a, b, c = (places[i] for i in self._turning)
        self._first = a
        self._upper, self._fore, self._hand = b - a, c - b, places[AXES] - c
        self._height = float(chain.zero[AXES][2, 3])

    def branches(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        """Joint positions (n, 2, 4), axes that turn in (-pi, pi]."""
        places, yaw, tilt = self._flanges(T_base_tcp)
        out = np.full((len(places), len(SCARA), AXES), np.nan)
        last = places[:, :2] - _turned(self._hand, yaw) - self._first
        upper, fore = float(np.hypot(*self._upper)), float(np.hypot(*self._fore))
        far = (last**2).sum(1)
        cosine = (far - upper**2 - fore**2) / (2.0 * upper * fore)
        is_there = (np.abs(cosine) <= 1.0 + 1e-12) & (tilt <= _TILT)
        bend = np.arccos(np.clip(cosine, -1.0, 1.0))
        straight = _angle(self._fore) - _angle(self._upper)
        for i, sign in enumerate((1.0, -1.0)):
            second = sign * bend
            ahead = np.arctan2(last[:, 1], last[:, 0])
            lean = np.arctan2(fore * np.sin(second), upper + fore * np.cos(second))
            first = ahead - lean - _angle(self._upper)
            second = second - straight
            third = yaw - first - second
            turns = np.stack([first, second, third], axis=1) * self._signs[self._turning]
            own = np.empty((len(places), AXES))
            own[:, self._turning] = (turns + np.pi) % (2.0 * np.pi) - np.pi
            own[:, self._slide] = (places[:, 2] - self._height) * self._signs[self._slide]
            out[is_there, i] = own[is_there]
        return out

    def elbow(self, frames: Sequence[Array]) -> Array:
        """How far the second link is from the direction of the first."""
        a, b, c = (frames[i][:, :2, 3] for i in self._turning)
        u, v = b - a, c - b
        return np.asarray(np.abs(np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(1))))


class Gantry(Vertical):
    """Three axes slide, one turns about the vertical."""

    known = GANTRY
    bends = ()

    def __init__(self, chain: Chain, T_flange_tcp: Array) -> None:
        super().__init__(chain, T_flange_tcp)
        self._turn = int(np.flatnonzero(~chain.slides)[0])
        self._slides = [i for i in range(AXES) if i != self._turn]

    def branches(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        """Joint positions (n, 1, 4): the turn first, then a linear system."""
        places, yaw, tilt = self._flanges(T_base_tcp)
        q = np.zeros((len(places), AXES))
        q[:, self._turn] = (yaw * self._signs[self._turn] + np.pi) % (2.0 * np.pi) - np.pi
        frames = self.chain.frames(q)
        ways = self.chain.all_axes(frames)[:, self._slides].transpose(0, 2, 1)
        left = places - frames[-1][:, :3, 3]
        q[:, self._slides] = np.linalg.solve(ways, left[..., None])[..., 0]
        q[tilt > _TILT] = np.nan
        return q[:, None]

    def elbow(self, frames: Sequence[Array]) -> Array:
        """There is none that could be straight."""
        return np.full(len(frames[0]), math.pi / 2.0)


def derive(chain: Chain, T_flange_tcp: Array) -> Vertical | str:
    """The inverse of a SCARA or a gantry, or in words why it is neither."""
    if chain.count != AXES:
        return f"it has {chain.count} axes, not four"
    zero = [f[None] for f in chain.zero]
    h = [chain.axis(i, zero)[0] for i in range(AXES)]
    turning = [i for i in range(AXES) if not chain.slides[i]]
    tilted = [i for i in turning if np.linalg.norm(np.cross(h[i], _UPRIGHT)) > 1e-9]
    if tilted:
        return f"axis {tilted[0] + 1} turns, and is not along the base's z"
    sliding = [i for i in range(AXES) if chain.slides[i]]
    if len(turning) == 1:
        if abs(float(np.linalg.det(np.stack([h[i] for i in sliding])))) < 1e-6:
            return "its three sliding axes are in one plane"
        return Gantry(chain, T_flange_tcp)
    if len(turning) != 3:
        return f"{len(turning)} of its axes turn and {len(sliding)} slide"
    if np.linalg.norm(np.cross(h[sliding[0]], _UPRIGHT)) > 1e-9:
        return f"axis {sliding[0] + 1} slides, and is not along the base's z"
    places = chain.zero[:, :2, 3]
    for i, j in zip(turning, turning[1:], strict=False):
        if np.linalg.norm(places[j] - places[i]) < 1e-6:
            return f"axes {i + 1} and {j + 1} turn about one line"
    return Scara(chain, T_flange_tcp)


def _angle(v: Array) -> float:
    return math.atan2(float(v[1]), float(v[0]))


def _turned(v: Array, angles: Array) -> Array:
    """A vector of the plane turned by each angle, (n, 2)."""
    c, s = np.cos(angles), np.sin(angles)
    return np.stack([c * v[0] - s * v[1], s * v[0] + c * v[1]], axis=1)
