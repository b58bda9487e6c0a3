"""Whether two legs, whenever each is where, keep apart: pieces against pieces, smaller where they are near.

    sweeper = Sweeper(Shown(backend))
    sweeper.apart(track, other)           # Apart("clear" | "touch" | "open", distance, ...)
    sweeper.around(track, "scene")        # how near a leg comes to what stands

Capsules first (NumPy, all pairs of pieces at once), then the collision library in the middle of pieces. These are clear
when the distance there is more than no point can be further (`tracks`). So "clear" holds for all instants, not for
samples. A piece that is smaller than `RESOLUTION` and neither clear nor touching is left open.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.shown import Shown
from pn2code.geometry.tracks import Knots, Link, Track
from pn2code.robot.backend import Clearance
from pn2code.robot.parts import Part
from pn2code.robot.transforms import Array, Flags, Numbers

RESOLUTION = 2e-4
"""m: two pieces in which no points are further apart than this are not divided."""
ROUNDING = 1e-5
"""m: of the collision library."""
COARSE = 0.08
"""m: pieces in which points may be further from their place than this are divided before distances are measured."""
SEARCHED = 0.5
"""m: larger clearances are not measured."""
FINE, ROUGH = 2e-3, 0.15
"""m, or part of it: how exactly the least clearance, or the deepest overlap, is told."""
MOST_QUERIES = 20_000
"""Of the collision library, for one question ..."""
MOST_DEEPER = 600
"""... and to see how deep an overlap is that was found."""

Measure = Callable[[Array, Array, float], list[Clearance]]
Outcome = Literal["clear", "touch", "open"]


@frozen(eq=False)
class Apart:
    """How two things keep apart.

    Args:
        outcome: never nearer than touching, touching somewhere, or not known.
        least: m, that is certain: where they touch, nothing overlaps by more than -least (-inf: nothing is certain).
        nearest: the smallest distance that was measured (inf: none); where they touch, the deepest overlap.
        where: the nearest links and points; at: of each leg the fraction of its way; joints: and where its arm is, rad.
        why: of "open".
    """

    outcome: Outcome
    least: float
    nearest: float
    where: Clearance | None = None
    at: tuple[float, float] = (0.0, 0.0)
    why: str = ""
    joints: tuple[Array, ...] = ()


class Sweeper:
    """Asks the collision library."""

    def __init__(self, shown: Shown) -> None:
        self._backend = shown.backend
        self._show = shown.show
        self.queries = 0

    # --- two legs --------------------------------------------------------------------------------

    def apart(self, a: Track, b: Track) -> Apart:
        """Two legs of two arms; where they touch, how deep."""
        return self._search(a, b, self._of_two(a, b), is_free="ptp" in (a.leg.kind, b.leg.kind))

    def nearest(self, a: Track, b: Track, known: float) -> Apart:
        """How near two legs come that keep apart, as far as it is less than what is known (m)."""
        is_free = "ptp" in (a.leg.kind, b.leg.kind)
        two = Two(a, b, self._of_two(a, b), is_free, self, self._skipped(a, b, is_free=is_free))
        return deepest(two, Apart("clear", known, known))

    def _of_two(self, a: Track, b: Track) -> Measure:
        self._show((*a.parts, *b.parts))

        def measure(q_a: Array, q_b: Array, limit: float) -> list[Clearance]:
            self._backend.set_joints(a.robot, q_a)
            self._backend.set_joints(b.robot, q_b)
            return self._backend.pairs("robots", a.robot, limit, b.robot)

        return measure

    def _skipped(self, a: Track, b: Track, *, is_free: bool) -> Flags:
        """Links that may touch, (links of a, links of b)."""
        may = self._backend.allowed
        rows = [[not is_free and may(x, y) is not None for y in b.names] for x in a.names]
        return np.array(rows)

    def beside(self, a: Track, part: Part, box: tuple[Array, Array]) -> Apart:
        """A leg and a part that stands."""
        self._show((part, *a.parts))
        free = a.leg.kind == "ptp"

        def measure(q_a: Array, _q_b: Array, limit: float) -> list[Clearance]:
            self._backend.set_joints(a.robot, q_a)
            return self._backend.pairs("scene", a.robot, limit, only={part.name})

        return self._search(a, Standing(part, box), measure, is_free=free)

    def _search(
        self,
        a: Track,
        b: Track | Standing,
        measure: Measure,
        *,
        is_free: bool,
    ) -> Apart:
        begun = self.queries
        pieces = np.array([[0.0, 1.0, 0.0, 1.0]])
        least, nearest = math.inf, math.inf
        where: Clearance | None = None
        at = (0.0, 0.0)
        open_: tuple[Clearance, tuple[float, float], float, tuple[Array, Array]] | None = None
        while len(pieces):
            one, one_at = _unique(a, pieces[:, 0], pieces[:, 1])
            two, two_at = _unique(b, pieces[:, 2], pieces[:, 3])
            gaps = _gaps(one.pick(one_at), a.radii, two.pick(two_at), b.radii)
            both = one.spread[one_at][:, :, None] + two.spread[two_at][:, None, :]
            bound = gaps - both
            is_near = bound <= ROUNDING
            far = bound.reshape(len(pieces), -1).min(axis=1)
            near = np.flatnonzero(is_near.any(axis=(1, 2)))
            if len(near) < len(pieces):
                least = min(least, float(np.delete(far, near).min()))
            wide = np.where(is_near, both, 0.0).reshape(len(pieces), -1).max(axis=1)
            further: list[Array] = []
            # The nearest first: what touches is found soon.
            for i in near[np.argsort(far[near], kind="stable")]:
                own = pieces[i]
                if wide[i] > COARSE:
                    further += _halves(own, a, b, one.spread[one_at[i]], two.spread[two_at[i]])
                    continue
                if self.queries - begun >= MOST_QUERIES:
                    why = f"more than {MOST_QUERIES:,} distances would have to be measured"
                    return Apart("open", 0.0, nearest, where, at, why)
                self.queries += 1
                q_a, q_b = one.q[one_at[i]], two.q[two_at[i]]
                limit = float(wide[i]) + FINE
                found = measure(q_a, q_b, limit)
                # What was not found is further away, or its capsules are.
                unseen = np.maximum(bound[i], limit - both[i]).min()
                least = min(least, float(unseen) - ROUNDING)
                middle = ((own[0] + own[1]) / 2.0, (own[2] + own[3]) / 2.0)
                is_clear = True
                for gap in found:
                    allowed = gap.permitted(is_free=is_free)
                    slack = gap.distance if allowed is None else gap.distance + allowed
                    if allowed is None and gap.distance < nearest:
                        nearest, where, at = gap.distance, gap, middle
                    if slack < 0.0 or (slack <= 0.0 and allowed is None):
                        touch = Apart("touch", slack, slack, gap, middle, "", (q_a, q_b))
                        return deepest(Two(a, b, measure, is_free, self), touch)
                    spread = _spread_of(gap.a, a, one.spread[one_at[i]])
                    spread += _spread_of(gap.b, b, two.spread[two_at[i]])
                    if slack <= spread + ROUNDING:
                        is_clear = False
                        if wide[i] <= RESOLUTION and (open_ is None or slack < open_[2]):
                            open_ = (gap, middle, slack, (q_a, q_b))
                    else:
                        least = min(least, slack - spread)
                if not is_clear and wide[i] > RESOLUTION:
                    further += _halves(own, a, b, one.spread[one_at[i]], two.spread[two_at[i]])
            pieces = np.array(further).reshape(-1, 4)
        if open_ is not None:
            gap_, at_, slack, joints = open_
            why = f"they come within {1000.0 * max(slack, 0.0):.2f} mm, which is less than can be told apart"
            return Apart("open", 0.0, nearest, gap_, at_, why, joints)
        if a.trouble or b.trouble:
            return Apart("open", 0.0, nearest, where, at, a.trouble or b.trouble)
        return Apart("clear", least, nearest, where, at)

    # --- a leg and what stands -------------------------------------------------------------------

    def around(self, a: Track, kind: Literal["scene", "self"]) -> Apart:
        """How near a leg comes to the scene, or to the arm itself; where it touches, how deep."""
        self._show(a.parts)
        begun = self.queries
        most = MOST_QUERIES
        count = itertools.count()
        best = SEARCHED
        where: Clearance | None = None
        at = 0.0
        # What comes first, its number, from where to where; nothing in it is below the last.
        heap: list[tuple[float, int, float, float, float]] = [(0.0, 0, 0.0, 1.0, -math.inf)]
        next(count)
        least = SEARCHED
        open_: Apart | None = None
        touch: Apart | None = None
        while heap:
            low, _, first, last, deep = heapq.heappop(heap)
            if touch is not None:
                if deep > best - max(FINE, ROUGH * -best) or self.queries - begun >= most:
                    least = min(least, deep)
                    break
            elif low > max(best - max(FINE, ROUGH * best), ROUNDING) or low >= SEARCHED:
                least = min(low, best)
                break
            knots = a.knots(np.array([first]), np.array([last]))
            wide = float(knots.spread.max())
            middle = (first + last) / 2.0
            halves = ((first, middle), (middle, last))
            # Both halves at once take half as long.
            if wide > RESOLUTION:
                a.knots(np.array([first, middle]), np.array([middle, last]))
            if wide > 4.0 * COARSE:
                for one, other in halves:
                    first_of = low if touch is None else deep
                    heapq.heappush(heap, (first_of, next(count), one, other, deep))
                continue
            if self.queries - begun >= most:
                why = f"more than {MOST_QUERIES:,} distances would have to be measured"
                return Apart("open", 0.0, best, where, (at, 0.0), why)
            self.queries += 1
            self._backend.set_joints(a.robot, knots.q[0])
            times = 2.0 if kind == "self" else 1.0
            limit = max(best, 0.0) + times * wide + ROUNDING
            found = self._backend.pairs(kind, a.robot, limit)
            bound = best + ROUNDING
            is_open = False
            lowest = max(best, 0.0) + ROUNDING
            for gap in found:
                allowed = gap.permitted(is_free=a.leg.kind == "ptp")
                slack = gap.distance if allowed is None else gap.distance + allowed
                spread = _spread_of(gap.a, a, knots.spread[0])
                if kind == "self":
                    spread += _spread_of(gap.b, a, knots.spread[0])
                lowest = min(lowest, slack - spread)
                touches = slack < 0.0 or (slack <= 0.0 and allowed is None)
                if touches and (touch is None or slack < best):
                    if touch is None:
                        most = self.queries - begun + MOST_DEEPER
                        heap = [(d, n, x, y, d) for _, n, x, y, d in heap]
                        heapq.heapify(heap)
                        least = -RESOLUTION
                    best = slack
                    joints = (knots.q[0],)
                    touch = Apart("touch", slack, slack, gap, (middle, 0.0), "", joints)
                if touch is not None:
                    continue
                if allowed is None:
                    if gap.distance < best:
                        best, where, at = gap.distance, gap, middle
                    bound = min(bound, gap.distance - spread)
                elif slack <= spread + ROUNDING:
                    is_open = True
                if slack <= spread + ROUNDING and wide * times <= RESOLUTION:
                    near = f"{1000.0 * max(slack, 0.0):.2f} mm"
                    why = f"`{gap.a}` and `{gap.b}` come within {near}, which is less than can be told apart"
                    open_ = Apart("open", 0.0, best, gap, (middle, 0.0), why)
            deep = max(deep, lowest)
            if touch is not None:
                if wide * times <= RESOLUTION:
                    least = min(least, deep)
                else:
                    for one, other in halves:
                        heapq.heappush(heap, (deep, next(count), one, other, deep))
                continue
            if wide * times <= RESOLUTION:
                continue
            if is_open or bound < best - max(FINE, ROUGH * best) or bound <= ROUNDING:
                low = ROUNDING if is_open else max(bound, 0.0)
                for one, other in halves:
                    heapq.heappush(heap, (low, next(count), one, other, deep))
            else:
                least = min(least, bound)
        if touch is not None:
            return replace(touch, least=-math.inf if a.trouble else min(touch.least, least))
        if open_ is not None:
            return open_
        if a.trouble:
            return Apart("open", 0.0, best, where, (at, 0.0), a.trouble)
        return Apart("clear", max(0.0, min(least, best)), best, where, (at, 0.0))


def much_less(distance: float) -> float:
    """What is nearer than this is nearer by so much that it is told."""
    return distance - max(FINE, ROUGH * abs(distance))


@frozen(eq=False)
class Two:
    """Two legs, or a leg and what stands, and how they are measured.

    Args:
        skipped: pairs of links of which nothing is asked; None: all are asked, and contacts that are permitted count.
    """

    a: Track | Standing
    b: Track | Standing
    measure: Measure
    is_free: bool
    sweeper: Sweeper
    skipped: Flags | None = None


def deepest(two: Two, known: Apart) -> Apart:
    """The least slack of two legs that is less than what is known, and what is certain of it: best first."""
    a, b, best = two.a, two.b, known
    begun, count = two.sweeper.queries, itertools.count()
    least = best.nearest
    heap = [(-math.inf, next(count), np.array([0.0, 1.0, 0.0, 1.0]))]
    while heap:
        low, number, own = heapq.heappop(heap)
        if low > much_less(best.nearest) or two.sweeper.queries - begun >= MOST_DEEPER:
            least = min(least, low)
            break
        one, other = a.knots(own[None, 0], own[None, 1]), b.knots(own[None, 2], own[None, 3])
        both = one.spread[0][:, None] + other.spread[0][None, :]
        bound = _gaps(one, a.radii, other, b.radii)[0] - both
        if two.skipped is not None:
            bound[two.skipped] = math.inf
        low = max(low, float(bound.min()))
        cut = much_less(best.nearest)
        is_near = bound <= cut
        wide = float(np.where(is_near, both, 0.0).max())
        if low <= cut and wide <= COARSE:
            two.sweeper.queries += 1
            joints = (one.q[0], other.q[0])
            measured = cut + ROUNDING
            middle = ((own[0] + own[1]) / 2.0, (own[2] + own[3]) / 2.0)
            for gap in two.measure(*joints, wide + max(cut, 0.0) + 2.0 * ROUNDING):
                allowed = gap.permitted(is_free=two.is_free)
                if allowed is not None and two.skipped is not None:
                    continue
                slack = gap.distance if allowed is None else gap.distance + allowed
                spread = _spread_of(gap.a, a, one.spread[0]) + _spread_of(gap.b, b, other.spread[0])
                measured = min(measured, slack - spread)
                if slack < best.nearest:
                    best = Apart(known.outcome, slack, slack, gap, middle, "", joints)
            low = max(low, measured)
        if low > much_less(best.nearest) or wide <= RESOLUTION:
            least = min(least, low)
            continue
        for half in _halves(own, a, b, one.spread[0], other.spread[0]):
            heapq.heappush(heap, (low, next(count), half))
    is_unknown = a.trouble or b.trouble
    return replace(best, least=-math.inf if is_unknown else min(least, best.nearest))


class Standing:
    """A part that stands, in the form of a track."""

    trouble = ""
    is_still = True

    def __init__(self, part: Part, box: tuple[Array, Array]) -> None:
        link = Link.of(part.name, 0, part.frame, *box)
        self.names = {part.name: 0}
        self.radii = np.array([link.radius])
        self._knots = Knots(np.zeros((1, 6)), link.ends[None, None], np.zeros((1, 1)))

    def knots(self, a: Array, b: Array) -> Knots:
        """Always the same."""
        return self._knots.pick(np.zeros(len(a), int))


def _unique(track: Track | Standing, a: Array, b: Array) -> tuple[Knots, Numbers]:
    """The knots of pieces, each worked out once, and which is which."""
    pairs, index = np.unique(np.stack([a, b], axis=1), axis=0, return_inverse=True)
    return track.knots(pairs[:, 0], pairs[:, 1]), np.asarray(index).reshape(-1)


def _halves(
    piece: Array, a: Track | Standing, b: Track | Standing, spread_a: Array, spread_b: Array
) -> list[Array]:
    """The piece of the leg that goes further, divided."""
    first = not a.is_still and (b.is_still or spread_a.max() >= spread_b.max())
    i = 0 if first else 2
    middle = (piece[i] + piece[i + 1]) / 2.0
    one, other = piece.copy(), piece.copy()
    one[i + 1] = other[i] = middle
    return [one, other]


def _spread_of(name: str, track: Track | Standing, spread: Array) -> float:
    """How far a link may be from where it was measured."""
    return float(spread[track.names[name]]) if name in track.names else float(spread.max())


def _gaps(one: Knots, radii: Array, two: Knots, others: Array) -> Array:
    """A lower bound of the distance of each two links: between their capsules, (n, links, links)."""
    p, q = one.ends[:, :, None], two.ends[:, None, :]
    return (
        _between(p[..., 0, :], p[..., 1, :], q[..., 0, :], q[..., 1, :]) - radii[:, None] - others
    )


def _between(p1: Array, q1: Array, p2: Array, q2: Array) -> Array:
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
