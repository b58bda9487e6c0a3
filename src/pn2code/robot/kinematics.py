"""Kinematics of an arm with its tool: forward, closed-form inverse by branch, conditioning.

    k = Kinematics.of(arm, tool, origin, d)
    T_base_tcp = k.forward(q)
    for solution in k.inverse(T_base_tcp): solution.branch, solution.q
    k.conditioning(q).condition          # of the TCP Jacobian, lengths in m

The inverse is `py-opw-kinematics` (docs/adr/006): all eight branches of an arm with parallel axes 2
and 3 and a spherical wrist; for arms with parallel axes 2, 3 and 4 it is `eaik` (`parallel`). Arms with
seven axes (`seven`), SCARA and gantries (`vertical`) have forms of their own. Their
parameters are derived from the URDF's axes and compared with the URDF's forward kinematics, which is
the truth here; answers are verified against it as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import codes, parallel, seven, vertical
from pn2code.robot.branches import BRANCH_NAMES, BRANCHES, Branch
from pn2code.robot.chain import Chain, cross, derive
from pn2code.robot.closed_form import ClosedForm
from pn2code.robot.model import Arm, Tool
from pn2code.robot.spherical_wrist import SphericalWrist
from pn2code.robot.three_axes import ThreeAxes
from pn2code.robot.transforms import Array, inverse

__all__ = ["BRANCHES", "BRANCH_NAMES", "TURN", "Branch", "Conditioning", "Kinematics", "Solution"]
TURN = 2.0 * math.pi
CHARACTERISTIC_LENGTH = 1.0  # m: lengths in the Jacobian are divided by it, so that it has no units
POSITION_TOLERANCE = 1e-11  # m and rad: an answer of the inverse further off is refined
ACCEPTED_ERROR = 1e-9  # m and rad: an answer further off after refinement is not an answer
_STRAIGHT = (
    1e-8  # sine of the bend of a wrist: nearer to zero, nothing is known of the axes around it
)
_LIMIT_SLACK = 1e-9  # rad: a target exactly at a limit counts as inside


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


_SEVEN = (
    "of arms with seven axes those are known whose axes 1, 2 and 3 meet in the shoulder and 5, 6 and 7 in the wrist, "
    "with axis 4 between them"
)
_VERTICAL = (
    "of arms with four axes SCARA are known (three axes turn and one slides, all along the base's z) and gantries "
    "(three slide, one turns about the base's z)"
)


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
        self.slides = chain.slides
        """Which axes of the arm slide."""
        self._sliding = np.flatnonzero(chain.slides)
        self.branches = form.known
        """In which it may reach a pose."""
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
            return cls(arm, frame, chain, SphericalWrist(chain, *derived, frame))
        if chain.is_six:
            return cls._six(arm, frame, chain, derived, at, d)
        form: ClosedForm | str
        if chain.count == seven.AXES:
            form, hint = seven.derive(chain, frame), _SEVEN
        else:
            form, hint = vertical.derive(chain, frame), _VERTICAL
        if not isinstance(form, str):
            return cls(arm, frame, chain, form)
        d.error(
            codes.UNSUPPORTED_KINEMATICS,
            f"robot model `{arm.name}` has no closed-form inverse kinematics: {form}",
            at,
            hint=hint,
        )
        return None

    @classmethod
    def _six(
        cls, arm: Arm, frame: Array, chain: Chain, derived: str, at: Origin, d: Diagnostics
    ) -> Kinematics | None:
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

    # Arm angle

    @property
    def arm_angle(self) -> float | None:
        """rad: of an arm with seven axes, where its elbow is when nothing is said; None: it is decided by the pose."""
        return self._form.arm_angle

    def with_arm_angle(self, angle: float) -> Kinematics:
        """The same with another arm angle where nothing is said."""
        assert isinstance(self._form, seven.SevenAxes), "it has an arm angle"
        form = copy(self._form)
        form.arm_angle = angle
        return Kinematics(self.arm, self.T_flange_tcp, self._chain, form)

    def arm_angle_of(self, q: ArrayLike) -> float | None:
        """That of a joint position; None: the arm has none."""
        if self._form.arm_angle is None:
            return None
        return float(self._form.angle_of(self._chain.frames(np.asarray(q, float)[None]))[0])

    def refused(self, T_base_tcp: Array) -> str:
        """Why an arm of this kind cannot have a pose, wherever it is; "": it can."""
        return self._form.refused(T_base_tcp)

    # Forward

    def forward(self, q: ArrayLike) -> Array:
        """`T_base_tcp`."""
        return np.asarray(self.forward_many(np.asarray(q, float)[None])[0])

    def forward_many(self, q: Array) -> Array:
        """`T_base_tcp` of n joint positions (n, axes): (n, 4, 4)."""
        return self.tcp_at(self._chain.frames(q))

    def tcp_at(self, frames: Sequence[Array]) -> Array:
        """`T_base_tcp` (n, 4, 4) where the axes are so (`link_frames`)."""
        return np.asarray(frames[-1] @ self.T_flange_tcp)

    def joint_frames(self, q: ArrayLike) -> Array:
        """`T_base_joint` of all axes, after their own motion, and of the flange: (axes + 1, 4, 4)."""
        return np.stack([f[0] for f in self._chain.frames(np.asarray(q, float)[None])])

    def link_frames(self, q: Array) -> list[Array]:
        """The same of n joint positions (n, axes): arrays (n, 4, 4), one more than axes."""
        return self._chain.frames(q)

    def axes_of(self, frames: Sequence[Array]) -> Array:
        """Directions of all axes in the base frame, (n, axes, 3)."""
        return self._chain.all_axes(frames)

    @property
    def T_axis_flange(self) -> Array:  # noqa: N802
        """The flange in the frame of the last axis."""
        return self._chain.end

    @property
    def longest(self) -> float:
        """m: the TCP is never further from any axis than all lengths between them together."""
        lengths = np.linalg.norm(self._chain.before[1:, :3, 3], axis=1).sum()
        lengths += np.maximum(-self.arm.lower, self.arm.upper)[self._sliding].sum()
        return float(lengths + np.linalg.norm((self._chain.end @ self.T_flange_tcp)[:3, 3]))

    @property
    def wrist_in_flange(self) -> Array | None:
        """Where axes 4, 5 and 6 meet, and the direction of axis 6, seen from the flange, (2, 3); None: nowhere."""
        if not isinstance(self._form, SphericalWrist):
            return None
        frame = inverse(self._chain.zero[-1])
        centre = frame @ np.append(self._chain.wrist_centre, 1.0)
        axis = frame[:3, :3] @ self._chain.axis(5, [f[None] for f in self._chain.zero])[0]
        return np.stack([centre[:3], axis])

    @property
    def wrist_axes(self) -> tuple[int, ThreeAxes] | None:
        """The axes of a spherical wrist, and the index of the first; None: it has none."""
        return self._form.wrist_axes

    # Differential

    def jacobian(self, q: ArrayLike) -> Array:
        """The Jacobian at the TCP in the base frame, (6, axes): rows 0-2 m/rad, rows 3-5 rad/rad (m/m, 0 of slides)."""
        return np.asarray(self.jacobian_many(np.asarray(q, float)[None])[0])

    def jacobian_many(self, q: Array) -> Array:
        """Jacobians of n joint positions (n, axes): (n, 6, axes)."""
        return self._jacobian(self._chain.frames(q))

    def _jacobian(self, frames: Sequence[Array]) -> Array:
        tcp = frames[-1][:, :3, :3] @ self.T_flange_tcp[:3, 3] + frames[-1][:, :3, 3]
        axes = self._chain.all_axes(frames)
        count = self._chain.count
        out = np.empty((len(tcp), 6, count))
        out[:, 3:] = axes.transpose(0, 2, 1)
        arms = tcp[:, None] - np.stack([f[:, :3, 3] for f in frames[:count]], axis=1)
        out[:, :3] = cross(axes, arms).transpose(0, 2, 1)
        for i in self._sliding:
            out[:, :3, i], out[:, 3:, i] = axes[:, i], 0.0
        return out

    def led_jacobian(self, q: Array, frames: Sequence[Array] | None = None) -> Array:
        """Square matrices that take axis speeds to what a line is about, (n, axes, axes): see `led_twist`.

        With six axes that is the Jacobian. A seventh row is how the arm angle changes; with four axes there are rows
        for the place and the turn about the vertical only. `frames`: `link_frames`, if known.
        """
        frames = frames or self._chain.frames(q)
        return self._form.square(self._jacobian(frames), frames)

    def led_twist(self, twist: Array, swivel: float | Array = 0.0) -> Array:
        """Of twists of the TCP (..., 6) what a line is about; `swivel`: how fast the arm angle changes."""
        return self._form.wanted(twist, swivel)

    def led_steepness(self, q: Array, frames: Sequence[Array] | None = None) -> tuple[Array, Array]:
        """How fast `led_jacobian` changes beside the Jacobian, at most, and how far from q (rad) that holds: (n,)."""
        return self._form.steep(frames or self._chain.frames(q))

    def conditioning(self, q: ArrayLike) -> Conditioning:
        """Condition number, smallest singular value, elbow and wrist angle at a joint position."""
        return self.conditioning_many(np.asarray(q, float)[None])[0]

    def conditioning_many(self, q: Array) -> list[Conditioning]:
        """The same for n joint positions (n, 6)."""
        return self._conditioning(self._chain.frames(q))

    def states(self, q: Array) -> tuple[Array, list[Conditioning]]:
        """`T_base_tcp` (n, 4, 4) and the conditioning of n joint positions (n, 6); both come from the same frames."""
        frames = self._chain.frames(q)
        return self.tcp_at(frames), self._conditioning(frames)

    def _conditioning(self, frames: Sequence[Array]) -> list[Conditioning]:
        scaled = self._jacobian(frames)
        scaled[:, :3] /= CHARACTERISTIC_LENGTH
        sigma = np.linalg.svd(scaled, compute_uv=False)
        elbow, wrist = self._form.elbow(frames), self._form.wrist(frames)
        return [
            Conditioning(
                float(s[0] / s[-1]) if s[-1] > 0.0 else math.inf, float(s[-1]), float(e), float(w)
            )
            for s, e, w in zip(sigma, elbow, wrist, strict=True)
        ]

    def straightness(self, elbow: float, wrist: float) -> str:
        """How far from straight (rad) what of this arm can be straight is, for people: "", or begins with a comma."""
        angles = {"elbow": elbow, "wrist": wrist}
        told = [f"{part} {math.degrees(angles[part]):.1f} deg" for part in self._form.bends]
        return f", {', '.join(told)} from straight" if told else ""

    # Inverse

    def all_branches(self, T_base_tcp: Array, arm_angle: float | Array | None = None) -> Array:
        """Of n poses (n, 4, 4): joint positions (n, branches, axes) by branch index, axes that turn in (-pi, pi].

        Where a branch does not exist the row is NaN. Limits are not looked at. Rows are exact: each
        was compared with the forward kinematics (and refined by Newton steps near singularities).
        `arm_angle`: rad, of all or of each; None: that of the arm.
        """
        angles = None if arm_angle is None else np.full(len(T_base_tcp), arm_angle)
        found = self._closed_form(T_base_tcp, angles)
        count = len(self.branches)
        self._refine(found.reshape(-1, found.shape[2]), np.repeat(T_base_tcp, count, axis=0))
        return found

    def on_branch(self, T_base_tcp: Array, branch: Branch, swivel: Array | None = None) -> Array:
        """The same on one branch only, (n, axes); `swivel`: the arm angle at each pose, (n,)."""
        found = np.ascontiguousarray(self._closed_form(T_base_tcp, swivel)[:, branch.index])
        self._refine(found, T_base_tcp)
        return found

    def _closed_form(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        return self._form.branches(T_base_tcp, arm_angle)

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

    def inverse(
        self, T_base_tcp: Array, near: ArrayLike | None = None, arm_angle: float | None = None
    ) -> tuple[Solution, ...]:
        """All branches that have a turn inside the limits; full turns are chosen nearest to `near`."""
        reference = np.zeros(self._chain.count) if near is None else np.asarray(near, float)
        out = []
        rows = self.all_branches(T_base_tcp[None], arm_angle)[0]
        for branch, row in zip(self.branches, rows, strict=True):
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
        slides = self._sliding
        if len(slides):
            if (q < lower)[slides].any() or (q > upper)[slides].any():
                return None
            wish[slides] = least[slides] = most[slides] = 0.0
        if (least > most).any():
            return None
        out = np.asarray(q + TURN * np.clip(wish, least, most))
        if self.arm.urdf.couplings and self.arm.margins(out).min() < -_LIMIT_SLACK:
            return None
        return out

    def unwound(self, rows: Array, near: Array) -> Array:
        """Joint positions (n, axes) with full turns added, nearest to others."""
        turns = np.round((near - rows) / TURN)
        turns[..., self._sliding] = 0.0
        return np.asarray(rows + TURN * turns)

    def nearest(
        self,
        T_base_tcp: Array,
        reference: ArrayLike,
        branch: Branch | None = None,
        arm_angle: float | None = None,
    ) -> Solution | None:
        """The branch for a joint move from `reference`: the one the robot reaches first.

        That is the least max over the axes of |dq| / (axis speed); equal within 1 ns, the least sum,
        then the lowest branch index. `branch` restricts the choice to one. None: not reachable.
        """
        start = np.asarray(reference, float)

        def cost(s: Solution) -> tuple[float, float, Branch]:
            times = np.abs(s.q - start) / self.arm.velocity
            return round(float(times.max()), 9), round(float(times.sum()), 9), s.branch

        found = [
            s for s in self.inverse(T_base_tcp, start, arm_angle) if branch in (None, s.branch)
        ]
        return min(found, key=cost, default=None)

    def branch_of(self, q: ArrayLike) -> Branch:
        """The branch of a joint position: the one whose answer for its TCP pose is nearest to it."""
        q = np.asarray(q, float)
        rows = self.all_branches(self.forward(q)[None], self.arm_angle_of(q))[0]
        off = np.abs((rows - q + math.pi) % TURN - math.pi)
        off[:, self._sliding] = np.abs(rows - q)[:, self._sliding]
        if self._form.wrist_axes is not None:
            first, wrist = self._form.wrist_axes
            if abs(math.sin(wrist.bend(q[first + 1]))) <= _STRAIGHT:
                off[:, [first, first + 2]] = 0.0  # they are only known together
        away = off.max(axis=1)
        away[np.isnan(away)] = np.inf
        return self.branches[int(np.argmin(away))]

    def follow(
        self, T_base_tcp: Array, branch: Branch, start: ArrayLike, swivel: Array | None = None
    ) -> Array:
        """A path (n, 4, 4) on one branch, each position nearest in turns to the one before: (n, axes).

        Rows are NaN where the branch does not exist. Limits are not looked at.
        """
        return self.in_turn(self.on_branch(T_base_tcp, branch, swivel), start)

    def in_turn(self, rows: Array, start: ArrayLike) -> Array:
        """Joint positions (n, axes) with full turns added, each nearest to the one before, the first to `start`."""
        path = np.vstack([np.asarray(start, float), rows])
        known = np.flatnonzero(~np.isnan(path[:, 0]))
        slid = path[:, self._sliding]
        path[known] = np.unwrap(path[known], axis=0)
        path[:, self._sliding] = slid
        return path[1:]

    def turning_margins(self, q: Array) -> Array:
        """How far the axes of the arm that turn are from their limits, rad, (n, axes); of those that slide inf."""
        margins = np.array(self.arm.margins(q)[:, self.joints])
        margins[:, self._sliding] = np.inf
        return margins

    def limit_margin(self, q: ArrayLike) -> tuple[float, int]:
        """Least distance of an axis to its limits (rad, negative outside), and which axis (from 0).

        Of an axis that slides (m) only where it is outside.
        """
        q = np.asarray(q, float)
        margins = self.arm.margins(q)
        if len(self._sliding):
            slid = margins[self._sliding]
            if slid.min() < -_LIMIT_SLACK:
                return float(slid.min()), int(self._sliding[np.argmin(slid)])
            margins[self._sliding] = np.inf
        axis = int(np.argmin(margins))
        return float(margins[axis]), axis
