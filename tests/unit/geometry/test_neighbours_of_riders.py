"""What rides on a belt that runs must keep apart from what stands beside it."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from helpers.belt_cell import TOML
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.shown import Shown
from pn2code.robot.active_motion import turned
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Along, MoveExternal
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import Led, LedContact, LedContacts
from pn2code.robot.monitor import Monitor
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import Array

RUN = MoveExternal(along=(Along("belt", 0.6, is_track=True),))
BY = 5e-4
"""m: so deep what rides is in what stands: less than what stands on something may be."""


def cell_of(off: float, **rule: object) -> RobotCell:
    """A rail, and a box on a shelf, beside the belt, so far from the box that rides past both."""
    data = tomllib.loads(TOML)
    side = 1.72 + off
    data["scene"] = {
        "objects": [
            {"name": "rail", "size": [0.1, 0.2, 0.2], "pose": {"x": side + 0.05, "y": -1.25, "z": 0.6}},
            {"name": "shelf", "size": [0.2, 0.2, 0.5], "pose": {"x": side + 0.1, "y": -0.9, "z": 0.25}},
        ],
        "contacts": [rule] if rule else [],
    }  # fmt: skip
    data["parts"]["box"]["at"] = [
        {"x": 1.62, "y": -1.5, "z": 0.575},
        {"x": side + 0.1, "y": -0.9, "z": 0.575},
    ]
    d = Diagnostics()
    found = load(data, Path(), lambda *_: Origin("cell.toml"), d)
    assert found is not None, [e.message for e in d.errors]
    return found


def proved(cell: RobotCell, backend: BulletBackend, leg: Leg) -> tuple[str, str]:
    """Of the rail, and of the box on the shelf."""
    parts = Parts(cell).present
    comparison = Comparison(cell, Planner(cell), Shown(backend))
    rides = (parts["box.1"],)
    return comparison.around(leg, rides)[0].outcome, comparison.beside(
        (leg, rides), parts["box.2"]
    ).outcome


def seen(cell: RobotCell, backend: BulletBackend) -> set[str]:
    """What stops a run."""
    parts = Parts(cell).present
    for part in parts.values():
        backend.set_part(part)
    feeder = RobotExecutor(cell.robot("feeder"), cell.motion)
    motion = feeder.begin(RUN, 0.0)
    ends = MoveEnds.of(cell.robot("feeder"), "", motion.trajectory, motion.kind)
    led, monitor = LedContacts(cell), Monitor(cell, backend)

    def led_to(contact: LedContact) -> Led:
        touching = parts.get(contact.part), parts.get(contact.other)
        homes = {r.name: np.array(r.home) for r in cell.moving}
        return led.of_move(contact, ends, touching, homes.__getitem__, (0.0, 1.0))

    out = set()
    for q in motion.trajectory.on_way(np.linspace(0.0, 1.0, 25)):
        joints: dict[str, Array] = {r.name: np.array(r.home) for r in cell.moving} | {"feeder": q}
        found = monitor.check(
            0.0, joints, kinds={"feeder": "axis"}, turning=turned(cell.robot("feeder"), motion),
            led_to=led_to,
        ).fault  # fmt: skip
        if found is not None:
            out.add(found.message.split(" (")[0])
    for name in parts:
        backend.remove_part(name)
    return out


CASES = {
    "grazed": (cell_of, -BY, ("touch", "touch")),
    "beside": (cell_of, 2e-3, ("clear", "clear")),
    "a rule permits it": (
        lambda off: cell_of(off, a="box.*", b="rail", depth=0.001), -BY, ("clear", "touch"),
    ),
}  # fmt: skip


@pytest.mark.bullet
@pytest.mark.parametrize(("made", "off", "outcomes"), CASES.values(), ids=CASES)
def test_a_box_on_a_belt(
    made: Callable[[float], RobotCell],
    off: float,
    outcomes: tuple[str, str],
    request: pytest.FixtureRequest,
) -> None:
    """It may stand on what is at the same height, so up to a millimetre deep nobody said anything."""
    cell = made(off)
    backend = BulletBackend(cell, looks=False)
    request.addfinalizer(backend.close)
    planner = Planner(cell)
    leg = planner.leg(planner.home("feeder"), RUN)
    assert Parts(cell).present["box.1"].plate == "feeder/belt"
    assert seen(cell, backend) == {
        f"device `feeder`: `box.1` and `{other}` collide"
        for other, outcome in zip(("rail", "box.2"), outcomes, strict=True)
        if outcome == "touch"
    }
    assert proved(cell, backend, leg) == outcomes
