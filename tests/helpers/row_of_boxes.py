"""A robot with a vacuum gripper beside a row of boxes, and what a run and a proof say of one of its lines."""

from __future__ import annotations

import math
import tomllib
from functools import partial
from pathlib import Path

import numpy as np

from helpers.stacking_cell import TOML
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.shown import Shown
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Command, MoveJoint, Pose
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import Led, LedContact, LedContacts
from pn2code.robot.monitor import Monitor, Verdict
from pn2code.robot.part import Part
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import inverse, matrix_of

TOP = 0.15
"""m: the height of a box."""


def cell_of(
    row: tuple[float, ...] = (1.4, 1.2, 1.0), way: float | None = None, **changes: object
) -> RobotCell:
    """Boxes at these places, on the floor; their `contact_way`; keys of the robot that are otherwise."""
    data = tomllib.loads(TOML)
    data["parts"]["box"]["size"] = [0.1, 0.1, TOP]
    data["parts"]["box"]["at"] = [{"x": x, "y": -1.1, "z": TOP / 2} for x in row]
    data["robots"]["robot"] |= changes
    if way is not None:
        data["parts"]["box"]["contact_way"] = way
    d = Diagnostics()
    found = load(data, Path(), lambda *_: Origin("cell.toml"), d)
    assert found is not None, [e.message for e in d.errors]
    return found


def pose(x: float, z: float) -> Pose:
    """Of a tool that looks down."""
    return Pose(x, -1.1, z, math.pi, 0.0, 0.0)


class Lines:
    """A cell, its boxes, and what is said of lines there. `holding`: the first box is in the tool."""

    def __init__(self, cell: RobotCell, *, holding: bool = False) -> None:
        self.cell = cell
        self.backend = BulletBackend(cell, looks=False)
        self.planner, self.parts = Planner(cell), Parts(cell)
        self._led, self._shown = LedContacts(cell), Shown(self.backend)
        self._comparison = Comparison(cell, self.planner, self._shown)
        self.held: tuple[Part, ...] = ()
        if holding:
            kind = cell.parts["box"]
            self.held = (Part("box.1", kind, inverse(matrix_of(kind.grips[0])), "robot"),)
            self.parts.present["box.1"] = self.held[0]

    def leg(self, first: Pose, command: Command) -> Leg:
        """A move from a pose."""
        leg = self.planner.leg(
            self.planner.leg(self.planner.home("robot"), MoveJoint(first)).end, command
        )
        assert leg.path is not None, leg.fault
        return leg

    def led_to(self, leg: Leg, at: float, contact: LedContact) -> Led:
        """What a line has to do with a contact, at a fraction of its way."""
        assert leg.path is not None
        ends = MoveEnds.of(self.cell.robot("robot"), "", leg.path)
        present = self.parts.present
        touching = present.get(contact.part), present.get(contact.other)
        homes = {r.name: np.array(r.home) for r in self.cell.moving}
        return self._led.of_move(contact, ends, touching, homes.__getitem__, (at, at))

    def seen(self, leg: Leg, *fractions: float) -> list[Verdict]:
        """What a run sees where the robot is on its line."""
        assert leg.path is not None
        for part in self.parts.present.values():
            self.backend.set_part(part)
        homes = {r.name: r.home for r in self.cell.moving}
        monitor = Monitor(self.cell, self.backend)
        found = [
            monitor.check(
                at,
                homes | {"robot": leg.path.on_way(np.array([at]))[0]},
                kinds={"robot": leg.kind},
                led_to=partial(self.led_to, leg, at),
            )
            for at in fractions
        ]
        for part in self.parts.present.values():
            self.backend.remove_part(part.name)
        return found

    def proved(self, leg: Leg, other: str = "") -> str:
        """What a proof says of the whole line and a box that stands, or the scene."""
        if not other:
            found = self._comparison.around(leg, self.held)[0].outcome
        else:
            found = self._comparison.beside((leg, self.held), self.parts.present[other]).outcome
        self._shown.show(())
        return found
