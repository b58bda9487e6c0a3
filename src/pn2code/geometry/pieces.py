"""Pieces of two legs, and which links of one may come near to which of the other there.

    front = Front.whole(a, b)                       # both legs whole, all links
    level = Level(front, a, b)                      # capsules: bounds of the distance, all at once (NumPy)
    level.near                                      # pieces that these do not show to be clear
    front = front.halves(level, pieces, kept)       # divided, with the pairs of links that are still of interest

What is clear in a piece is clear in both of its halves; so each pair of links is looked at no longer than it must be.

`near` and `Own` say which pairs of links the collision library need be asked about. A link's capsule is around a box
that is around all of its collision shapes, with their margins, and larger by some millimetres (`BulletBackend.box`); so
links are no nearer to each other than their capsules are, and what has capsules further apart than is asked for would
not be found.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.tracks import Knots, Track
from pn2code.robot.transforms import Array, Flags, Numbers

ROUNDING = 1e-5
"""m: of the collision library."""
KEPT = 0.2
"""m: links that are further apart in a piece are not looked at in its parts."""


class Swept(Protocol):
    """A leg, or what stands."""

    radii: Array
    names: dict[str, int]
    is_still: bool

    def begin(self) -> None:
        """A question begins."""

    def knots(self, a: Array, b: Array) -> Knots:
        """Pieces of it."""


@frozen(eq=False)
class Front:
    """What is still to be looked at.

    Args:
        pieces: from where to where on the way of each, (n, 4).
        row: of which piece, ascending; one, other: which links of both; (m,) each.
    """

    pieces: Array
    row: Numbers
    one: Numbers
    other: Numbers

    @staticmethod
    def whole(a: Swept, b: Swept) -> Front:
        """Both ways from their beginning to their end."""
        one, other = np.indices((len(a.radii), len(b.radii))).reshape(2, -1)
        return Front(np.array([[0.0, 1.0, 0.0, 1.0]]), np.zeros(len(one), int), one, other)

    def halves(self, level: Level, pieces: Numbers, kept: Flags) -> Front:
        """Some pieces, each divided where its links go further, with the pairs of links that are kept."""
        place = np.full(len(self.pieces), -1)
        place[pieces] = np.arange(len(pieces))
        rows = np.flatnonzero(kept & (place[self.row] >= 0))
        rows = rows[np.argsort(place[self.row[rows]], kind="stable")]
        cut = np.where(level.is_first[pieces], 0, 2)
        own, index = self.pieces[pieces], np.arange(len(pieces))
        middle = (own[index, cut] + own[index, cut + 1]) / 2.0
        first, second = own.copy(), own.copy()
        first[index, cut + 1] = second[index, cut] = middle
        row = place[self.row[rows]]
        return Front(
            np.concatenate([first, second]),
            np.concatenate([row, row + len(pieces)]),
            np.tile(self.one[rows], 2),
            np.tile(self.other[rows], 2),
        )


class Level:
    """What capsules say of all pieces of a front.

    Attributes:
        both: m, how far the links of a pair may be off together; gap: between their capsules; bound: no less than this.
        near: the pieces with pairs that may touch, the nearest first.
        far, gap_of: of all pieces the least bound, and the least gap.
        wide: and the most of `both` among pairs that may touch.
        is_first: whether the first leg goes further in it.
    """

    def __init__(self, front: Front, a: Swept, b: Swept) -> None:
        pieces, row = front.pieces, front.row
        self.first, self.first_at = _unique(a, pieces[:, 0], pieces[:, 1])
        self.second, self.second_at = _unique(b, pieces[:, 2], pieces[:, 3])
        at, to = self.first_at[row], self.second_at[row]
        p, q = self.first.ends[at, front.one], self.second.ends[to, front.other]
        off = a.radii[front.one] + b.radii[front.other]
        self.gap = between(p[:, 0], p[:, 1], q[:, 0], q[:, 1]) - off
        self.both = self.first.spread[at, front.one] + self.second.spread[to, front.other]
        self.bound = self.gap - self.both
        self.is_near = self.bound <= ROUNDING
        self.far = np.full(len(pieces), np.inf)
        np.minimum.at(self.far, row, self.bound)
        self.wide = np.zeros(len(pieces))
        np.maximum.at(self.wide, row[self.is_near], self.both[self.is_near])
        self.gap_of = np.full(len(pieces), np.inf)
        np.minimum.at(self.gap_of, row, self.gap)
        near = np.flatnonzero(self.far <= ROUNDING)
        # The nearest first: what touches is found soon.
        self.near = near[np.argsort(self.far[near], kind="stable")]
        if a.is_still or b.is_still:
            self.is_first = np.full(len(pieces), not a.is_still)
        else:
            most = self.first.spread.max(axis=1), self.second.spread.max(axis=1)
            self.is_first = most[0][self.first_at] >= most[1][self.second_at]

    def joints(self, piece: int) -> tuple[Array, Array]:
        """Where both are in the middle of a piece."""
        return self.first.q[self.first_at[piece]], self.second.q[self.second_at[piece]]

    def gaps(self, pieces: Numbers, a: Swept, b: Swept) -> Array:
        """Between the capsules of all links, in the middle of some pieces, (n, links, links)."""
        one, two = self.first.pick(self.first_at[pieces]), self.second.pick(self.second_at[pieces])
        return gaps(one, a.radii, two, b.radii)

    def spreads(self, piece: int) -> tuple[Array, Array]:
        """By how much the links of both may be off."""
        return self.first.spread[self.first_at[piece]], self.second.spread[self.second_at[piece]]


def _unique(swept: Swept, a: Array, b: Array) -> tuple[Knots, Numbers]:
    """The knots of pieces, each worked out once, and which is which."""
    pairs, index = np.unique(a + 1j * b, return_inverse=True)
    return swept.knots(pairs.real, pairs.imag), np.asarray(index).reshape(-1)


def gaps(one: Knots, radii: Array, two: Knots, others: Array) -> Array:
    """A lower bound of the distance of each two links: between their capsules, (n, links, links)."""
    p, q = one.ends[:, :, None], two.ends[:, None, :]
    return between(p[..., 0, :], p[..., 1, :], q[..., 0, :], q[..., 1, :]) - radii[:, None] - others


def near(
    gap: Array, limit: float, one: Sequence[str], other: Sequence[str]
) -> set[tuple[str, str]]:
    """The pairs of links that may be nearer to each other than `limit`, of gaps (links, links)."""
    rows, columns = np.nonzero(~(gap > limit + ROUNDING))
    return {(one[i], other[j]) for i, j in zip(rows.tolist(), columns.tolist(), strict=True)}


class Own:
    """Which links of an arm may be near to other ones of its own, or to what it carries, on a leg."""

    def __init__(self, track: Track) -> None:
        self._track = track
        names = list(track.names)
        one, other = np.triu_indices(len(names), 1)
        self._pairs = [
            (names[i], names[j]) for i, j in zip(one.tolist(), other.tolist(), strict=True)
        ]
        self._one, self._other = one, other
        self._off = track.radii[one] + track.radii[other]
        self._gaps: dict[int, Array] = {}

    def near(self, a: float, b: float, limit: float) -> set[tuple[str, str]]:
        """The pairs, each in both orders, in the middle of a piece whose knots have been asked for."""
        knots, row = self._track.batch(a, b)
        gap = self._gaps.get(id(knots))  # the track keeps them
        if gap is None:
            p, q = knots.ends[:, self._one], knots.ends[:, self._other]
            gap = between(p[..., 0, :], p[..., 1, :], q[..., 0, :], q[..., 1, :]) - self._off
            self._gaps[id(knots)] = gap
        found = [self._pairs[i] for i in np.flatnonzero(~(gap[row] > limit + ROUNDING)).tolist()]
        return {*found, *((y, x) for x, y in found)}


def between(p1: Array, q1: Array, p2: Array, q2: Array) -> Array:
    """Distances of segments (Ericson, Real-Time Collision Detection, 5.1.9)."""
    d1, d2, r = q1 - p1, q2 - p2, p1 - p2
    a, e = (d1 * d1).sum(-1), (d2 * d2).sum(-1)
    f, c, b = (d2 * r).sum(-1), (d1 * r).sum(-1), (d1 * d2).sum(-1)
    tiny = 1e-12
    a, e = np.maximum(a, tiny), np.maximum(e, tiny)
    down = a * e - b * b
    s = np.where(
        down > 1e-9 * a * e, np.clip((b * f - c * e) / np.maximum(down, 1e-300), 0.0, 1.0), 0.0
    )
    t = (b * s + f) / e
    s = np.where(
        t < 0.0, np.clip(-c / a, 0.0, 1.0), np.where(t > 1.0, np.clip((b - c) / a, 0.0, 1.0), s)
    )
    t = np.clip(t, 0.0, 1.0)
    apart = (p1 + d1 * s[..., None]) - (p2 + d2 * t[..., None])
    return np.asarray(np.sqrt((apart * apart).sum(-1)))
