"""What plates (turntables, belts, lifts) take along when they move, and what of other activities that may touch."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import numpy as np

from pn2code.geometry.activity import Activity
from pn2code.geometry.contents import Contents, spot
from pn2code.geometry.legs import Leg
from pn2code.geometry.prisms import PartEvent, Prism, near, surface, swept, whole
from pn2code.robot.active_motion import turned_by
from pn2code.robot.belts import line_of
from pn2code.robot.ground import Ground
from pn2code.robot.part import Part
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array, inverse


class MovedPlates:
    """Those of a cell."""

    def __init__(self, cell: RobotCell) -> None:
        self._cell = cell

    def within(self, plate: str, where: tuple[Array, float], contents: Iterable[Contents]) -> bool:
        """Whether a place is so near to a turntable that it, or what stands on it, can come there when it moves."""
        point, far = where
        own = Ground.of(self._cell).plates[plate]
        some = {spot(p): p for c in contents for p in c.parts.present.values()}
        prisms = [*swept(own, (), whole(own)), *surface(own), *self._anywhere(plate, some.values())]
        return near([Prism.around(point[None], far)], prisms)

    def _anywhere(self, plate: str, some: Iterable[Part]) -> list[Prism]:
        """Where a plate, as far as it can move, takes what stands on it, or on the belts of its line."""
        ground = Ground.of(self._cell)
        own = ground.plates[plate]
        line = line_of(own.robot, own.axis)
        riders = []
        for part in some:
            if part.plate in line:
                to = inverse(own.T_world_axis) @ ground.plates[part.plate].T_world_axis
                riders.append(ground.corners_of(part.kind.name, to @ part.frame))
        if own.axis.belt is None or not riders:
            return swept(own, riders, whole(own))[-len(riders) :] if riders else []
        # Wherever on it, also from the beginning of a belt before it, and a little beyond its end.
        rows = np.vstack(riders)
        beyond = own.axis.upper + float(max(np.ptp(r[:, 0]) for r in riders))
        ends = [(min(0.0, float(rows[:, 0].min())), beyond)]
        ends += [(float(rows[:, i].min()), float(rows[:, i].max())) for i in (1, 2)]
        return swept(own, [np.array(list(itertools.product(*ends)))], (0.0, 0.0))

    def moves_first(self, a: Activity, plate: str) -> bool:
        """Whether an activity moves a plate before it does anything to parts."""
        for leg, contents in a.legs:
            if leg.path is None or contents is not a.legs[0][1]:
                return False
            if self.is_moved(leg, plate):
                return True
        return False

    def is_moved(self, leg: Leg, plate: str) -> bool:
        """Whether a leg moves a plate."""
        return leg.path is not None and plate in turned_by(self._cell.robot(leg.robot), leg.path)

    def does(self, plate: str) -> str:
        """What a plate does when it moves, for messages."""
        return Ground.of(self._cell).plates[plate].does

    def part_events_near(self, a: Activity, b: Activity) -> list[tuple[str, PartEvent]]:
        """What of one activity may depend on how far plates are that another one moves: the plate, and what."""
        out = []
        ground = Ground.of(self._cell)
        for plate in sorted(a.turns | a.may_run) if b.part_events else ():
            own = ground.plates[plate]
            index = own.robot.index(own.axis.name)
            # Each with the plate on its way, in the end where it stays, ...
            ways = [(c, _way(leg, index)) for leg, c in a.legs if leg.robot == own.robot.name]
            is_moved = any(way[0] != way[1] for _, way in ways)
            if is_moved and a.end is not None:
                last = float(a.end.q[index])
                ways.append((a.after, (last, last)))
            known: dict[str, Part] = {}
            riders: list[Prism] = []
            plates: list[Prism] = []
            for contents, way in ways:
                on = contents.parts.riders(plate)
                shapes = [ground.corners_of(p.kind.name, p.frame) for p in on]
                prisms = swept(own, shapes, way)
                plates += prisms[: len(prisms) - len(on)]
                riders += prisms[len(prisms) - len(on) :]
                known |= {spot(p): p for p in on}
            # ... and what others put there meanwhile, or what waits, anywhere.
            more = (*a.between, *b.between)
            some = {spot(p): p for c in more for p in c.parts.present.values()}
            if is_moved:
                some = {key: p for key, p in some.items() if key not in known and p.plate == plate}
            else:
                plates += swept(own, (), whole(own))
            riders += self._anywhere(plate, some.values())
            for event in b.part_events:
                prisms = [*riders, *plates, *(surface(own) if event.goes else ())]
                if near(event.prisms, prisms) or near(event.surfaces, riders):
                    out.append((plate, event))
        return out


def _way(leg: Leg, axis: int) -> tuple[float, float]:
    """From where to where an axis goes."""
    path = leg.path
    if path is None:
        return float(leg.start.q[axis]), float(leg.start.q[axis])
    return float(path.q(0.0)[axis]), float(path.q(path.duration)[axis])
