"""What the inverse of a kind of arm gives, whatever kind it is; arms with six axes are the simple case.

A form knows its branches and solves poses on each. Where an arm has another number of axes, it says as well how the
motion of the TCP and that of the axes belong together: `square` makes the Jacobian of a line square, and `wanted` says
what of a twist it is about.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pn2code.robot.branches import BRANCHES, Branch
from pn2code.robot.chain import Chain
from pn2code.robot.three_axes import ThreeAxes
from pn2code.robot.transforms import Array


class ClosedForm:
    """All joint positions of poses, by branch."""

    known: tuple[Branch, ...] = BRANCHES
    arm_angle: float | None = None
    """rad, of arms with a redundant axis: what is meant where nothing is said; None: the arm has none."""
    wrist_axes: tuple[int, ThreeAxes] | None = None
    """The three axes of a spherical wrist, and the index of the first; None: the arm has no such wrist."""

    bends: tuple[str, ...] = ("elbow", "wrist")
    """What of the arm can be straight, and singular then."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain

    def branches(self, T_base_tcp: Array, arm_angle: Array | None = None) -> Array:
        """Of n poses (n, 4, 4): (n, branches, axes), NaN where a branch does not exist.

        Args:
            arm_angle: rad, of each pose, (n,); None: that of the form.
        """
        raise NotImplementedError

    def refused(self, T_base_tcp: Array) -> str:
        """Why an arm of this kind cannot have a pose, wherever it is; "": it can."""
        return ""

    def angle_of(self, frames: Sequence[Array]) -> Array:
        """The arm angle (rad) of arms that have one, (n,)."""
        raise AssertionError("it has no arm angle")

    def square(self, jacobian: Array, frames: Sequence[Array]) -> Array:
        """A square matrix that takes axis speeds to what a line is about, from the Jacobian (n, 6, axes)."""
        return jacobian

    def wanted(self, twist: Array, swivel: float | Array = 0.0) -> Array:
        """The same of a twist (..., 6): what a line is about; `swivel`: of the arm angle, rad."""
        return twist

    def steep(self, frames: Sequence[Array]) -> tuple[Array, Array]:
        """What `square` has beyond the Jacobian: a bound on how fast it changes, and how far (rad) that holds; (n,)."""
        count = len(frames[0])
        return np.zeros(count), np.full(count, np.inf)

    def elbow(self, frames: Sequence[Array]) -> Array:
        """rad: how far the elbow is from straight, (n,)."""
        return self.chain.elbow(frames)

    def wrist(self, frames: Sequence[Array]) -> Array:
        """rad: how far the wrist is from straight, in [0, pi/2], (n,)."""
        return self.chain.wrist(frames)
