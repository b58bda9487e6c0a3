"""Closed-form inverse of arms whose axes 2, 3 and 4 are parallel, as collaborative robots have them.

    form = derive(chain, T_flange_tcp)          # a text: why not
    form.branches(T_base_tcp)                   # (n, 8, 6)

`eaik` (https://github.com/OstermD/EAIK) decomposes the arm and gives all solutions of a pose, in no order. Which of the
eight branches each is follows from its own position: whether the wrist is in front of the column or behind it, on
which side of the line from axis 2 to the wrist the elbow is, and to which side the last axis is turned. So a path stays
on one branch, as with arms that have a spherical wrist.
"""

from __future__ import annotations

import importlib.util
import itertools
from typing import Any

import numpy as np

from pn2code.robot.chain import Chain, cross
from pn2code.robot.closed_form import ClosedForm
from pn2code.robot.model import AXES
from pn2code.robot.transforms import Array, inverse

MISSING = (
    "its axes 2, 3 and 4 are parallel, and the solver for such arms is not installed: "
    "`pip install 'pn2code[arms]'` brings it"
)
_BRANCHES = 8
_TESTED = 24
_MEET = 1e-6  # m: as far apart, two axes still meet


class ParallelAxes(ClosedForm):
    """The inverse of one arm with one tool; `solver` is the robot of `eaik`."""

    def __init__(self, chain: Chain, solver: Any, T_flange_tcp: Array) -> None:
        super().__init__(chain)
        self._solver = solver
        self._T_tcp_flange = inverse(T_flange_tcp)
        end = chain.zero[6]
        self._turn = end[:3, :3]
        self._wrist_in_5 = _in_frame(chain, 4, _meeting(chain, 4, 5))
        self._knee_in_4 = _in_frame(chain, 3, _meeting(chain, 3, 4))

    def branches(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        """Joint positions (n, 8, 6) by branch, axes in (-pi, pi]; NaN where a branch does not exist."""
        poses = T_base_tcp @ self._T_tcp_flange
        targets = poses.copy()
        targets[:, :3, :3] = poses[:, :3, :3] @ self._turn.T
        answers = [self._solver.calculate_IK(target) for target in targets]
        rows = [np.asarray(a.Q, float).reshape(-1, AXES) for a in answers]
        found = np.full((len(poses), _BRANCHES, AXES), np.nan)
        which = np.repeat(np.arange(len(poses)), [len(r) for r in rows])
        if len(which):
            # Exact answers last, so that they stand where an approximation was as well; what is no answer the
            # comparison with the forward kinematics drops (`Kinematics.all_branches`).
            is_exact = ~np.concatenate([np.asarray(a.is_LS, bool) for a in answers])
            order = np.lexsort((is_exact, which))
            q = np.concatenate(rows)[order]
            found[which[order], self.slots(q)] = q
        return np.asarray((found + np.pi) % (2.0 * np.pi) - np.pi)

    def slots(self, q: Array) -> Array:
        """The indices of the branches of joint positions (n, 6), as `kinematics.Branch` counts them."""
        chain = self.chain
        frames = chain.frames(q)
        h1, h2 = chain.axis(0, frames), chain.axis(1, frames)
        h4, h5, h6 = (chain.axis(i, frames) for i in (3, 4, 5))
        ahead = cross(h2, h1)
        wrist = frames[4][:, :3, :3] @ self._wrist_in_5 + frames[4][:, :3, 3]
        is_behind = ((wrist - frames[0][:, :3, 3]) * ahead).sum(1) < 0.0
        knee = frames[3][:, :3, :3] @ self._knee_in_4 + frames[3][:, :3, 3]
        upper = frames[2][:, :3, 3] - frames[1][:, :3, 3]
        bent = (cross(upper, knee - frames[2][:, :3, 3]) * h2).sum(1) < 0.0
        turned = (cross(h4, h6) * h5).sum(1) < 0.0
        return np.asarray(4 * turned + 2 * is_behind + (bent != is_behind))


def derive(chain: Chain, T_flange_tcp: Array) -> ParallelAxes | str:
    """The inverse of an arm with parallel axes 2, 3 and 4, or in words why it is none (or has none here)."""
    if not chain.is_six:
        return "it does not have six axes that turn"
    zero = [f[None] for f in chain.zero]
    h = [chain.axis(i, zero)[0] for i in range(AXES)]
    if max(np.linalg.norm(np.cross(h[1], h[i])) for i in (2, 3)) > 1e-9:
        return "axes 2, 3 and 4 are not parallel"
    if max(abs(float(h[i] @ h[j])) for i, j in ((0, 1), (3, 4), (4, 5))) > 1e-9:
        return "axes 1 and 2, 4 and 5, 5 and 6 are not at right angles"
    for i in (3, 4):
        if _gap(chain, i, i + 1) > _MEET:
            return f"axes {i + 1} and {i + 2} do not meet"
    if importlib.util.find_spec("eaik") is None:
        return MISSING
    from eaik.pybindings import EAIK

    points = chain.zero[:, :3, 3]
    steps = np.vstack([points[0], np.diff(points, axis=0)])
    solver = EAIK.Robot(np.stack(h).T, steps.T, np.eye(3), [], True)
    if not solver.has_known_decomposition():
        return "the solver knows no decomposition of it"
    form = ParallelAxes(chain, solver, T_flange_tcp)
    return form if _is_right(chain, form, T_flange_tcp) else "the solver's answers do not fit it"


def _is_right(chain: Chain, form: ParallelAxes, T_flange_tcp: Array) -> bool:
    """Whether some joint positions are found again, each on its own branch."""
    some = itertools.islice(
        itertools.permutations((0.4, 0.9, -1.3, 2.1, 1.1, -2.6)), 0, 720, 720 // _TESTED
    )
    q = np.array(list(some))
    found = form.branches(chain.frames(q)[-1] @ T_flange_tcp)
    own = found[np.arange(len(q)), form.slots(q)]
    away = np.abs((own - q + np.pi) % (2.0 * np.pi) - np.pi)
    return bool(away.max() < 1e-6)


def _closest(chain: Chain, i: int, j: int) -> tuple[Array, Array]:
    """At zero, the points of two axes that are nearest to each other."""
    zero = [f[None] for f in chain.zero]
    a, b = chain.axis(i, zero)[0], chain.axis(j, zero)[0]
    p, q = chain.zero[i, :3, 3], chain.zero[j, :3, 3]
    s, t = np.linalg.lstsq(np.stack([a, -b], axis=1), q - p, rcond=None)[0]
    return p + s * a, q + t * b


def _meeting(chain: Chain, i: int, j: int) -> Array:
    return _closest(chain, i, j)[0]


def _gap(chain: Chain, i: int, j: int) -> float:
    a, b = _closest(chain, i, j)
    return float(np.linalg.norm(a - b))


def _in_frame(chain: Chain, i: int, point: Array) -> Array:
    """A point at zero in the frame of axis i, in which it stands still."""
    return np.asarray((inverse(chain.zero[i]) @ np.append(point, 1.0))[:3])
