"""A lift that carries its arm too far down, and what turns on a plate into something that stands."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from pn2code.geometry.apart import Apart
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Planner
from pn2code.geometry.shown import Shown
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Along, Command, MoveExternal
from pn2code.robot.monitor import Monitor
from unit.robot.test_external_axes import DATA, loaded, plate

pytestmark = pytest.mark.bullet


def moved(command: Command, **changes: Any) -> tuple[Apart, str]:
    """What is said of a move before a run, and the fault at its end in one."""
    data = copy.deepcopy(DATA)
    for key, value in changes.items():
        if key == "objects":
            data["scene"] = {"objects": value}
        else:
            section, name = key.split("__")
            data["robots"]["left"]["axes"][section][name] = value
    cell, d = loaded(data)
    assert cell is not None, [x.message for x in d]
    backend = BulletBackend(cell, looks=False)
    planner = Planner(cell)
    leg = planner.leg(planner.home("left"), command)
    assert leg.fault is None
    found, _ = Comparison(cell, planner, Shown(backend)).around(leg, ())
    fault = Monitor(cell, backend).check(1.0, {"left": leg.end.q}, kinds={"left": "ptp"}).fault
    backend.close()
    return found, "" if fault is None else fault.message


def down(metres: float) -> MoveExternal:
    """The base of the arm is at 0.4 m with its lift at zero."""
    return MoveExternal((Along("rail", metres, True),))


LIFT = {"rail__direction": [0.0, 0.0, 1.0], "rail__from": -1.0, "rail__home": 0.0}


def test_a_lift_that_takes_its_arm_into_the_floor() -> None:
    found, fault = moved(down(-0.6), **LIFT)
    assert found.outcome == "touch" and found.where is not None
    assert (found.where.a, found.where.b) == ("left/base_link", "floor")
    assert "`left/base_link` is 140.0 mm deep in `floor`" in fault


def test_a_lift_that_sets_its_arm_on_the_floor() -> None:
    found, fault = moved(down(-0.4), **LIFT)
    assert (found.outcome, fault) == ("clear", "")


def test_a_lift_that_begins_below_what_it_would_stand_on() -> None:
    """What is so at HOME is meant; deeper it must not go."""
    lift = {**LIFT, "rail__home": -0.45}
    found, fault = moved(down(-0.3), **lift)
    assert (found.outcome, fault) == ("clear", "")
    found, fault = moved(down(-0.5), **lift)
    assert found.outcome == "touch" and "but only 51.0 mm are allowed" in fault


def test_a_track_slides_on_its_rail() -> None:
    found, fault = moved(down(2.0))
    assert (found.outcome, fault) == ("clear", "")


def test_what_turns_into_a_fixture() -> None:
    post = [{"name": "post", "size": [0.05, 0.05, 1.0], "pose": {"x": 1.0, "y": 4.35, "z": 0.5}}]
    arm = [{"name": "bar", "size": [0.9, 0.05, 0.3], "pose": {"z": -0.2}}]
    wide = {"plate__radius": 0.2, "plate__objects": arm, "objects": post}
    found, fault = moved(MoveExternal((plate(70.0),)), **wide)
    assert found.outcome == "touch" and found.where is not None
    assert {found.where.a, found.where.b} == {"left/plate", "post"}
    assert "`left/plate` and `post` collide" in fault
