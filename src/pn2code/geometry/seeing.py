"""What sensors that see the scene can say in a situation, of which nobody knows how far what is under way is.

    seeing = Seeing(graph, doing)
    seeing.asked(element)                   # (Asked("eye", True, first=False),)
    seeing.says("eye", Scene(stands, contents, handles, others))    # frozenset({True}): it can say nothing else

What is said is what a run says (`Engine._sees`): whether a part stands at a place, an arm is in a zone, an axis is
where it is seen. Where that depends on how far somebody else is, or on less than the rounding of numbers, both are
possible. A script asks after the commands of a transition, when that occurs, unless the commands depend on the answer:
then before them (`first`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.cell.config import SensorConfig
from pn2code.geometry.activities import Doing
from pn2code.geometry.activity import Activity
from pn2code.geometry.contents import Contents, Load, parts_of, spot
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.in_zones import InZones
from pn2code.geometry.legs import Leg, Stand
from pn2code.geometry.pieces import ROUNDING
from pn2code.net.flat import BindAll, BindRandom, FlatTransition
from pn2code.robot.part import Part
from pn2code.robot.transforms import Array, matrix_of

Answers = frozenset[bool]
BOTH: Answers = frozenset({False, True})
_ONLY = {value: frozenset({value}) for value in (False, True)}
_SAME = 1e-6
"""m or degrees: by so much what a run computes may be off."""


@frozen
class Asked:
    """A sensor that an element has asked, and what it said.

    Args:
        first: it was asked before the commands, not after them.
    """

    sensor: str
    value: bool
    first: bool


@frozen(eq=False)
class Scene:
    """What is there when somebody asks.

    Args:
        stands: where each arm stands, or has stood when what is under way began; who asks has ended what it does.
        contents: the parts, with all that who asks has done.
        handles: whether that was anything.
        others: what is under way of all others.
    """

    stands: tuple[Stand, ...]
    contents: Contents
    handles: bool
    others: tuple[Activity, ...]


class Seeing:
    """The sensors of a cell that see the scene."""

    def __init__(self, graph: CellGraph, doing: Doing) -> None:
        self._graph, self._doing = graph, doing
        self._cell = doing.start.parts.cell
        config = graph.partition.config
        self._sensors = {s.name: s for s in (config.sensors if config else ()) if s.sees}
        by_variable = {s.variable: s.name for s in self._sensors.values()}
        self._of: dict[int, tuple[tuple[str, str, bool], ...]] = {}
        for t in graph.partition.net.transitions:
            if graph.partition.transition_owner[t.index] > 0:
                found = tuple(_open(t, by_variable))
                if found:
                    self._of[t.index] = found
        self._zones = InZones(self._cell)
        self._said: dict[tuple[object, ...], Answers] = {}

    def __bool__(self) -> bool:
        """Whether anybody asks any of them."""
        return bool(self._of)

    def asked(self, element: int) -> tuple[Asked, ...]:
        """The sensors that an element has asked, with what they have said."""
        e = self._graph.elements[element]
        if e.is_step:
            return ()
        return tuple(
            Asked(sensor, e.binding[variable], first)
            for variable, sensor, first in self._of.get(e.transition, ())
            if isinstance(e.binding.get(variable), bool)
        )

    def says(self, sensor: str, scene: Scene) -> Answers:
        """What a sensor can say."""
        key = (
            sensor,
            tuple(s.number for s in scene.stands),
            scene.contents.number,
            scene.handles,
            tuple(a.number for a in scene.others),
        )
        if key not in self._said:
            self._said[key] = self._looked(self._sensors[sensor], scene)
        return self._said[key]

    def _looked(self, sensor: SensorConfig, scene: Scene) -> Answers:
        device, dot, axis = sensor.sees.partition(".")
        if dot:
            return self._axis(device, axis, sensor.at, scene)
        if sensor.sees in self._cell.zones:
            return self._zone(sensor.sees, scene)
        return self._part(sensor, scene)

    # --- parts -----------------------------------------------------------------------------------

    def _part(self, sensor: SensorConfig, scene: Scene) -> Answers:
        now = self._seen(sensor, scene.contents, scene)
        matters = [a for a in scene.others if self._matters(sensor, a, scene)]
        if not matters:
            return now
        if len(matters) > 1 or scene.handles or self._plates_near(sensor, matters[0], scene):
            return BOTH
        return now.union(*(self._seen(sensor, c, scene) for c in matters[0].between))

    def _seen(self, sensor: SensorConfig, contents: Contents, scene: Scene) -> Answers:
        offs = list(self._offs(sensor, contents.parts.present.values(), contents, scene))
        if any(off <= -ROUNDING for off in offs):
            return _ONLY[True]
        return BOTH if any(off <= ROUNDING for off in offs) else _ONLY[False]

    def _offs(
        self, sensor: SensorConfig, some: Iterable[Part], contents: Contents, scene: Scene
    ) -> Iterator[float]:
        """How much further from the place each part is than is seen (m); of those that stand, of the kind."""
        place = self._place(sensor)
        parts = parts_of(contents, scene.stands, 0.0)
        for part in some:
            if not part.holder and not part.is_tool and sensor.part in ("", part.kind.name):
                apart = float(np.linalg.norm(parts.world(part)[:3, 3] - place))
                yield apart - part.kind.tolerance

    def _place(self, sensor: SensorConfig) -> Array:
        return matrix_of(self._cell.places[sensor.sees])[:3, 3]

    def _matters(self, sensor: SensorConfig, other: Activity, scene: Scene) -> bool:
        """Whether what is seen may depend on how far somebody else is."""
        if self._plates_near(sensor, other, scene):
            return True
        all_ = other.between
        spots = [{spot(p): p for p in c.parts.present.values()} for c in all_]
        for contents, own in zip(all_, spots, strict=True):
            changed = [p for key, p in own.items() if any(key not in x for x in spots)]
            if any(off <= ROUNDING for off in self._offs(sensor, changed, contents, scene)):
                return True
        return False

    def _plates_near(self, sensor: SensorConfig, other: Activity, scene: Scene) -> bool:
        """Whether a turntable or a belt may turn that takes parts along to where is looked, or from there."""
        plates = other.turns | other.may_run
        if not plates:
            return False
        around = max((k.tolerance for k in self._cell.parts.values()), default=0.0) + ROUNDING
        where = (self._place(sensor), around)
        contents = (scene.contents, *other.between)
        return any(self._doing.plates.within(plate, where, contents) for plate in plates)

    # --- zones and axes --------------------------------------------------------------------------

    def _legs(self, robot: str, scene: Scene) -> list[Leg]:
        """All that a robot or device may be doing."""
        found = [leg for a in scene.others for leg, _ in a.legs if leg.robot == robot]
        stands = [] if found else [s for s in scene.stands if s.robot == robot]
        planner = self._doing.planner
        return [leg if leg.path is not None else planner.standing(leg.start) for leg in found] or [
            planner.standing(s) for s in stands
        ]

    def _zone(self, zone: str, scene: Scene) -> Answers:
        said: set[bool] = {False}
        for robot in self._cell.robots:
            load = self._carried(robot.name, scene)
            each = [self._zones.answers(zone, leg, load) for leg in self._legs(robot.name, scene)]
            if each and all(x == _ONLY[True] for x in each):
                return _ONLY[True]
            if any(True in x for x in each):
                said.add(True)
        return frozenset(said)

    def _carried(self, robot: str, scene: Scene) -> Load:
        """All that a robot may carry in its tool and on its turntables."""
        some = [scene.contents]
        for a in scene.others:
            some += a.between
        return tuple({spot(p): p for c in some for p in c.load(robot)}.values())

    def _axis(self, device: str, axis: str, at: float, scene: Scene) -> Answers:
        robot = self._cell.robot(device)
        own = robot.axes.axis(axis)
        assert own is not None, "the cell has been checked"
        moved = [robot.index(name) for name, _ in robot.axes.moved(axis, at)]
        within = 0.001 if own.is_track else 0.1
        said: set[bool] = set()
        for leg in self._legs(device, scene):
            assert leg.path is not None
            # Axes of devices go straight, so this one is nowhere but between its ends.
            ends = leg.path.on_way(np.array([0.0, 1.0]))[:, moved].sum(axis=1)
            low, high = sorted((ends if own.is_track else np.degrees(ends)).tolist())
            if low - within - _SAME <= at <= high + within + _SAME:
                said.add(True)
            if max(high - at, at - low) > within - _SAME:
                said.add(False)
        return frozenset(said) or BOTH


def _open(t: FlatTransition, by_variable: dict[str, str]) -> Iterator[tuple[str, str, bool]]:
    """The variables of a transition that a sensor decides which sees the scene: with it, and whether it is asked first.

    As `robot_scripts.code_segment` makes scripts.
    """
    tried = [s.symbol for s in t.plan if isinstance(s, BindAll | BindRandom)]
    sensed = [s for s in tried if s.name in by_variable]
    is_first = t.code is not None and any(s in t.code.inputs for s in tried)
    for symbol in sensed:
        yield symbol.name, by_variable[symbol.name], is_first
