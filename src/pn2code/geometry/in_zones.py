"""Whether an arm on its way is in a zone where a sensor looks: surely, surely not, or now in it and now not.

    zones = InZones(cell)
    zones.answers("front", leg, load)       # frozenset({False}): nothing of it ever comes there

Links are the boxes that a run looks at (`robot.zones`). In a piece of the way a box is surely outside if it is further
away from the zone than any of its points can go in half of the piece, and surely inside if it reaches deeper into it.
"""

from __future__ import annotations

import numpy as np

from pn2code.geometry.contents import Load, spots
from pn2code.geometry.legs import Leg
from pn2code.geometry.pieces import ROUNDING
from pn2code.geometry.tracks import ArmShape, Link, Track
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array
from pn2code.robot.zones import ZoneWatch

_MOST_PIECES = 1000
_SHORTEST = 1e-5


class InZones:
    """Works it out once for each leg."""

    def __init__(self, cell: RobotCell) -> None:
        self._watch = ZoneWatch(cell)
        self._shapes: dict[str, ArmShape] = {}
        self._known: dict[tuple[str, int, str], frozenset[bool]] = {}

    def answers(self, zone: str, leg: Leg, load: Load) -> frozenset[bool]:
        """Whether something of an arm, or of what it may carry, is in the zone while it is on its way."""
        key = (zone, leg.number, spots(load))
        if key not in self._known:
            self._known[key] = self._looked(zone, leg, load)
        return self._known[key]

    def _looked(self, zone: str, leg: Leg, load: Load) -> frozenset[bool]:
        shape = self._shape(leg)
        carried = tuple(
            shape.holding(p, box.min(axis=0), box.max(axis=0))
            for p in load
            if (box := self._watch.part_box(p.kind.name)) is not None
        )
        if not shape.links and not carried:
            return frozenset({False})
        track = Track(shape, leg, tuple(_link(x.name, x.joint, x.corners) for x in carried))
        own = len(shape.links)
        edges = np.linspace(0.0, 1.0, 2 if track.is_still else 17)
        pieces = np.stack([edges[:-1], edges[1:]], axis=1)
        said: set[bool] = set()
        looked = 0
        while len(pieces) and len(said) < 2:
            looked += len(pieces)
            knots = track.knots(pieces[:, 0], pieces[:, 1])
            corners = track.boxes(knots.q)
            gaps = self._watch.gaps(zone, knots.ends[:, :, 0]) - track.radii
            rooms = knots.spread + ROUNDING
            further = []
            for i, (a, b) in enumerate(pieces.tolist()):
                room, offs = rooms[i], gaps[i]
                for j in np.flatnonzero(~(offs > room)):  # the ball around it is not surely outside
                    offs[j] = self._watch.off(zone, corners[i, j])
                if (offs > room).all():
                    said.add(False)
                elif (offs[:own] < -room[:own]).any():
                    said.add(True)
                elif track.is_still or looked > _MOST_PIECES or b - a < _SHORTEST:
                    said |= {False, True}
                else:
                    middle = (a + b) / 2.0
                    further += [(a, middle), (middle, b)]
            pieces = np.array(further).reshape(-1, 2)
        return frozenset({False, True} if track.trouble else said)

    def _shape(self, leg: Leg) -> ArmShape:
        if leg.robot not in self._shapes:
            links = tuple(_link(*box) for box in self._watch.boxes(leg.robot))
            self._shapes[leg.robot] = ArmShape(self._watch.cell.robot(leg.robot), links)
        return self._shapes[leg.robot]


def _link(name: str, joint: int, corners: Array) -> Link:
    """With a ball around it: capsules are not needed."""
    middle = corners.mean(axis=0)
    radius = float(np.linalg.norm(corners - middle, axis=1).max())
    return Link(name, joint, corners, np.stack([middle, middle]), radius)
