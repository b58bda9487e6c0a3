"""What sensors that see the scene say on a random walk: as it is at that moment.

eyes = Eyes(graph, cell)
eyes.first(element)                                 # whether it asks before its commands
eyes.as_seen(state, element, joints, parts)         # the element with what its sensors say now
"""

from __future__ import annotations

import numpy as np

from pn2code.geometry.graph import CellGraph
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.zones import ZoneWatch


class Eyes:
    """They know nothing of what `geometry.seeing` works out."""

    def __init__(self, graph: CellGraph, cell: RobotCell) -> None:
        self.graph, self.cell = graph, cell
        self.zones = ZoneWatch(cell)
        config = graph.partition.config
        self.sensors = {s.variable: s for s in (config.sensors if config else ()) if s.sees}

    def _asked(self, element: int) -> set[str]:
        e = self.graph.elements[element]
        return set() if e.is_step else self.sensors.keys() & e.binding.keys()

    def first(self, element: int) -> bool:
        """Whether the commands of a transition depend on what a sensor says."""
        e = self.graph.elements[element]
        if not self._asked(element):
            return False
        code = self.graph.partition.net.transitions[e.transition].code
        return code is not None and any(s.name in self.sensors for s in code.inputs)

    def as_seen(
        self, state: int, element: int, joints: dict[str, np.ndarray], parts: Parts
    ) -> tuple[int, int]:
        """The element of the same transition with what is so now, and where it leads."""
        asked = self._asked(element)
        if not asked:
            return next((e, to) for e, to in self.graph.arcs[state] if e == element)
        own = self.graph.elements[element]
        wanted = {**own.binding, **{v: self._says(v, joints, parts) for v in asked}}
        return next(
            (e, to)
            for e, to in self.graph.arcs[state]
            if self.graph.elements[e].transition == own.transition
            and self.graph.elements[e].binding == wanted
        )

    def _says(self, variable: str, joints: dict[str, np.ndarray], parts: Parts) -> bool:
        sensor = self.sensors[variable]
        device, dot, axis = sensor.sees.partition(".")
        if dot:
            return self.cell.robot(device).is_at(axis, joints[device], sensor.at)
        if sensor.sees in self.cell.zones:
            return self.zones.occupied(sensor.sees, joints, parts.present.values())
        return parts.is_seen(sensor.sees, sensor.part)
