"""How close things are in PyBullet: robots to each other, to what stands, to themselves and what they carry."""

from __future__ import annotations

import fnmatch
from collections.abc import Collection, Container, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Any

from pn2code.base.frozen import frozen, record
from pn2code.robot.backend import Beside, Clearance, ClearanceKind, closest
from pn2code.robot.bullet_world import BulletWorld, LoadedBody, LoadedRobot
from pn2code.robot.led_contacts import LedContacts
from pn2code.robot.part import Part
from pn2code.robot.placed_links import tool_links
from pn2code.robot.robot_cell import PART_CONTACT, RobotCell

_FIRST_GUESS = 0.05  # m: searched first; most queries find their answer this near to the last one
_EACH = (
    10  # pairs of links that are measured one by one; of more, those of whole bodies take less time
)

Near = Collection[tuple[str, str]]
"""Pairs of names (of links, or of parts) that may be near to each other; all others certainly are not."""


@record
class Placed:
    """A part in PyBullet; one that is hidden is there no more, but can be shown again quickly."""

    part: Part
    id: int
    hidden: bool = False


@frozen
class Side:
    """One of two bodies between which something is measured.

    Args:
        robot: whose it is, "" if it stands.
        links: names by index, of a robot; indices: the same by name; whole: the name of a body without links.
        base: the robot whose base link it has, and `root` which it is; ignored_by: robots that stand on it.
        rides: the turntable of the robot on which it stands, a part that goes with it.
    """

    robot: str
    id: int
    links: dict[int, str]
    whole: str = ""
    base: str = ""
    ignored_by: tuple[str, ...] = ()
    root: int = -1
    rides: str = ""
    indices: Mapping[str, int] = field(default_factory=dict)

    @property
    def key(self) -> str:
        """Its name."""
        return self.whole or self.robot

    def link(self, index: int) -> str:
        """The name of a link."""
        return self.whole or self.links[index]

    def at(self, name: str) -> int | None:
        """The number of what has a name, -1 of a whole body; None: it is not of this side."""
        if self.whole:
            return -1 if name == self.whole else None
        return self.indices.get(name)


class BulletDistances:
    """Measures between the bodies of a cell where they are now.

    Args:
        robots: by name, all that move; scene: what stands; parts: by name, which the owner of this adds and removes.

    What was measured is kept until `moved` says that it may be so no more.
    """

    def __init__(
        self,
        world: BulletWorld,
        cell: RobotCell,
        robots: Mapping[str, LoadedRobot],
        scene: Sequence[LoadedBody],
        parts: Mapping[str, Placed],
    ) -> None:
        self._world, self._cell = world, cell
        self._robots, self._scene, self._parts = robots, scene, parts
        self._guess: dict[tuple[str, ...], float] = {}
        # What was measured since the robots concerned moved last: (kind, robots...) -> answer.
        self._known: dict[tuple[str, ...], list[Clearance]] = {}
        self._searched = 0.0
        self._arms: dict[str, Side] = {}
        self._rules: dict[tuple[str, str], float | None] = {}
        self.led = LedContacts(cell)
        self._plates = {f"{r.name}/{a.name}" for r in cell.robots for a in r.axes.tables}
        self._sunk: dict[tuple[str, str], float] = {}

    def stand_at_home(self) -> None:
        """The robots stand at HOME: how deep the bases of those on lifts may be in what they stand on from now on."""
        self._sunk = dict(self._depths_of_lifted())

    def moved(self, robot: str = "") -> None:
        """A robot, or anything ("") has moved."""
        if not robot:
            self._known = {}
        elif self._known:
            self._known = {k: v for k, v in self._known.items() if robot not in k}

    def clearances(self, limit: float) -> tuple[Clearance, ...] | None:
        """The closest pair of each kind and robot, and permitted contacts that overlap."""
        if limit != self._searched:
            self._known, self._searched = {}, limit
        out: list[Clearance] = []
        robots = list(self._robots.values())
        for i, a in enumerate(robots):
            me = a.robot.name
            for b in robots[i + 1 :]:
                key = ("robots", me, b.robot.name)
                if key not in self._known:
                    self._known[key] = self._robots_apart(a, b, limit)
                out += self._known[key]
            if ("scene", me) not in self._known:
                self._known["scene", me] = [
                    gap
                    for side in self._sides(a)
                    for other in self._standing()
                    for gap in self._between("scene", side, other, limit)
                ]
                self._known["self", me] = [
                    *self._self(a, limit),
                    *self._on_plates(a, limit),
                    *self._carried(a, limit),
                    *self._beside_riders(a, limit),
                ]
            out += self._known["scene", me] + self._known["self", me]
        return tuple(closest(out))

    def pairs(
        self,
        kind: ClearanceKind,
        robot: str,
        limit: float,
        other: str = "",
        only: Container[str] | None = None,
        near: Near | None = None,
    ) -> list[Clearance]:
        """The least distance of each two links, or link and thing, that are nearer than `limit` (m).

        Args:
            kind: to which things: of the robot `other`, of the scene (with the parts that stand), or its own.
            robot: of which the links are, with the part that it carries.
            only: of the scene, the things of these names.
            near: only these pairs can be nearer than `limit`, a link of `robot` first, of its own links and parts in
                both orders; None: nothing is known.
        """
        a = self._robots[robot]
        best: dict[tuple[str, str], Clearance] = {}
        if kind == "self":
            for gap in self._every_own(a, limit, near):
                _keep_nearest(best, gap)
            return list(best.values())
        others = self._standing() if kind == "scene" else self._sides(self._robots[other])
        for second in list(others):
            if only is not None and second.whole not in only:
                continue
            for first in self._sides(a):
                found = self._points(first, second, limit, near)
                skip_base = first.base != "" and first.base in second.ignored_by
                for c in found:
                    stands = skip_base and c[3] == first.root
                    one, two = first.link(c[3]), second.link(c[4])
                    allowed = self._permitted(first, second, one, two, stands=stands)
                    if stands and allowed is None:
                        continue
                    who = first.robot or robot
                    if kind == "scene" and first.rides:
                        allowed, stands = max(allowed or 0.0, PART_CONTACT), True
                    plates = self._near_plates((first, one), (second, two))
                    gap = Clearance(
                        kind,
                        who,
                        one,
                        two,
                        c[8],
                        allowed,
                        c[5],
                        c[6],
                        stands,
                        second.robot,
                        _robots_of(plates),
                        plates,
                    )
                    _keep_nearest(best, gap)
        return list(best.values())

    def around(self, name: str, limit: float) -> tuple[Beside, ...] | None:
        """How near a part is to each thing, part and turntable."""
        own = self._parts[name]
        out = []
        others = [(side.whole, side.id, -1) for side in self._standing()]
        for a in self._robots.values():
            others += [(side.whole, side.id, -1) for side in self._riding(a)]
            if not a.robot.is_device:  # what moves of devices is looked at with what moves
                others += [(f"{a.robot.name}/{t}", a.body, a.index[t]) for t in a.robot.arm.tables]
        for what, body, link in others:
            if body == own.id:
                continue
            found = self._world.points(own.id, body, limit, -1, link)
            if found:
                out.append(Beside(what, min(float(c[8]) for c in found)))
        return tuple(sorted(out, key=lambda b: b.distance))

    def _points(self, a: Side, b: Side, limit: float, near: Near | None) -> Sequence[Any]:
        """What is near between two bodies, as Bullet has it; of pairs in the order in which it goes through them."""
        if near is None:
            points: Sequence[Any] = self._world.points(a.id, b.id, limit)
            return points
        pairs = sorted(
            (i, j)
            for i, j in ((a.at(x), b.at(y)) for x, y in near)
            if i is not None and j is not None
        )
        if len(pairs) > _EACH:
            return self._points(a, b, limit, None)
        return [c for i, j in pairs for c in self._world.points(a.id, b.id, limit, i, j)]

    def _every_own(self, a: LoadedRobot, limit: float, near: Near | None) -> Iterator[Clearance]:
        name = a.robot.name
        for i, j in a.pairs:
            one, two = a.names[i], a.names[j]
            if near is not None and (one, two) not in near:
                continue
            for c in self._world.points(a.body, a.body, limit, i, j):
                yield Clearance("self", name, one, two, c[8], None, c[5], c[6])
        yield from self._on_plates(a, limit, near)
        yield from self._every_carried(a, limit, near)
        yield from self._beside_riders(a, limit, near)

    def _on_plates(
        self, a: LoadedRobot, limit: float, near: Near | None = None
    ) -> Iterator[Clearance]:
        """Between the turntables of a robot, with what is on them, and the rest of it; its tool may touch them."""
        for i, j in a.plates:
            one, two = a.names[i], a.names[j]
            if near is not None and (one, two) not in near:
                continue
            found = self._world.points(a.body, a.body, limit, i, j)
            for c in found:
                allowed = self.allowed(one, two)
                yield Clearance("self", a.robot.name, one, two, c[8], allowed, c[5], c[6])

    def _robots_apart(self, a: LoadedRobot, b: LoadedRobot, limit: float) -> list[Clearance]:
        """Between two robots, with what they carry."""
        return [
            gap
            for one in self._sides(a)
            for other in self._sides(b)
            for gap in self._between("robots", one, other, limit)
        ]

    def _riding(self, a: LoadedRobot) -> Iterator[Side]:
        """The parts that stand on turntables of a robot."""
        for part in self._parts.values():
            plate = part.part.plate
            if plate and part.part.carrier == a.robot.name:
                yield Side(a.robot.name, part.id, {}, part.part.name, rides=plate)

    def _beside_riders(
        self, a: LoadedRobot, limit: float, near: Near | None = None
    ) -> Iterator[Clearance]:
        """Between what stands on turntables of a robot and the rest of it: arm, part in its tool, other plates."""
        riders = list(self._riding(a))
        if not riders:
            return
        name = a.robot.name
        held = [side for side in self._sides(a) if not side.links and not side.rides]
        for rider in riders:
            own = rider.rides.partition("/")[2]
            others = [(f"{name}/{x}", a.body, i) for i, x in a.links.items() if x != own]
            others += [(side.whole, side.id, -1) for side in held]
            others += [(x.whole, x.id, -1) for x in riders if x.rides < rider.rides]
            for other, body, link in others:
                if near is not None and (other, rider.whole) not in near:
                    continue
                found = self._world.points(body, rider.id, limit, link, -1)
                if found:
                    c = min(found, key=lambda point: float(point[8]))
                    allowed = self.allowed(other, rider.whole)
                    yield Clearance("self", name, other, rider.whole, c[8], allowed, c[5], c[6])

    def _sides(self, a: LoadedRobot) -> Iterator[Side]:
        """A robot, the part that it carries, and those that stand on its turntables."""
        name = a.robot.name
        if name not in self._arms:
            indices = {link: i for i, link in a.names.items()}
            self._arms[name] = Side(name, a.body, a.names, "", name, root=a.root, indices=indices)
        yield self._arms[name]
        for part in self._parts.values():
            if part.part.holder == name:
                whole = f"{name}/{part.part.name}"
                yield Side(name, part.id, {}, whole)
        yield from self._riding(a)

    def _standing(self) -> Iterator[Side]:
        """What stands still: the scene, and parts that neither a tool nor a turntable carries."""
        for thing in self._scene:
            yield Side("", thing.id, {}, thing.body.name, ignored_by=thing.body.ignored_by)
        for part in self._parts.values():
            if not part.part.carrier and not part.hidden:
                yield Side("", part.id, {}, part.part.name)

    def _between(self, kind: ClearanceKind, a: Side, b: Side, limit: float) -> list[Clearance]:
        key = (kind, a.key, b.key)
        if kind == "scene" and a.rides:
            limit = min(
                limit, _FIRST_GUESS
            )  # it may touch: only that it does not too deeply counts
        reach = min(limit, self._guess.get(key, _FIRST_GUESS))
        skip_base = a.base != "" and a.base in b.ignored_by
        while True:
            found = self._world.points(a.id, b.id, reach)
            best: Clearance | None = None
            touching: dict[tuple[str, str], Clearance] = {}
            for c in found:
                stands = skip_base and c[3] == a.root
                name_a, name_b = a.link(c[3]), b.link(c[4])
                allowed = self._permitted(a, b, name_a, name_b, stands=stands)
                if stands and allowed is None:
                    continue
                if kind == "scene" and a.rides:
                    allowed, stands = max(allowed or 0.0, PART_CONTACT), True
                if allowed is not None:
                    old = touching.get((name_a, name_b))
                elif best is None or c[8] < best.distance:
                    best = Clearance(
                        kind, a.robot, name_a, name_b, c[8], None, c[5], c[6], second=b.robot
                    )
                    continue
                else:
                    continue
                if old is None or c[8] < old.distance:
                    plates = self._near_plates((a, name_a), (b, name_b))
                    item = Clearance(
                        kind, a.robot, name_a, name_b, c[8], allowed, c[5], c[6], stands, b.robot,
                        _robots_of(plates), plates,
                    )  # fmt: skip
                    touching[name_a, name_b] = item
            if best is not None or reach >= limit:
                break
            reach = min(limit, reach * 3.0)
        # The next question is about a moment later: search a little further than the last answer.
        near = limit if best is None else max(best.distance, 0.0)
        self._guess[key] = near + _FIRST_GUESS
        return [*touching.values(), best] if best is not None else list(touching.values())

    def _carried(self, a: LoadedRobot, limit: float) -> list[Clearance]:
        """Of what is carried and the links of its robot the nearest, and all that it may touch."""
        found = list(self._every_carried(a, limit))
        apart = [gap for gap in found if gap.allowed is None]
        nearest = min(apart, key=lambda gap: gap.distance, default=None)
        touching = [gap for gap in found if gap.allowed is not None]
        return touching if nearest is None else [nearest, *touching]

    def _every_carried(
        self, a: LoadedRobot, limit: float, near: Near | None = None
    ) -> Iterator[Clearance]:
        """Between what a robot carries (parts, a tool) and the robot itself, but for its tool and the last axis.

        On a turntable it may be put. How far a link may still come differs from one to the other: who looks between
        instants needs them all.
        """
        name = a.robot.name
        if a.robot.is_device:
            return
        last = a.joints[a.robot.kinematics.joints.stop - 1]
        tables = {a.index[t] for t in a.robot.arm.tables}
        of_tool = tool_links(a.robot)
        own = {i for i, link in a.links.items() if link in of_tool or i >= last} - tables
        for side in self._sides(a):
            for i in a.links if not side.links and not side.rides else ():
                other = a.names[i]
                if i in own or (near is not None and (side.whole, other) not in near):
                    continue
                allowed = self.allowed(side.whole, other) if i in tables else None
                for c in self._world.points(side.id, a.body, limit, -1, i):
                    yield Clearance("self", name, side.whole, other, c[8], allowed, c[5], c[6])

    def _self(self, a: LoadedRobot, limit: float) -> list[Clearance]:
        key = ("self", a.robot.name)
        reach = min(limit, self._guess.get(key, _FIRST_GUESS))
        best: Clearance | None = None
        while True:
            # Pair by pair: asked about the whole body, Bullet measures all neighbours' overlaps too.
            for i, j in a.pairs:
                found = self._world.points(a.body, a.body, reach, i, j)
                for c in found:
                    if best is None or c[8] < best.distance:
                        one, two = (f"{a.robot.name}/{a.links[k]}" for k in (i, j))
                        best = Clearance("self", a.robot.name, one, two, c[8], None, c[5], c[6])
                        reach = min(reach, max(c[8], 1e-3))
            if best is not None or reach >= limit:
                break
            reach = min(limit, reach * 3.0)
        self._guess[key] = limit if best is None else max(best.distance, 0.0) + _FIRST_GUESS
        return [] if best is None else [best]

    def _near_plates(self, *near: tuple[Side, str]) -> tuple[str, ...]:
        """The turntables of which one, or what stands on it, is near, and not the rest of its robot."""
        return tuple(
            side.rides or name for side, name in near if side.rides or name in self._plates
        )

    def _permitted(self, a: Side, b: Side, one: str, two: str, *, stands: bool) -> float | None:
        """The same of two sides; of what stands on the other one, None: it is not tested."""
        return self._sunk.get((a.base, b.whole)) if stands else self.allowed(one, two)

    def allowed(self, a: str, b: str) -> float | None:
        """How deep two parts may overlap; None: they must keep apart."""
        if (a, b) not in self._rules:
            depths = [
                rule.depth
                for rule in self._cell.scene.contacts
                if (fnmatch.fnmatchcase(a, rule.a) and fnmatch.fnmatchcase(b, rule.b))
                or (fnmatch.fnmatchcase(b, rule.a) and fnmatch.fnmatchcase(a, rule.b))
            ]
            self._rules[a, b] = max(depths, default=None)
        return self._rules[a, b]

    def _depths_of_lifted(self) -> Iterator[tuple[tuple[str, str], float]]:
        """How deep the base link of an arm on a lift may be in what it stands on: so deep as it is at HOME, and a bit.

        By robot and thing. The base of any other arm keeps its height, and is not tested against what it stands on.
        """
        for a in self._robots.values():
            robot = a.robot
            up = [robot.T_world_base[:3, :3] @ track.direction for track in robot.axes.tracks]
            if not any(abs(float(direction[2])) > 1e-9 for direction in up):
                continue
            for side in self._standing():
                if robot.name in side.ignored_by:
                    found = self._world.points(a.body, side.id, 0.0, a.root)
                    deepest = min((float(c[8]) for c in found), default=0.0)
                    yield (robot.name, side.whole), PART_CONTACT - min(deepest, 0.0)


def _robots_of(plates: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(p.partition("/")[0] for p in plates)


def _keep_nearest(best: dict[tuple[str, str], Clearance], gap: Clearance) -> None:
    old = best.get((gap.a, gap.b))
    if old is None or gap.distance < old.distance:
        best[gap.a, gap.b] = gap
