"""How far the joints of an arm turn within a piece of a line or an arc, although only samples of it are worked out.

    follower = Follower(kinematics, path)
    q, turns, lost = follower.pieces(a, b)      # joint positions in the middle of pieces, and how far each axis may be
                                                # from them; of which pieces that is not known

On a line dq/ds = J(q)^-1 v, where v is the twist of the line. With sigma the least singular value of J at a sample, L a
bound on how fast J changes with q, and w the norm of the twist times half the distance of samples: as long as
2 L w <= sigma^2, q is no further from the sample than y = (sigma - sqrt(sigma^2 - 2 L w)) / L (the comparison theorem
for y' = |v| / (sigma - L y)). In that ball the inverse of J differs by no more than |J^-1|^2 L y / (1 - |J^-1| L y),
which bounds how fast each axis turns. A piece in which the condition does not hold is not known, and has to be divided.
"""

from __future__ import annotations

import numpy as np

from pn2code.robot.kinematics import Kinematics
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import Array, Flags, Numbers

SAMPLES = 8
"""Steps within a piece."""
SHORTEST = 1e-6
"""m and rad: a piece that is shorter, and still not known, is given up."""
STRAIGHT = 1e-3
"""The same of a way on which the wrist is straight somewhere: there, it is never known."""


class _Samples:
    """What is known of samples, in arrays with a row for each; there is room for more than there are."""

    def __init__(self) -> None:
        self.count = 0
        self.fields: tuple[Array, ...] = ()

    def add(self, rows: tuple[Array, ...]) -> None:
        """Some more."""
        first, self.count = self.count, self.count + len(rows[0])
        if not self.fields or self.count > len(self.fields[0]):
            old, room = self.fields, 2 * self.count
            self.fields = tuple(np.empty((room, *x.shape[1:])) for x in rows)
            for field, kept in zip(self.fields, old, strict=False):
                field[:first] = kept[:first]
        for field, more in zip(self.fields, rows, strict=True):
            field[first : self.count] = more


class Follower:
    """A line in pieces."""

    def __init__(self, kinematics: Kinematics, path: LinearTrajectory) -> None:
        self._k, self._path = kinematics, path
        self._speed = float(np.hypot(np.hypot(path.line.length, path.line.angle), path.swivel))
        self._steep = _steepness(kinematics)
        self._shortest = STRAIGHT if path.is_straight else SHORTEST
        self._planned = path.fractions
        self._known: dict[float, int] = {}
        self._samples = _Samples()

    @property
    def trouble(self) -> str:
        """Why nothing is known of pieces that are lost."""
        return f"the {self._path.line.name} passes so near to a singularity that what lies between samples is not known"

    def pieces(self, a: Array, b: Array) -> tuple[Array, Array, Flags]:
        """Of the pieces from a to b: joint positions in the middle, (n, axes), and how far axes are from there.

        The latter is inf where it is not known. Pieces that are too short to be divided any more are lost then, and 0
        is said of them.
        """
        parts = np.linspace(0.0, 1.0, SAMPLES + 1)
        s = a[:, None] + (b - a)[:, None] * parts
        at = self._at(s.ravel()).reshape(s.shape)
        half = (b - a) * (self._speed / (2.0 * SAMPLES))
        q, turns, is_fine, _ = self._bounds(at, half)
        middle = q[:, SAMPLES // 2]
        away = (np.abs(q - middle[:, None]) + turns).max(axis=1)
        away[~is_fine] = np.inf
        lost = ~is_fine & ((b - a) * self._speed < self._shortest)
        away[lost] = 0.0
        return middle, away, lost

    def rates(self, a: Array, b: Array) -> tuple[Array, Array]:
        """How far each axis goes for one unit of the way, anywhere in the pieces from a to b: between these, (n, axes).

        Where that is not known, they are infinite.
        """
        parts = np.linspace(0.0, 1.0, SAMPLES + 1)
        s = a[:, None] + (b - a)[:, None] * parts
        at = self._at(s.ravel()).reshape(s.shape)
        half = (b - a) * (self._speed / (2.0 * SAMPLES))
        _, _, is_fine, (own, more) = self._bounds(at, half)
        more[~is_fine] = np.inf
        return (own - more).min(axis=1), (own + more).max(axis=1)

    def _at(self, s: Array) -> Numbers:
        """Which of the samples that are kept are at fractions of the way; new ones are worked out.

        Halves of a piece have every other sample of theirs in common with it, at the very same fractions. What is
        known of a sample depends on nothing else that is asked for.
        """
        keys = s.tolist()
        new = [key for key in dict.fromkeys(keys) if key not in self._known]
        if new:
            self._known |= {key: self._samples.count + i for i, key in enumerate(new)}
            self._samples.add(self._worked_out(np.array(new)))
        return np.array([self._known[key] for key in keys], np.intp)

    def _worked_out(self, s: Array) -> tuple[Array, ...]:
        """Of samples the joint positions, on the branch of the line, with the turns that the plan has there; and more.

        That is the matrix J, its least singular value, the bound on how fast it changes, how far that holds, the twist.
        """
        rows = self._path.rows(s)
        index = np.searchsorted(self._planned, s).clip(0, len(self._planned) - 1)
        q = self._k.unwound(rows, self._path.grid[index])
        flat = np.nan_to_num(q)
        frames = self._k.link_frames(flat)
        jacobian = self._k.led_jacobian(flat, frames)
        more_steep, far = self._k.led_steepness(flat, frames)
        sigma: Array = np.asarray(np.linalg.svd(jacobian, compute_uv=False)[..., -1], float)
        line = self._path.line
        rotation = (frames[-1] @ self._k.T_flange_tcp)[:, :3, :3]
        twist = np.concatenate([line.shifts(s), line.spins(rotation, s)], axis=1)
        twist = self._k.led_twist(twist, self._path.swivel)
        return q, jacobian, sigma, self._steep + more_steep, far, twist

    def _bounds(self, at: Numbers, half: Array) -> tuple[Array, Array, Flags, tuple[Array, Array]]:
        """How far each axis turns from a sample to half way to the next, (n, samples, axes); for which pieces.

        Before that where the samples are; and last how fast for one unit of the way: at the sample, and by how much
        that can be off.
        """
        q, jacobian, sigma, steep, far, twist = (x[at] for x in self._samples.fields)
        there = ~np.isnan(q).any(axis=(1, 2))
        w = half[:, None]
        inside = sigma**2 - 2.0 * steep * w
        y = (sigma - np.sqrt(np.maximum(inside, 0.0))) / steep
        reach = sigma - steep * y
        # Neighbours are no further from each other than both half steps are long; else the branch leaps.
        leap = np.linalg.norm(np.diff(q, axis=1), axis=2)
        is_fine = there & ((inside > 0.0) & (reach > 0.0) & (y <= far)).all(axis=1)
        is_fine &= (np.nan_to_num(leap, nan=np.inf) <= y[:, :-1] + y[:, 1:] + 1e-9).all(axis=1)
        line = self._path.line
        turns = np.zeros(q.shape)
        rates = np.zeros(q.shape), np.zeros(q.shape)
        if is_fine.any():
            own = np.linalg.solve(jacobian[is_fine], twist[is_fine][..., None])[..., 0]
            least = sigma[is_fine]
            other = steep[is_fine] * y[is_fine] / (least * reach[is_fine])
            # The twist turns with the tool, by no more than the angle of half a step; arcs and corners bend it, too.
            way = w[is_fine] / max(self._speed, 1e-12)
            more = (other + w[is_fine] / least) * self._speed + way * line.bend / least
            bound = (np.abs(own) + more[..., None]) * way[..., None]
            rates[0][is_fine], rates[1][is_fine] = own, more[..., None]
            turns[is_fine] = np.minimum(bound, y[is_fine][..., None])
        return q, turns, is_fine, rates


def _steepness(kinematics: Kinematics) -> float:
    """A bound on the norm of dJ/dq: no column changes faster than the arm is long (m) and 1 for its turn."""
    reach = kinematics.longest
    return float(len(kinematics.arm.lower) * np.sqrt(reach * reach + 1.0))
