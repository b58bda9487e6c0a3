"""Kinematics of an arm with its tool: forward, closed-form inverse by branch, conditioning.

    k = Kinematics.of(arm, tool, origin, d)
    T_base_tcp = k.forward(q)
    for solution in k.inverse(T_base_tcp): solution.branch, solution.q
    k.conditioning(q).condition          # of the TCP Jacobian, lengths in m

The inverse is `py-opw-kinematics` (docs/adr/006): all eight branches of an arm with parallel axes 2
and 3 and a spherical wrist; for arms with parallel axes 2, 3 and 4 it is `eaik` (`parallel`). Their
parameters are derived from the URDF's axes and compared with the URDF's forward kinematics, which is
the truth here; answers are verified against it as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import codes, parallel
from pn2code.robot.chain import Chain, cross, derive
from pn2code.robot.model import AXES, Arm, Tool
from pn2code.robot.opw import Robot
from pn2code.robot.transforms import Array, inverse

TURN = 2.0 * math.pi
CHARACTERISTIC_LENGTH = 1.0  # m: lengths in the Jacobian are divided by it, so that it has no units
POSITION_TOLERANCE = 1e-11  # m and rad: an answer of the inverse further off is refined
ACCEPTED_ERROR = 1e-9  # m and rad: an answer further off after refinement is not an answer
_LIMIT_SLACK = 1e-9  # rad: a target exactly at a limit counts as inside


@dataclass(frozen=True, slots=True, order=True)
class Branch:
    """One of the eight ways to reach a pose.

    Args:
        index: 4 * wrist + 2 * shoulder + elbow.
    """

    index: int

    @property
    def shoulder(self) -> str:
        """`front`: the arm reaches forward over the column; `back`: over its shoulder."""
        return "back" if self.index & 2 else "front"

    @property
    def elbow(self) -> str:
        """`up` or `down`: on which side of the line from axis 2 to the wrist the elbow is."""
        return "down" if self.index & 1 else "up"

    @property
    def wrist(self) -> str:
        """The sign of axis 5, as `plus` or `minus`."""
        return "minus" if self.index & 4 else "plus"

    def __str__(self) -> str:
        return f"{self.shoulder}/{self.elbow}/{self.wrist}"


BRANCHES = tuple(Branch(i) for i in range(8))
BRANCH_NAMES = {str(b): b for b in BRANCHES}


@frozen(eq=False)
class Solution:
    """A joint position that reaches a pose, inside the limits, nearest to the reference's turns."""

    branch: Branch
    q: Array


@frozen
class Conditioning:
    """How far from a singularity.

    Args:
        condition: condition number of the TCP Jacobian with lengths in units of 1 m; inf when singular.
        sigma_min: its smallest singular value.
        elbow: angle of the elbow from straight, rad.
        wrist: angle between axes 4 and 6 from parallel, rad, in [0, pi/2].
    """

    condition: float
    sigma_min: float
    elbow: float
    wrist: float


MOST_CONDITION = 1e6
"""A larger condition number is rounding: the arm is in a singularity."""


def condition_text(condition: float, digits: int = 0) -> str:
    """For people; of an arm in a singularity it has no meaning how large the number is."""
    if condition > MOST_CONDITION:
        return f"above {MOST_CONDITION:,.0f}"
    return f"{condition:.{digits}f}"


class ClosedForm(Protocol):
    """All joint positions of poses, by branch."""

    def branches(self, T_base_tcp: Array) -> Array:
        """Of n poses (n, 4, 4): (n, 8, 6), NaN where a branch does not exist."""


class SphericalWrist:
    """The inverse of arms with parallel axes 2 and 3 and a spherical wrist."""

    def __init__(self, model: Any, correction: Array, T_flange_tcp: Array) -> None:
        self._robot = Robot(model)
        # The library's flange may be turned against the URDF's by a constant rotation.
        self._T_tcp_library = inverse(correction @ T_flange_tcp)

    def branches(self, T_base_tcp: Array) -> Array:
        """Of n poses (n, 4, 4): (n, 8, 6)."""
        return self._robot.branches(T_base_tcp @ self._T_tcp_library)


@lru_cache(maxsize=16)
def _chain(arm: Arm) -> tuple[Chain, tuple[Any, Array] | str]:
    """Worked out once for each arm, whatever tool it has."""
    chain = Chain(arm)
    return chain, derive(chain)


class Kinematics:
    """Kinematics of one arm with one tool; lengths in m, angles in rad; frames are base and tcp."""

    def __init__(self, arm: Arm, T_flange_tcp: Array, chain: Chain, form: ClosedForm) -> None:
        self.arm = arm
        self.T_flange_tcp = T_flange_tcp
        self._chain = chain
        self._form = form
        self.alone: Kinematics = self
        """Of the arm without its external axes, from its own base."""
        self.joints = slice(0, len(arm.lower))
        """Where the joints of the arm are in a joint position."""

    @classmethod
    def of(cls, arm: Arm, tool: Tool | None, at: Origin, d: Diagnostics) -> Kinematics | None:
        """The kinematics of an arm; None (and a diagnostic) if there is no closed form for it."""
        return cls.to(arm, np.eye(4) if tool is None else tool.T_flange_tcp, at, d)

    @classmethod
    def to(cls, arm: Arm, frame: Array, at: Origin, d: Diagnostics) -> Kinematics | None:
        """The same of a TCP that is given in the frame of the flange."""
        chain, derived = _chain(arm)
        if not isinstance(derived, str):
            return cls(arm, frame, chain, SphericalWrist(*derived, frame))
        form = parallel.derive(chain, frame)
        if not isinstance(form, str):
            return cls(arm, frame, chain, form)
        d.error(
            codes.UNSUPPORTED_KINEMATICS,
            f"robot model `{arm.name}` has no closed-form inverse kinematics: "
            + (form if form == parallel.MISSING else derived),
            at,
            notes=[] if form == parallel.MISSING else [f"nor as a collaborative robot: {form}"],
            hint=""
            if form == parallel.MISSING
            else "an arm needs axis 1 along the base's z, parallel axes 2 and 3, and a spherical wrist; or parallel "
            "axes 2, 3 and 4, and axes 5 and 6 at right angles to those before",
        )
        return None

    # Forward

    def forward(self, q: ArrayLike) -> Array:
        """`T_base_tcp`."""
        return np.asarray(self.forward_many(np.asarray(q, float)[None])[0])

    def forward_many(self, q: Array) -> Array:
        """`T_base_tcp` of n joint positions (n, 6): (n, 4, 4)."""
        return np.asarray(self._chain.frames(q)[-1] @ self.T_flange_tcp)

    def joint_frames(self, q: ArrayLike) -> Array:
        """`T_base_joint` of the six axes, after their own rotation, and of the flange: (7, 4, 4)."""
        return np.stack([f[0] for f in self._chain.frames(np.asarray(q, float)[None])])

    def link_frames(self, q: Array) -> list[Array]:
        """The same of n joint positions (n, 6): seven arrays (n, 4, 4)."""
        return self._chain.frames(q)

    def axes_of(self, frames: Sequence[Array]) -> Array:
        """Directions of the six axes in the base frame, (n, 6, 3)."""
        return self._chain.all_axes(frames)

    @property
    def T_axis_flange(self) -> Array:  # noqa: N802
        """The flange in the frame of the last axis."""
        return self._chain.end

    @property
    def longest(self) -> float:
        """m: the TCP is never further from any axis than all lengths between them together."""
        lengths = np.linalg.norm(self._chain.before[1:, :3, 3], axis=1).sum()
        return float(lengths + np.linalg.norm((self._chain.end @ self.T_flange_tcp)[:3, 3]))

    # Differential

    def jacobian(self, q: ArrayLike) -> Array:
        """The 6x6 Jacobian at the TCP in the base frame: rows 0-2 m/rad, rows 3-5 rad/rad."""
        return np.asarray(self.jacobian_many(np.asarray(q, float)[None])[0])

    def jacobian_many(self, q: Array) -> Array:
        """Jacobians of n joint positions (n, 6): (n, 6, 6)."""
        return self._jacobian(self._chain.frames(q))

    def _jacobian(self, frames: Sequence[Array]) -> Array:
        tcp = frames[-1][:, :3, :3] @ self.T_flange_tcp[:3, 3] + frames[-1][:, :3, 3]
        axes = self._chain.all_axes(frames)
        out = np.empty((len(tcp), 6, AXES))
        out[:, 3:] = axes.transpose(0, 2, 1)
        arms = tcp[:, None] - np.stack([f[:, :3, 3] for f in frames[:AXES]], axis=1)
        out[:, :3] = cross(axes, arms).transpose(0, 2, 1)
        return out

    def conditioning(self, q: ArrayLike) -> Conditioning:
        """Condition number, smallest singular value, elbow and wrist angle at a joint position."""
        return self.conditioning_many(np.asarray(q, float)[None])[0]

    def conditioning_many(self, q: Array) -> list[Conditioning]:
        """The same for n joint positions (n, 6)."""
        return self._conditioning(self._chain.frames(q))

    def states(self, q: Array) -> tuple[Array, list[Conditioning]]:
        """`T_base_tcp` (n, 4, 4) and the conditioning of n joint positions (n, 6); both come from the same frames."""
        frames = self._chain.frames(q)
        return np.asarray(frames[-1] @ self.T_flange_tcp), self._conditioning(frames)

    def _conditioning(self, frames: Sequence[Array]) -> list[Conditioning]:
        scaled = self._jacobian(frames)
        scaled[:, :3] /= CHARACTERISTIC_LENGTH
        sigma = np.linalg.svd(scaled, compute_uv=False)
        elbow, wrist = self._chain.elbow(frames), self._chain.wrist(frames)
        return [
            Conditioning(
                float(s[0] / s[-1]) if s[-1] > 0.0 else math.inf, float(s[-1]), float(e), float(w)
            )
            for s, e, w in zip(sigma, elbow, wrist, strict=True)
        ]

    # Inverse

    def all_branches(self, T_base_tcp: Array) -> Array:
        """Of n poses (n, 4, 4): joint positions (n, 8, 6) by branch index, axes in (-pi, pi].

        Where a branch does not exist the row is NaN. Limits are not looked at. Rows are exact: each
        was compared with the forward kinematics (and refined by Newton steps near singularities).
        """
        found = self._closed_form(T_base_tcp)
        self._refine(found.reshape(-1, AXES), np.repeat(T_base_tcp, len(BRANCHES), axis=0))
        return found

    def on_branch(self, T_base_tcp: Array, branch: Branch) -> Array:
        """The same on one branch only: (n, 6)."""
        found = np.ascontiguousarray(self._closed_form(T_base_tcp)[:, branch.index])
        self._refine(found, T_base_tcp)
        return found

    def _closed_form(self, T_base_tcp: Array) -> Array:
        return self._form.branches(T_base_tcp)

    def _refine(self, rows: Array, targets: Array) -> None:
        there = np.flatnonzero(~np.isnan(rows[:, 0]))
        for attempt in range(4):
            error = self._error(rows[there], targets[there])
            size = np.abs(error).max(axis=1, initial=0.0)
            if attempt == 3:
                rows[there[size > ACCEPTED_ERROR]] = np.nan
                return
            coarse = size > POSITION_TOLERANCE
            if not coarse.any():
                return
            there, error = there[coarse], error[coarse]
            # Truncated: along a singular direction there is nothing to gain, and a leap to lose.
            step = np.linalg.pinv(self.jacobian_many(rows[there]), rcond=1e-7) @ error[..., None]
            rows[there] += np.clip(step[..., 0], -1e-3, 1e-3)

    def _error(self, q: Array, targets: Array) -> Array:
        now = self.forward_many(q)
        turn = targets[:, :3, :3] @ np.transpose(now[:, :3, :3], (0, 2, 1))
        # First order is enough: errors that matter here are far below a milliradian.
        w = 0.5 * np.stack(
            [
                turn[:, 2, 1] - turn[:, 1, 2],
                turn[:, 0, 2] - turn[:, 2, 0],
                turn[:, 1, 0] - turn[:, 0, 1],
            ],
            axis=1,
        )
        return np.concatenate([targets[:, :3, 3] - now[:, :3, 3], w], axis=1)

    def inverse(self, T_base_tcp: Array, near: ArrayLike | None = None) -> tuple[Solution, ...]:
        """All branches that have a turn inside the limits; full turns are chosen nearest to `near`."""
        reference = np.zeros(AXES) if near is None else np.asarray(near, float)
        out = []
        for branch, row in zip(BRANCHES, self.all_branches(T_base_tcp[None])[0], strict=True):
            q = None if np.isnan(row[0]) else self.turn_near(row, reference)
            if q is not None:
                out.append(Solution(branch, q))
        return tuple(out)

    def turn_near(self, q: Array, reference: Array) -> Array | None:
        """The same position with full turns added: inside the limits, nearest to a reference."""
        lower, upper = self.arm.lower - _LIMIT_SLACK, self.arm.upper + _LIMIT_SLACK
        wish = np.round((reference - q) / TURN)
        least = np.ceil((lower - q) / TURN)
        most = np.floor((upper - q) / TURN)
        if (least > most).any():
            return None
        return np.asarray(q + TURN * np.clip(wish, least, most))

    def nearest(
        self, T_base_tcp: Array, reference: ArrayLike, branch: Branch | None = None
    ) -> Solution | None:
        """The branch for a joint move from `reference`: the one the robot reaches first.

        That is the least max over the axes of |dq| / (axis speed); equal within 1 ns, the least sum,
        then the lowest branch index. `branch` restricts the choice to one. None: not reachable.
        """
        start = np.asarray(reference, float)

        def cost(s: Solution) -> tuple[float, float, Branch]:
            times = np.abs(s.q - start) / self.arm.velocity
            return round(float(times.max()), 9), round(float(times.sum()), 9), s.branch

        found = [s for s in self.inverse(T_base_tcp, start) if branch in (None, s.branch)]
        return min(found, key=cost, default=None)

    def branch_of(self, q: ArrayLike) -> Branch:
        """The branch of a joint position: the one whose answer for its TCP pose is nearest to it."""
        q = np.asarray(q, float)
        rows = self.all_branches(self.forward(q)[None])[0]
        away = np.abs((rows - q + math.pi) % TURN - math.pi).max(axis=1)
        away[np.isnan(away)] = np.inf
        return BRANCHES[int(np.argmin(away))]

    def follow(self, T_base_tcp: Array, branch: Branch, start: ArrayLike) -> Array:
        """A path (n, 4, 4) on one branch, each position nearest in turns to the one before: (n, 6).

        Rows are NaN where the branch does not exist. Limits are not looked at.
        """
        rows = self.on_branch(T_base_tcp, branch)
        path = np.vstack([np.asarray(start, float), rows])
        known = np.flatnonzero(~np.isnan(path[:, 0]))
        path[known] = np.unwrap(path[known], axis=0)
        return path[1:]

    def limit_margin(self, q: ArrayLike) -> tuple[float, int]:
        """Least distance of an axis to its limits (rad, negative outside), and which axis (0..5)."""
        q = np.asarray(q, float)
        margins = np.minimum(q - self.arm.lower, self.arm.upper - q)
        axis = int(np.argmin(margins))
        return float(margins[axis]), axis
