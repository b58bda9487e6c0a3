"""Whether two legs, whenever each is where, keep apart: pieces against pieces, smaller where they are near.

    sweeper = Sweeper(Shown(backend))
    sweeper.apart(track, other)           # Apart("clear" | "touch" | "open", distance, ...)
    sweeper.around(track, "scene")        # how near a leg comes to what stands

Capsules first (NumPy, all pieces at once, of each only the links that may be near: `pieces`), then the collision
library in the middle of pieces. These are clear when the distance there is more than no point can be further
(`tracks`). So "clear" holds for all instants, not for samples. A piece that is smaller than `RESOLUTION` and neither
clear nor touching is left open. How deep an overlap is takes most of the time; that is searched for only where it is
told (`deepest`).
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable
from typing import Literal

import numpy as np

from pn2code.base.frozen import frozen, replace
from pn2code.geometry.apart import Apart, Found, Standing, spread_of
from pn2code.geometry.pieces import KEPT, ROUNDING, Front, Level, Own, gaps, near
from pn2code.geometry.shown import Shown
from pn2code.geometry.tracks import Track
from pn2code.robot.backend import Clearance
from pn2code.robot.bullet_distances import Near
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import Led, with_move
from pn2code.robot.part import Part
from pn2code.robot.transforms import Array, Flags

RESOLUTION = 2e-4
"""m: two pieces in which no points are further apart than this are not divided."""
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

LIKELY = 2
"""Pieces of one size that are tried before they are small enough to be sure of them."""

_WHOLE = np.array([0.0, 1.0, 0.0, 1.0])

TOGETHER = 16
"""Pieces of which it is seen at once between which links distances are measured."""

Measure = Callable[[Array, Array, Array, float, Near | None], list[Clearance]]
"""What is measured at two joint positions, the middles of a piece (from where to where on both ways)."""


class Sweeper:
    """Asks the collision library."""

    def __init__(self, shown: Shown) -> None:
        self._backend = shown.backend
        self._show = shown.show
        self.queries = 0

    # --- two legs --------------------------------------------------------------------------------

    def apart(self, a: Track, b: Track) -> Apart:
        """Two legs of two arms; where they touch, the first overlap that is met."""
        return self._search(a, b, self._of_two(a, b), is_free="ptp" in (a.leg.kind, b.leg.kind))

    def deepest(self, a: Track, b: Track, touch: Apart) -> Apart:
        """How deep two legs overlap that touch, where they do so most."""
        is_free = "ptp" in (a.leg.kind, b.leg.kind)
        return deepest(Two(a, b, self._of_two(a, b), is_free, self), touch)

    def nearest(self, a: Track, b: Track, known: float) -> Apart:
        """How near two legs come that keep apart, as far as it is less than what is known (m)."""
        is_free = "ptp" in (a.leg.kind, b.leg.kind)
        skipped = self._skipped(a, b, is_free=is_free or bool(_turning(a, b)))
        two = Two(a, b, self._of_two(a, b), is_free, self, skipped)
        return deepest(two, Apart("clear", known, known))

    def _of_two(self, a: Track, b: Track) -> Measure:
        self._show((*a.parts, *b.parts))
        # What stands on a turntable that stands, too, does not go with a joint move of the arm.
        free = {x.robot for x in (a, b) if x.leg.kind == "ptp"}
        calm = {x.robot for x in (a, b) if x.is_calm}
        turning = _turning(a, b)

        def permitted(x: Clearance, piece: Array) -> Clearance:
            if not turning.isdisjoint(x.plates):
                return replace(x, allowed=None)
            x = self._as_led(x, piece, a, b)
            return replace(x, stands=True) if free and free <= calm.intersection(x.rides) else x

        def measure(
            q_a: Array, q_b: Array, piece: Array, limit: float, near: Near | None
        ) -> list[Clearance]:
            self._backend.set_joints(a.robot, q_a)
            self._backend.set_joints(b.robot, q_b)
            found = self._backend.distances.pairs("robots", a.robot, limit, b.robot, near=near)
            return [permitted(x, piece) for x in found]

        return measure

    def _skipped(self, a: Track, b: Track, *, is_free: bool) -> Flags:
        """Links that may touch, (links of a, links of b)."""
        may = self._backend.distances.allowed
        rows = [
            [
                not is_free
                and may(x, y) is not None
                and self._led(x, y, _WHOLE, a, b) is not Led.ELSEWHERE
                for y in b.names
            ]
            for x in a.names
        ]
        return np.array(rows)

    def _as_led(self, gap: Clearance, piece: Array, *near: Track | Standing) -> Clearance:
        """What was measured in the middle of a piece, with what is permitted there, and everywhere in the piece."""
        if gap.allowed is None:
            return gap
        led = self._led(gap.a, gap.b, piece, *near)
        if led is not Led.FAR:
            return with_move(gap, led)
        middle = (piece[0::2] + piece[1::2]) / 2.0
        here = with_move(gap, self._led(gap.a, gap.b, np.repeat(middle, 2), *near))
        return replace(here, short=here.allowed or 0.0)

    def _led(self, one: str, two: str, piece: Array, *near: Track | Standing) -> Led:
        """What moves have to do with a contact of a tool that grips parts, or of a part, in all of a piece of both."""
        tracks = {x.robot: x for x in near if isinstance(x, Track)}
        rows = piece.reshape(-1, 2).tolist()
        pieces = {
            x.robot: (first, last)
            for x, (first, last) in zip(near, rows, strict=True)
            if isinstance(x, Track)
        }

        def ends_of(name: str) -> MoveEnds | None:
            return tracks[name].ends if name in tracks else None

        # What stands on a plate that moves may be touched by nobody else, so it stands where it was.
        def stands(name: str) -> Array:
            return tracks[name].leg.start.q

        parts = {p.name: p for x in near for p in x.parts}
        led = self._backend.distances.led
        return led.of_pair(one, two, ends_of, parts, stands, pieces.__getitem__, ROUNDING)

    def beside(self, a: Track, part: Part, box: tuple[Array, Array]) -> Apart:
        """A leg and a part that stands; where they touch, the first overlap that is met."""
        stands = Standing(part, box)
        return self._search(a, stands, self._of_part(a, stands), is_free=a.leg.kind == "ptp")

    def deepest_beside(self, a: Track, part: Part, box: tuple[Array, Array], touch: Apart) -> Apart:
        """How deep a leg and a part overlap that touch, where they do so most."""
        is_free = a.leg.kind == "ptp"
        stands = Standing(part, box)
        return deepest(Two(a, stands, self._of_part(a, stands), is_free, self), touch)

    def _of_part(self, a: Track, stands: Standing) -> Measure:
        (part,) = stands.parts
        self._show((part, *a.parts))

        def measure(
            q_a: Array, _q_b: Array, piece: Array, limit: float, near: Near | None
        ) -> list[Clearance]:
            self._backend.set_joints(a.robot, q_a)
            found = self._backend.distances.pairs(
                "scene", a.robot, limit, only={part.name}, near=near
            )
            return [self._as_led(x, piece, a, stands) for x in found]

        return measure

    def _search(
        self,
        a: Track,
        b: Track | Standing,
        measure: Measure,
        *,
        is_free: bool,
    ) -> Apart:
        most = self.queries + MOST_QUERIES
        a.begin()
        b.begin()
        front = Front.whole(a, b)
        found = Found(a, b, is_free=is_free)
        names = list(a.names), list(b.names)
        while len(front.pieces):
            level = Level(front, a, b)
            is_kept = level.bound <= KEPT
            found.certain(level.bound[~is_kept])
            found.certain(level.far[level.far > ROUNDING])
            coarse = level.near[level.wide[level.near] > COARSE]
            # Where capsules overlap most, arms are likely to touch: that is tried while pieces are still large.
            likely = coarse[np.argsort(level.gap_of[coarse], kind="stable")[:LIKELY]]
            for piece in likely[level.gap_of[likely] < 0.0]:
                self.queries += 1
                q = level.joints(piece)
                found.look(measure(*q, front.pieces[piece], ROUNDING, None), front.pieces[piece], q)
                if found.touch is not None:
                    return found.touch
            further: list[int] = []
            begins = np.searchsorted(front.row, np.arange(len(front.pieces) + 1))
            fine = level.near[level.wide[level.near] <= COARSE]
            for number, piece in enumerate(fine):
                if number % TOGETHER == 0:
                    gap_of = level.gaps(fine[number : number + TOGETHER], a, b)
                if self.queries >= most:
                    return found.given_up(
                        f"more than {MOST_QUERIES:,} distances would have to be measured"
                    )
                self.queries += 1
                q = level.joints(piece)
                spreads = level.spreads(piece)
                wide = float(level.wide[piece])
                pairs = slice(begins[piece], begins[piece + 1])
                one, other = front.one[pairs], front.other[pairs]
                # What is not found is further away, or its capsules are.
                low = np.maximum(level.bound[pairs], wide + FINE - ROUNDING - level.both[pairs])
                nearest = near(gap_of[number % TOGETHER], wide + FINE, *names)
                own = front.pieces[piece]
                samples = found.look(measure(*q, own, wide + FINE, nearest), own, q)
                if found.touch is not None:
                    return found.touch
                for sample in samples:
                    gap = sample.gap
                    spread = spread_of(gap.a, a, spreads[0]) + spread_of(gap.b, b, spreads[1])
                    spread += gap.short
                    which = found.which(gap, one, other)
                    least = np.maximum(level.bound[pairs][which], sample.slack - spread)
                    low[which] = np.minimum(low[which], least)
                    if wide <= RESOLUTION and (least <= ROUNDING).any():
                        found.too_near(sample)
                is_open = low <= ROUNDING
                found.certain(low[~is_open])
                if is_open.any() and wide > RESOLUTION:
                    further.append(int(piece))
                    is_kept[pairs] &= is_open
            front = front.halves(level, np.array([*coarse, *further], int), is_kept)
        return found.answer()

    # --- a leg and what stands -------------------------------------------------------------------

    def around(self, a: Track, kind: Literal["scene", "self"]) -> Apart:
        """How near a leg comes to the scene, or to the arm itself; where it touches, how deep."""
        self._show(a.parts)
        a.begin()
        own = Own(a) if kind == "self" else None
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
            nearest = None if own is None else own.near(first, last, limit)
            found = self._backend.distances.pairs(kind, a.robot, limit, near=nearest)
            bound = best + ROUNDING
            is_open = False
            lowest = max(best, 0.0) + ROUNDING
            for gap in found:
                gap = self._as_led(gap, np.array([first, last]), a)
                allowed = gap.permitted(is_free=a.leg.kind == "ptp")
                slack = gap.distance if allowed is None else gap.distance + allowed
                spread = spread_of(gap.a, a, knots.spread[0])
                if kind == "self":
                    spread += spread_of(gap.b, a, knots.spread[0])
                spread += gap.short
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


def _turning(a: Track, b: Track) -> frozenset[str]:
    """The turntables, belts and other axes that move: what is on them touches no other robot, on whatever move."""
    return a.turning | b.turning


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
    a.begin()
    b.begin()
    begun, count = two.sweeper.queries, itertools.count()
    names = list(a.names), list(b.names)
    least = best.nearest
    heap = [(-math.inf, next(count), np.array([0.0, 1.0, 0.0, 1.0]))]
    while heap:
        low, number, own = heapq.heappop(heap)
        if low > much_less(best.nearest) or two.sweeper.queries - begun >= MOST_DEEPER:
            least = min(least, low)
            break
        one, other = a.knots(own[None, 0], own[None, 1]), b.knots(own[None, 2], own[None, 3])
        both = one.spread[0][:, None] + other.spread[0][None, :]
        gap_of = gaps(one, a.radii, other, b.radii)[0]
        bound = gap_of - both
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
            limit = wide + max(cut, 0.0) + 2.0 * ROUNDING
            for gap in two.measure(*joints, own, limit, near(gap_of, limit, *names)):
                allowed = gap.permitted(is_free=two.is_free)
                if allowed is not None and two.skipped is not None:
                    continue
                slack = gap.distance if allowed is None else gap.distance + allowed
                spread = spread_of(gap.a, a, one.spread[0]) + spread_of(gap.b, b, other.spread[0])
                spread += gap.short
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
    certain = -math.inf if is_unknown else min(least, best.nearest)
    return replace(best, least=certain, is_whole=True)


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
