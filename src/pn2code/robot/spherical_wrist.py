"""The closed-form inverse of arms with parallel axes 2 and 3 and a spherical wrist: that of `opw`, and straight wrists.

form = SphericalWrist(chain, model, correction, T_flange_tcp)
form.branches(T_base_tcp)                   # (n, 8, 6)

Where axes 4 and 6 are on one line, the library's arc cosine is of a number that rounding puts above one: it has no
answer, or one with an axis 5 that is 1e-8 off, and an axis 4 that rounding has chosen. Axes 1 to 3 only depend on where
the wrist is. So they are taken from the same place of the wrist with the tool turned away from straight, and axes 4 to
6 follow from what is left to turn. Straight to `_STRAIGHT`, axis 4 stands at zero and axis 6 does the rest.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pn2code.robot.branches import BRANCHES
from pn2code.robot.chain import Chain
from pn2code.robot.closed_form import ClosedForm
from pn2code.robot.opw import Robot
from pn2code.robot.three_axes import ThreeAxes
from pn2code.robot.transforms import Array, Flags, inverse, rotation_about

_STRAIGHT = 1e-10  # sine of axis 5: what rounding makes of zero
_NEAR = 1e-6  # sine of axis 5: nearer to straight, the library loses digits
_AWAY = rotation_about((1.0, 0.0, 0.0), 0.5)
_SLACK = 1e-9  # m: where the arm is stretched, rounding decides
_GENERAL = np.array([[0.1, 0.3, -0.7, 1.1, 0.5, -0.2]])


class SphericalWrist(ClosedForm):
    """The inverse of one arm with one tool."""

    def __init__(self, chain: Chain, model: Any, correction: Array, T_flange_tcp: Array) -> None:
        super().__init__(chain)
        self._robot, self._model = Robot(model), model
        self._T_tcp_flange = inverse(T_flange_tcp)
        # The library's flange may be turned against the URDF's by a constant rotation.
        self._T_tcp_library = inverse(correction @ T_flange_tcp)
        zero = [f[None] for f in chain.zero]
        wrist = ThreeAxes(np.stack([chain.axis(i, zero)[0] for i in (3, 4, 5)]), _STRAIGHT)
        self.wrist_axes = 3, wrist
        self._wrist = wrist
        self._sides = self._signs(T_flange_tcp)

    def branches(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        """Of n poses (n, 4, 4): (n, 8, 6)."""
        library = T_base_tcp @ self._T_tcp_library
        out = self._robot.branches(library)
        bent = np.abs(np.sin(self._wrist.bend(out[..., 4])))
        missing = np.isnan(bent)
        if missing.any():
            missing &= self._in_reach(library)
        is_straight = missing | (np.nan_to_num(bent, nan=1.0) < _NEAR)
        if is_straight.any():
            self._straighten(out, is_straight, library, T_base_tcp)
        return out

    def _signs(self, T_flange_tcp: Array) -> list[int]:
        """Of each branch, which sign the bend of its wrist has, as `ThreeAxes.angles` counts: 0 or 1."""
        pose = self.chain.frames(_GENERAL)[-1] @ T_flange_tcp
        bend = np.sin(self._wrist.bend(self._robot.branches(pose @ self._T_tcp_library)[0, :, 4]))
        first = 0 if np.nansum(bend[:4]) > 0.0 else 1
        return [first if i < 4 else 1 - first for i in range(len(BRANCHES))]

    def _centre(self, library: Array) -> Array:
        """Where axes 4, 5 and 6 meet, (n, 3)."""
        return np.asarray(library[:, :3, 3] - self._model.c4 * library[:, :3, 2])

    def _in_reach(self, library: Array) -> Flags:
        """On which branches the place of the wrist is in reach, whatever its turn: (n, 8)."""
        m, centre = self._model, self._centre(library)
        fore = float(np.hypot(m.a2, m.c3))
        ahead = (centre[:, :2] ** 2).sum(1) - m.b**2
        side = np.sqrt(np.maximum(ahead, 0.0))
        up = centre[:, 2] - m.c1
        out = np.empty((len(library), len(BRANCHES)), bool)
        for i, branch in enumerate(BRANCHES):
            far = np.hypot(side + (m.a1 if branch.shoulder == "back" else -m.a1), up)
            out[:, i] = (far <= m.c2 + fore + _SLACK) & (far >= abs(m.c2 - fore) - _SLACK)
        return np.asarray(out & (ahead >= -_SLACK)[:, None])

    def _straighten(self, out: Array, which: Flags, library: Array, T_base_tcp: Array) -> None:
        """Work these rows out anew."""
        poses = np.flatnonzero(which.any(axis=1))
        turned = library[poses].copy()
        turned[:, :3, :3] = turned[:, :3, :3] @ _AWAY
        turned[:, :3, 3] = self._centre(library[poses]) + self._model.c4 * turned[:, :3, 2]
        arms = self._robot.branches(turned)
        flange = (T_base_tcp[poses] @ self._T_tcp_flange)[:, :3, :3]
        zero = self.chain.zero
        turn = flange @ zero[6, :3, :3].T
        for i, side in enumerate(self._sides):
            rows = np.flatnonzero(which[poses, i] & ~np.isnan(arms[:, i, 0]))
            if not len(rows):
                continue
            q = np.zeros((len(rows), 6))
            q[:, :3] = arms[rows, i, :3]
            arm = self.chain.frames(q)[2][:, :3, :3] @ zero[2, :3, :3].T
            q[:, 3:] = self._wrist.angles(arm.transpose(0, 2, 1) @ turn[rows], side)
            out[poses[rows], i] = (q + np.pi) % (2.0 * np.pi) - np.pi
