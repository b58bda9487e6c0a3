"""Closed-form inverse of arms with seven axes: three that meet in the shoulder, an elbow, three that meet in the wrist.

form = derive(chain, T_flange_tcp)          # a text: why not
form.branches(T_base_tcp, arm_angle)        # (n, 8, 7)

With the tool standing, such an arm can still turn its elbow about the line from the shoulder to the wrist. Where it is
says the *arm angle*: between axis 4 and the direction across the vertical plane through that line, about the line. It
is 0 where axis 3 is at zero. On each branch (the signs of axes 2, 4 and 6) a pose and an arm angle have one answer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pn2code.robot.branches import SEVEN
from pn2code.robot.chain import Chain, cross
from pn2code.robot.closed_form import ClosedForm
from pn2code.robot.three_axes import ThreeAxes
from pn2code.robot.transforms import Array, Flags, inverse, rotation_about

AXES = 7
_MEET = 1e-6  # m: as far apart, axes still meet
_WEIGHT = 0.7  # m: of the arm angle beside the place of the TCP; it decides how tight bounds are, and nothing else
_KEPT = 0.8
_ABOVE = 1e-9  # m: so near to axis 1 the wrist has no direction from it


class SevenAxes(ClosedForm):
    """The inverse of one arm with one tool; `arm_angle` (rad) is meant where a pose comes without one."""

    known = SEVEN
    arm_angle: float

    def __init__(self, chain: Chain, T_flange_tcp: Array, arm_angle: float = 0.0) -> None:
        super().__init__(chain)
        self.arm_angle = arm_angle
        self._T_tcp_flange = inverse(T_flange_tcp)
        zero = [f[None] for f in chain.zero]
        self._h = np.stack([chain.axis(i, zero)[0] for i in range(AXES)])
        self._shoulder, self._wrist = _meeting(chain, self._h, 0), _meeting(chain, self._h, 4)
        p4, h4 = chain.zero[3, :3, 3], self._h[3]
        self._elbow = p4 + h4 * float((self._shoulder - p4) @ h4)
        self._upper = self._elbow - self._shoulder
        self._fore = self._wrist - self._elbow
        self._T_flange = chain.zero[AXES]
        self._wrist_in_flange = (inverse(self._T_flange) @ np.append(self._wrist, 1.0))[:3]
        self._wrist_in_5 = (inverse(chain.zero[4]) @ np.append(self._wrist, 1.0))[:3]
        self._first, self._last = ThreeAxes(self._h[:3]), ThreeAxes(self._h[4:])
        self.wrist_axes = 4, self._last
        # Axis 4, so directed that the arm angle is 0 where axis 3 is at zero.
        self._sign = 1.0 if float(h4 @ self._h[1]) > 0.0 else -1.0

    # Arm angle

    def angle_of(self, frames: Sequence[Array]) -> Array:
        """The arm angle of joint positions, in (-pi, pi]."""
        line, across = self._reference(self._wrist_at(frames) - self._shoulder)
        own = self._sign * self.chain.axis(3, frames)
        return np.asarray(np.arctan2((cross(across, own) * line).sum(1), (across * own).sum(1)))

    def _wrist_at(self, frames: Sequence[Array]) -> Array:
        return np.asarray(frames[4][:, :3, :3] @ self._wrist_in_5 + frames[4][:, :3, 3])

    def _reference(self, way: Array) -> tuple[Array, Array]:
        """The direction of the line from the shoulder to the wrist, and that across the plane through axis 1."""
        line = way / np.linalg.norm(way, axis=1, keepdims=True)
        across = cross(self._h[0], way)
        off = np.linalg.norm(across, axis=1)
        is_above = off < _ABOVE  # any direction would do there: that of axis 2 at zero
        across[is_above] = self._h[1]
        off[is_above] = 1.0
        return line, across / off[:, None]

    # Inverse

    def branches(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        """Joint positions (n, 8, 7) by branch, axes in (-pi, pi]."""
        flange = T_base_tcp @ self._T_tcp_flange
        count = len(flange)
        angle = np.full(count, self.arm_angle) if arm_angle is None else arm_angle
        way = flange[:, :3, :3] @ self._wrist_in_flange + flange[:, :3, 3] - self._shoulder
        out = np.full((count, len(SEVEN), AXES), np.nan)
        bends, is_there = self._bends((way**2).sum(1))
        is_there = is_there & ((way**2).sum(1) > _ABOVE**2)
        way = np.where(is_there[:, None], way, self._upper + self._fore)
        line, across = self._reference(way)
        own = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * cross(line, across)
        wanted = np.stack([line, own, cross(line, own)], axis=2)
        turn = flange[:, :3, :3] @ self._T_flange[:3, :3].T
        across_4 = self._sign * self._h[3]
        for elbow, bend in enumerate(bends):
            bent = rotation_about(self._h[3], bend)
            folded = self._upper + bent @ self._fore
            before = folded / np.linalg.norm(folded, axis=1, keepdims=True)
            side = np.broadcast_to(across_4, before.shape)
            has = np.stack([before, side, cross(before, side)], axis=2)
            shoulder = wanted @ has.transpose(0, 2, 1)
            hand = (shoulder @ bent).transpose(0, 2, 1) @ turn
            for first in (0, 1):
                for last in (0, 1):
                    rows = np.column_stack(
                        [
                            self._first.angles(shoulder, first),
                            bend,
                            self._last.angles(hand, last),
                        ]
                    )
                    rows = (rows + np.pi) % (2.0 * np.pi) - np.pi
                    out[is_there, 4 * last + 2 * first + elbow] = rows[is_there]
        return out

    def _bends(self, far: Array) -> tuple[tuple[Array, Array], Flags]:
        """Both positions of axis 4 for distances from shoulder to wrist (squared), plus first; and which can be."""
        h4 = self._h[3]
        along = float((self._fore @ h4) * (self._upper @ h4))
        u, v = self._upper - h4 * (self._upper @ h4), self._fore - h4 * (self._fore @ h4)
        a, b = float(u @ v), float(u @ np.cross(h4, v))
        need = (far - self._upper @ self._upper - self._fore @ self._fore) / 2.0 - along
        size = math.hypot(a, b)
        cosine = need / size
        is_there = np.abs(cosine) <= 1.0 + 1e-12
        half, middle = np.arccos(np.clip(cosine, -1.0, 1.0)), math.atan2(b, a)
        return (middle + half, middle - half), is_there

    # Lines

    def square(self, jacobian: Array, frames: Sequence[Array]) -> Array:
        """The Jacobian, and how the arm angle changes: a seventh row."""
        row = np.zeros((len(jacobian), 1, AXES))
        way, line, off = self._geometry(frames)
        h = self.chain.all_axes(frames)
        axis, bent = self._h[0], self._bent(frames)
        # d angle = line . (how link 3 turns) - (line . axis 1) d(azimuth of the wrist)
        around = cross(axis, way)
        lean = (line @ axis) / off**2
        for i in range(4):
            arm = way if i < 3 else bent
            shift = (around * cross(h[:, i], arm)).sum(1)
            own = (line * h[:, i]).sum(1) if i < 3 else 0.0
            row[:, 0, i] = _WEIGHT * (own - lean * shift)
        return np.concatenate([jacobian, row], axis=1)

    def wanted(self, twist: Array, swivel: float | Array = 0.0) -> Array:
        """A twist, and the turn of the arm angle."""
        more = np.broadcast_to(_WEIGHT * np.asarray(swivel), twist.shape[:-1])[..., None]
        return np.concatenate([twist, more], axis=-1)

    def steep(self, frames: Sequence[Array]) -> tuple[Array, Array]:
        """How fast the seventh row changes, as long as the wrist comes no nearer than 0.8 to shoulder and axis 1.

        With w the distance of the wrist from the shoulder, r that from axis 1, c = line . axis, and D the larger one of
        w and the forearm: each entry is line . h - c (axis x way) . d(way) / r^2. All first and second derivatives of
        the way are at most D, so |d(line)| and |dc| are at most D / w. It depends on axes 2, 3 and 4 only.
        """
        way, line, off = self._geometry(frames)
        here = np.linalg.norm(way, axis=1)
        near = np.minimum(here, off)
        longest = np.maximum(here + (1.0 - _KEPT) * near, float(np.linalg.norm(self._fore)))
        far = (1.0 - _KEPT) * near / (math.sqrt(3.0) * longest)
        w, side = longest / (_KEPT * np.maximum(here, _ABOVE)), longest / (_KEPT * off)
        lean = np.minimum(1.0, np.abs(line @ self._h[0]) + math.sqrt(3.0) * w * far)
        entry = w + 1.0 + w * side + lean * (3.0 * side**2 + side)
        return 3.0 * _WEIGHT * entry, far

    def _geometry(self, frames: Sequence[Array]) -> tuple[Array, Array, Array]:
        """From shoulder to wrist; its direction; how far the wrist is from axis 1."""
        way = self._wrist_at(frames) - self._shoulder
        line = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), _ABOVE)
        off = np.linalg.norm(cross(self._h[0], way), axis=1)
        return way, line, np.maximum(off, _ABOVE)

    def _bent(self, frames: Sequence[Array]) -> Array:
        """From the elbow to the wrist."""
        return np.asarray(self._wrist_at(frames) - frames[3][:, :3, 3])

    # Conditioning

    def elbow(self, frames: Sequence[Array]) -> Array:
        """Between the upper arm and the forearm, from straight."""
        start = frames[3][:, :3, 3] - self._shoulder
        end = self._bent(frames)
        return np.asarray(
            np.arctan2(np.linalg.norm(cross(start, end), axis=1), (start * end).sum(1))
        )

    def wrist(self, frames: Sequence[Array]) -> Array:
        """Between the lines of axes 5 and 7."""
        a, b = self.chain.axis(4, frames), self.chain.axis(6, frames)
        sine = np.linalg.norm(cross(a, b), axis=1)
        return np.asarray(np.arctan2(sine, np.abs((a * b).sum(1))))


def derive(chain: Chain, T_flange_tcp: Array) -> SevenAxes | str:
    """The inverse of an arm with seven axes, or in words why it has none here."""
    if chain.count != AXES or chain.slides.any():
        return "it does not have seven axes that turn"
    zero = [f[None] for f in chain.zero]
    h = np.stack([chain.axis(i, zero)[0] for i in range(AXES)])
    if np.linalg.norm(np.cross(h[0], (0.0, 0.0, 1.0))) > 1e-9:
        return "axis 1 is not along the base's z"
    for i in (0, 1, 4, 5):
        if abs(float(h[i] @ h[i + 1])) > 1e-9:
            return f"axes {i + 1} and {i + 2} are not at right angles"
    for first, name in ((0, "shoulder"), (4, "wrist")):
        centre = _meeting(chain, h, first)
        for i in range(first, first + 3):
            away = np.linalg.norm(np.cross(h[i], centre - chain.zero[i, :3, 3]))
            if away > _MEET:
                return (
                    f"axes {first + 1}, {first + 2} and {first + 3} do not meet in one point, the {name} "
                    f"(axis {i + 1} is {away:.3g} m off)"
                )
    if np.linalg.norm(np.cross(h[1], h[3])) > 1e-9:
        return "axes 2 and 4 are not parallel at zero"
    shoulder, wrist = _meeting(chain, h, 0), _meeting(chain, h, 4)
    if abs(float((wrist - shoulder) @ h[3])) > _MEET:
        return "shoulder, elbow and wrist are not in one plane at right angles to axis 4"
    for centre, name in ((shoulder, "shoulder"), (wrist, "wrist")):
        if np.linalg.norm(np.cross(h[3], centre - chain.zero[3, :3, 3])) < _MEET:
            return f"axis 4 runs through the {name}"
    return SevenAxes(chain, T_flange_tcp)


def _meeting(chain: Chain, h: Array, first: int) -> Array:
    """At zero, the point that is nearest to the lines of three axes."""
    whole, right = np.zeros((3, 3)), np.zeros(3)
    for i in range(first, first + 3):
        off = np.eye(3) - np.outer(h[i], h[i])
        whole += off
        right += off @ chain.zero[i, :3, 3]
    return np.asarray(np.linalg.lstsq(whole, right, rcond=None)[0])
