"""Sweeps what situations show: each leg against the scene, legs of two arms against each other, legs and parts.

    compared = Comparison(cell, planner, Shown(backend))
    compared.around(leg, load)                   # Apart, from the scene and from itself
    apart = compared.two((leg, load), (other, load))
    compared.deepest(apart)                      # where they touch, how deep

Everything is swept once, in whatever situations it occurs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import TypeVar, cast

import numpy as np

from pn2code.base.conditioning import MOST_CONDITION
from pn2code.base.frozen import frozen
from pn2code.geometry.activity import Activity
from pn2code.geometry.ahead import Ahead
from pn2code.geometry.answers import Nearest, Verdict
from pn2code.geometry.apart import Apart
from pn2code.geometry.contents import Contents, Load, spot, spots
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.level import level
from pn2code.geometry.part_names import gap_as_seen, held, on_plate, standing, told
from pn2code.geometry.shown import Shown
from pn2code.geometry.sweeps import SEARCHED, Sweeper, much_less
from pn2code.geometry.tracks import ArmShape, Track
from pn2code.geometry.zone_speeds import slow_enough
from pn2code.robot.active_motion import turned_by
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.backend import Clearance
from pn2code.robot.clamps import holding, taken_along
from pn2code.robot.part import Part
from pn2code.robot.riders import riding
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import Array
from pn2code.robot.zones import ZoneWatch

Key = tuple[int, str]
"""A leg, by its number, and what is moved with it."""
_Found = TypeVar("_Found")
_PIECES = 16
_SAMPLES = 65
_MOST_NEAREST = 2000
"""Distances that are measured only to say how near arms come."""


@frozen(eq=False)
class Margins:
    """Along a leg: rad from the nearest limit, of which axis; the worst condition number."""

    limit: float
    axis: int
    condition: float


class Comparison:
    """Keeps what has been swept."""

    def __init__(self, cell: RobotCell, planner: Planner, shown: Shown) -> None:
        backend = shown.backend
        self.cell, self._planner, self._backend = cell, planner, backend
        self.sweeper = Sweeper(shown)
        self._shapes = {r.name: ArmShape.of(r, backend) for r in cell.moving}
        self._boxes = {k.name: backend.part_box(k) for k in cell.kinds}
        self._tracks: dict[tuple[int, str], Track] = {}
        self._extents: dict[tuple[int, str], tuple[Array, Array]] = {}
        self._around: dict[tuple[int, str], tuple[Apart, Apart]] = {}
        self._pairs: dict[tuple[tuple[int, str], tuple[int, str]], Apart] = {}
        self._beside: dict[tuple[tuple[int, str], str], Apart] = {}
        self._deeper: dict[Apart, Callable[[], Apart]] = {}
        self._margins: dict[int, Margins] = {}
        self._ahead: Ahead[tuple[object, int]] | None = None
        self._number: dict[object, int] = {}
        self.compared = 0
        self._watch = ZoneWatch(cell)
        self._tilts: dict[tuple[int, str], tuple[Verdict, str]] = {}
        self._hurries: dict[tuple[int, str], tuple[Verdict, str]] = {}

    def _track(self, leg: Leg, load: Load) -> tuple[tuple[int, str], Track]:
        if leg.path is None:
            leg = self._planner.standing(leg.start)
        key = (leg.number, spots(load))
        if key not in self._tracks:
            shape = self._shapes[leg.robot]
            # Names for the collision library that no other part has that is shown at the same time.
            named = tuple(
                replace(
                    p, name=held(p.name, leg.robot) if p.holder else on_plate(p.name, p.plate, i)
                )
                for i, p in enumerate(load, 1)
            )
            links = tuple(shape.holding(p, *self._boxes[p.kind.name]) for p in named)
            self._tracks[key] = Track(shape, leg, links, named)
        return key, self._tracks[key]

    def hurries(self, leg: Leg, load: Load) -> tuple[Verdict, str]:
        """Whether a leg is slow enough in zones, and why it is not."""
        if not self._watch.limited or not leg.is_moving or not self._has_shape((leg, load)):
            return "yes", ""
        key, track = self._track(leg, load)
        if key not in self._hurries:
            self._hurries[key] = slow_enough(self._watch, track, load)
        return self._hurries[key]

    def tilts(self, leg: Leg, load: Load) -> tuple[Verdict, str]:
        """Whether what stands on a part that is carried stays there, and why it does not."""
        riders = tuple(riding(load, leg.robot))
        key = (leg.number, spots(riders))
        if not riders or not leg.is_moving:
            return "yes", ""
        if key not in self._tilts:
            self._tilts[key] = level(self.cell.robot(leg.robot), leg, riders)
        return self._tilts[key]

    def _has_shape(self, moved: tuple[Leg, Load]) -> bool:
        """Whether anything moves: of a device with a belt only what stands on it."""
        leg, load = moved
        return bool(self._shapes[leg.robot].links or load)

    def _extent(self, key: tuple[int, str]) -> tuple[Array, Array]:
        """The corners of a box around all that an arm sweeps on a leg."""
        if key not in self._extents:
            track = self._tracks[key]
            count = 1 if track.is_still else _PIECES
            edges = np.linspace(0.0, 1.0, count + 1)
            knots = track.knots(edges[:-1], edges[1:])
            off = (knots.spread + track.radii)[..., None, None]
            low = (knots.ends - off).min(axis=(0, 1, 2))
            high = (knots.ends + off).max(axis=(0, 1, 2))
            if knots.lost.any():
                low, high = np.full((2, 3), np.inf) * [[-1.0], [1.0]]
            self._extents[key] = (low, high)
        return self._extents[key]

    def _boxes_off(self, one: Key, other: Key) -> Array:
        """How far the boxes around two legs are apart, in each direction."""
        (low, high), (from_, to) = self._extent(one), self._extent(other)
        return np.maximum(np.maximum(low - to, from_ - high), 0.0)

    def two(self, a: tuple[Leg, Load], b: tuple[Leg, Load]) -> Apart:
        """Two legs of two arms."""
        if not (self._has_shape(a) and self._has_shape(b)):
            return Apart("clear", math.inf, math.inf)
        (one, first), (other, second) = self._track(*a), self._track(*b)
        if (one, other) not in self._pairs:
            self.compared += 1
            off = self._boxes_off(one, other)
            if off.any():
                self._pairs[one, other] = Apart("clear", float(np.linalg.norm(off)), math.inf)
            else:
                sweep = partial(self.sweeper.apart, first, second)
                found = self._pairs[one, other] = self._swept((one, other), sweep)
                if found.outcome == "touch":
                    self._deeper[found] = partial(self.sweeper.deepest, first, second, found)
        return self._pairs[one, other]

    def deepest(self, apart: Apart) -> Apart:
        """Two that were found to touch, with their deepest overlap; what else was found stays as it is."""
        search = self._deeper.get(apart)
        return search() if search is not None else apart

    def nearest(self) -> Nearest | None:
        """How near arms come that keep apart; None: no two do."""
        clear = {key: x for key, x in self._pairs.items() if x.outcome == "clear"}
        best = min((x.nearest for x in clear.values()), default=math.inf)
        where = next((x.where for x in clear.values() if x.nearest == best), None)
        best = min(best, SEARCHED)
        begun = self.sweeper.queries
        certain = SEARCHED
        for one, other in sorted(clear, key=lambda key: clear[key].least):
            least = clear[one, other].least
            if least < much_less(best) and self.sweeper.queries - begun < _MOST_NEAREST:
                found = self.sweeper.nearest(self._tracks[one], self._tracks[other], best)
                least = max(least, found.least)
                if found.nearest < best:
                    best, where = found.nearest, found.where
            certain = min(certain, least)
        if not clear:
            return None
        between = f"{told(where.a)} and {told(where.b)}" if where else ""
        return Nearest(gap_as_seen(where), min(certain, best), between)

    def activities(self, a: Activity, b: Activity) -> Iterator[tuple[Leg, Leg, Apart]]:
        """Each leg of one with each of the other, since nobody knows how far they are."""
        for (leg, contents), (other, more), loads in _legs_of(a, b):
            pulled = self._pulled(leg, contents, other) or self._pulled(other, more, leg)
            if pulled is not None:
                yield leg, other, pulled
            yield leg, other, self.two((leg, loads[0]), (other, loads[1]))

    # --- with other processes --------------------------------------------------------------------

    @contextmanager
    def moves_ahead(self, moves: Iterable[tuple[Leg, Load]], jobs: int) -> Iterator[None]:
        """While legs are asked how they keep apart from the scene and themselves, in about this order."""
        tasks: dict[object, Callable[[], object]] = {}
        for leg, load in moves if jobs > 1 else ():
            if leg.fault is None and self._has_shape((leg, load)):
                key, track = self._track(leg, load)
                if key not in self._around:
                    tasks[key] = partial(self._sweep_around, track)
        with self._ahead_of(tasks, jobs, lambda _key: True):
            yield

    @contextmanager
    def pairs_ahead(
        self,
        pairs: Iterable[tuple[Activity, Activity]],
        jobs: int,
        wanted: Callable[[int], bool],
    ) -> Iterator[None]:
        """While activities are asked how they keep apart, in about this order; `wanted`: whether one is, by place."""
        tasks: dict[object, Callable[[], object]] = {}
        users: dict[object, list[int]] = {}
        for i, (a, b) in enumerate(pairs if jobs > 1 else ()):
            for (leg, _), (other, _), loads in _legs_of(a, b):
                moved = (leg, loads[0]), (other, loads[1])
                if not all(map(self._has_shape, moved)):
                    continue
                (one, first), (two, second) = (self._track(*x) for x in moved)
                if (one, two) not in self._pairs and not self._boxes_off(one, two).any():
                    tasks[one, two] = partial(self.sweeper.apart, first, second)
                    users.setdefault((one, two), []).append(i)
        with self._ahead_of(tasks, jobs, lambda key: any(map(wanted, users[key]))):
            yield

    @contextmanager
    def _ahead_of(
        self,
        tasks: Mapping[object, Callable[[], object]],
        jobs: int,
        wanted: Callable[[object], bool],
    ) -> Iterator[None]:
        keys = list(tasks)
        counted = [partial(self._counted, sweep) for sweep in tasks.values()]
        self._number = {key: i for i, key in enumerate(keys)}
        try:
            with Ahead(counted, jobs, lambda i: wanted(keys[i])) as self._ahead:
                yield
        finally:
            self._ahead = None

    def _counted(self, sweep: Callable[[], _Found]) -> tuple[_Found, int]:
        """With the distances that were measured."""
        before = self.sweeper.queries
        found = sweep()
        asked = self.sweeper.queries - before
        self.sweeper.queries = before
        return found, asked

    def _swept(self, key: object, sweep: Callable[[], _Found]) -> _Found:
        """What a sweep comes to, which somebody else may have done."""
        if self._ahead is None or key not in self._number:
            return sweep()
        found, asked = self._ahead.take(self._number[key])
        self.sweeper.queries += asked
        return cast(_Found, found)

    def _pulled(self, leg: Leg, contents: Contents, other: Leg) -> Apart | None:
        """That something goes away with a part which a clamp of a device holds then; None: it does not."""
        robot, device = self.cell.robot(leg.robot), self.cell.robot(other.robot)
        load = contents.load(leg.robot)
        if not load or not device.axes.clamps or not leg.is_moving or leg.path is None:
            return None
        path = other.path if other.path is not None else self._planner.standing(other.start).path
        assert path is not None
        for part, frame in taken_along(robot, leg.start.q, load, turned_by(robot, leg.path)):
            for clamped in holding(self.cell, part.kind, frame):
                # The way of a clamp is straight, so it is narrowest at one of its ends.
                ends = path.on_way(np.array([0.0, 1.0]))
                q = min(ends, key=clamped.gap)
                if clamped.device is device and clamped.holds(q):
                    x, y, z = frame[:3, 3].tolist()
                    names = f"{leg.robot}/{part.name}", clamped.name
                    gap = Clearance("robots", leg.robot, *names, 0.0, None, (x, y, z), (x, y, z))
                    why = clamped.words(leg.robot, part.name, q)
                    return Apart("touch", 0.0, 0.0, gap, (0.0, 0.0), why, (leg.start.q, q))
        return None

    def beside(self, a: tuple[Leg, Load], part: Part) -> Apart:
        """A leg and a part that stands."""
        if not self._has_shape(a):
            return Apart("clear", math.inf, math.inf)
        key, track = self._track(*a)
        where = (key, spot(part))
        if where not in self._beside:
            self.compared += 1
            shown = replace(part, name=standing(part.name))
            box = self._boxes[part.kind.name]
            found = self._beside[where] = self.sweeper.beside(track, shown, box)
            if found.outcome == "touch":
                search = partial(self.sweeper.deepest_beside, track, shown, box, found)
                self._deeper[found] = search
        return self._beside[where]

    def around(self, leg: Leg, load: Load) -> tuple[Apart, Apart]:
        """A leg and the scene; a leg and the arm itself."""
        if not self._has_shape((leg, load)):
            return Apart("clear", math.inf, math.inf), Apart("clear", math.inf, math.inf)
        key, track = self._track(leg, load)
        if key not in self._around:
            self._around[key] = self._swept(key, partial(self._sweep_around, track))
        return self._around[key]

    def _sweep_around(self, track: Track) -> tuple[Apart, Apart]:
        return self.sweeper.around(track, "scene"), self.sweeper.around(track, "self")

    def margins(self, leg: Leg) -> Margins:
        """Limits and conditioning along a leg."""
        if leg.number not in self._margins:
            self._margins[leg.number] = self._worst(leg)
        return self._margins[leg.number]

    def _worst(self, leg: Leg) -> Margins:
        assert leg.path is not None
        if self.cell.robot(leg.robot).is_device:
            return Margins(math.inf, 0, 1.0)
        kinematics = self.cell.robot(leg.robot).kinematics
        q = leg.path.on_way(np.linspace(0.0, 1.0, _SAMPLES if leg.is_moving else 1))
        if isinstance(leg.path, LinearTrajectory | AlongTrajectory):
            q = np.vstack([q, leg.path.grid])
        off = kinematics.turning_margins(q).min(axis=0)
        axis = int(np.argmin(off))
        worst = max(c.condition for c in kinematics.conditioning_many(q))
        return Margins(float(off[axis]), axis, worst if worst <= MOST_CONDITION else math.inf)


def _legs_of(
    a: Activity, b: Activity
) -> Iterator[tuple[tuple[Leg, Contents], tuple[Leg, Contents], tuple[Load, Load]]]:
    """Each leg of one with each of the other, and what both move."""
    for leg, contents in a.legs:
        for other, more in b.legs:
            own = _meanwhile(contents.load(leg.robot), leg.robot, b, more)
            its = _meanwhile(more.load(other.robot), other.robot, a, contents)
            yield (leg, contents), (other, more), (own, its)


def _meanwhile(load: Load, robot: str, other: Activity, contents: Contents) -> Load:
    """What a robot moves while another one has put something on its turntables, or has taken something from there."""
    before = {spot(p): p for p in other.legs[0][1].load(robot) if p.plate}
    now = {spot(p): p for p in contents.load(robot) if p.plate}
    if before.keys() == now.keys():
        return load
    kept = {spot(p): p for p in load if p.holder or spot(p) in now or spot(p) not in before}
    kept |= {key: part for key, part in now.items() if key not in before}
    return tuple(kept[key] for key in sorted(kept))
