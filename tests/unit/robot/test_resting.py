"""What parts stand on: other parts, things, turntables; what is taken from under them, and what turns with them."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from helpers.carrying_cell import TOML
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.choose_backend import open_backend
from pn2code.robot.commands import Handling, MoveJoint, Pose
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.ground import Ground
from pn2code.robot.part import Part, PartFault
from pn2code.robot.parts import Parts
from pn2code.robot.payload import Rating
from pn2code.robot.riders import tilted
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import Array, matrix_of
from pn2code.run.handling import PartKeeper

TAKE, RELEASE = Handling("takes", "box"), Handling("releases", "box")
PLATE = {
    "kind": "turntable",
    "pose": {"x": 1.5, "y": 0.6, "z": 0.4},
    "from": -180.0,
    "to": 180.0,
    "radius": 0.35,
}


LIFT = {
    "axes": {
        "platform": {
            "kind": "slide",
            "pose": {"x": 1.5, "y": 0.6, "z": 0.4},
            "direction": [0.0, 0.0, 1.0],
            "from": 0.0,
            "to": 0.5,
            "objects": [{"name": "top", "size": [0.5, 0.5, 0.05], "pose": {"z": -0.025}}],
        }
    }
}


def cell_of(
    *at: dict[str, float], plate: dict[str, Any] | None = None, mass: float = 0.0, **more: Any
) -> RobotCell:
    data = tomllib.loads(TOML)
    data["parts"]["box"]["mass"] = mass
    data["parts"]["box"]["at"] = list(at)
    if plate is not None:
        data["robots"]["robot"]["axes"] = {"plate": plate}
    data["devices"] |= more.pop("devices", {})
    data["scene"]["objects"] += more.pop("objects", [])
    data["parts"] |= more
    d = Diagnostics()
    found = load(data, Path(), lambda *_: Origin("cell.toml"), d)
    assert found is not None, [e.message for e in d.errors]
    return found


def above(x: float, y: float, z: float, rz: float = 0.0) -> Array:
    """The TCP, where the top of a box is at a place."""
    return matrix_of(Pose(x, y, z, math.pi, 0.0, rz))


def on(parts: Parts, name: str) -> tuple[str, ...]:
    rest = parts.rest(parts.present[name])
    assert rest is not None
    return rest.on


def turned(parts: Parts, degrees: float) -> None:
    robot = parts.cell.robot("robot")
    parts.stand("robot", [*robot.home[:-1], math.radians(degrees)])


def test_parts_of_the_start_stand_on_each_other() -> None:
    parts = Parts(cell_of({"z": 0.075}, {"x": 0.05, "z": 0.225}, {"z": 0.9}))
    assert [on(parts, f"box.{i}") for i in (1, 2, 3)] == [("floor",), ("box.1",), ()]


@pytest.mark.parametrize(
    ("x", "z", "says"),
    [
        (1.0, 0.3, ""),
        (1.0, 0.3049, ""),
        (1.0, 0.3050000001, ""),
        (
            1.0,
            0.30502,
            "in the air: `box.1`, the nearest thing below it, is 5.02 mm away (at most 5 mm)",
        ),
        (1.0, 0.306, "in the air: `box.1`, the nearest thing below it, is 6.0 mm away"),
        (1.099, 0.3, ""),
        (1.101, 0.3, "where it tips over: its middle is not above what it stands on, `box.1`, by"),
        (1.2, 0.3, "in the air: `floor`, the nearest thing below it, is 150.0 mm away"),
    ],
)
def test_what_is_released_stands_on_what_is_there_then(x: float, z: float, says: str) -> None:
    parts = Parts(cell_of({"x": 1.0, "z": 0.075}, {"x": 2.0, "z": 0.075}))
    parts.handle("robot", TAKE, above(2.0, 0.0, 0.15))
    if not says:
        assert parts.handle("robot", RELEASE, above(x, 0.0, z)).on == ("box.1",)
        return
    with pytest.raises(PartFault) as fault:
        parts.handle("robot", RELEASE, above(x, 0.0, z))
    assert says in str(fault.value)
    assert parts.present["box.2"].holder == "robot"


def test_what_stands_on_a_part_that_is_taken_goes_along_and_stands_there_again() -> None:
    stack = ({"x": 1.0, "z": z} for z in (0.075, 0.225, 0.375))
    parts = Parts(cell_of(*stack, {"x": 1.3, "z": 0.075}))
    before = parts.present["box.3"].frame
    parts.handle("robot", TAKE, above(1.0, 0.0, 0.15))
    assert [(p.name, p.holder) for p in parts.present.values() if p.holder] == [
        (f"box.{i}", "robot") for i in (1, 2, 3)
    ]
    assert parts.held_by("robot") is parts.present["box.1"]
    assert [(c.effect, c.part) for c in parts.settled] == [("takes", "box.2"), ("takes", "box.3")]
    # Put into the air nothing of it is put down.
    with pytest.raises(PartFault, match="in the air"):
        parts.handle("robot", RELEASE, above(2.0, 0.0, 0.5))
    assert all(parts.present[f"box.{i}"].holder for i in (1, 2, 3))
    parts.handle("robot", RELEASE, above(2.0, 0.5, 0.15))
    assert [on(parts, f"box.{i}") for i in (1, 2, 3)] == [("floor",), ("box.1",), ("box.2",)]
    assert [(c.effect, c.part, c.on) for c in parts.settled] == [
        ("releases", "box.2", ("box.1",)),
        ("releases", "box.3", ("box.2",)),
    ]
    moved = parts.present["box.3"].frame[:3, 3] - before[:3, 3]
    assert moved == pytest.approx([1.0, 0.5, 0.0], abs=1e-9)
    assert not any(p.holder for p in parts.present.values())


def test_what_is_put_on_a_turntable_with_others_on_it_turns_with_them() -> None:
    parts = Parts(cell_of({"x": 1.0, "z": 0.075}, {"x": 1.0, "z": 0.225}, plate=PLATE))
    parts.handle("robot", TAKE, above(1.0, 0.0, 0.15))
    parts.handle("robot", RELEASE, above(1.5, 0.6, 0.55))
    assert {p.plate for p in parts.present.values()} == {"robot/plate"}
    # And a stack that is taken from there stands with nobody any more.
    parts.handle("robot", TAKE, above(1.5, 0.6, 0.55))
    assert {(p.plate, p.holder) for p in parts.present.values()} == {("", "robot")}


def test_an_arm_carries_no_more_than_it_may_with_all_that_stands_on_a_part() -> None:
    stack = [{"x": 1.0, "z": 0.075 + 0.15 * i} for i in range(3)]
    parts = Parts(cell_of(*stack, mass=10.0))
    robot = parts.cell.robot("robot")
    rated = replace(robot.arm.urdf, rating=Rating(25.0))
    robot = replace(robot, arm=replace(robot.arm, urdf=rated))
    parts.cell = replace(parts.cell, robots=(robot,))
    message = r"takes `box\.1` with `box\.2` and `box\.3` on it: it carries its tool .* but 25 kg are rated"
    with pytest.raises(PartFault, match=message):
        parts.handle("robot", TAKE, above(1.0, 0.0, 0.15))
    assert parts.handle("robot", TAKE, above(1.0, 0.0, 0.45)).part == "box.3"


def test_what_only_stands_on_a_part_that_is_carried_does_not_lean() -> None:
    cell = cell_of({"x": 1.2, "z": 0.075}, {"x": 1.2, "z": 0.225})
    robot, parts = cell.robot("robot"), Parts(cell)
    executor = RobotExecutor(robot, cell.motion)
    executor.begin(MoveJoint(Pose(1.2, 0.0, 0.15, math.pi, 0.0, 0.0)), 0.0)
    executor.finish()
    parts.handle("robot", TAKE, matrix_of(executor.pose))
    present = list(parts.present.values())
    q = np.array(executor.q)
    assert tilted(robot, q, present) == ""
    q[4] += math.radians(9.9)
    assert tilted(robot, q, present) == ""
    q[4] += math.radians(0.3)
    assert "`robot` tilts `box.2` by 10.2 deg" in tilted(robot, q, present)


def test_of_two_that_carry_a_part_one_may_be_taken_if_the_other_is_beneath_its_middle() -> None:
    pair = ({"x": 1.0, "z": 0.075}, {"x": 1.22, "z": 0.075})
    parts = Parts(cell_of(*pair, {"x": 1.05, "z": 0.225}))
    assert on(parts, "box.3") == ("box.1", "box.2")
    with pytest.raises(PartFault, match=r"`box\.3` stands on it"):
        parts.handle("robot", TAKE, above(1.0, 0.0, 0.15))
    assert parts.handle("robot", TAKE, above(1.22, 0.0, 0.15)).part == "box.2"
    bridge = Parts(cell_of(*pair, {"x": 1.11, "z": 0.225}))
    for x in (1.0, 1.22):
        with pytest.raises(PartFault, match=r"`box\.3` stands on it"):
            bridge.handle("robot", TAKE, above(x, 0.0, 0.15))


def test_a_device_does_not_remove_what_carries_others() -> None:
    parts = Parts(cell_of({"x": 1.5, "y": -0.6, "z": 0.575}, {"x": 1.5, "y": -0.6, "z": 0.725}))
    with pytest.raises(
        PartFault, match=r"removes `box\.1` from place `infeed`, but `box\.2` stands on it"
    ):
        parts.handle("feeder", Handling("removes", "box", "infeed"), None)


def test_what_hangs_from_the_start_needs_nothing() -> None:
    """A device that has no shape may hold it."""
    parts = Parts(cell_of({"x": 1.0, "z": 0.3}, {"x": 1.0, "z": 0.6}))
    assert parts.handle("robot", TAKE, above(1.0, 0.0, 0.375)).part == "box.1"


# --- turntables ------------------------------------------------------------------------------------


def test_a_part_goes_with_the_turntable_on_which_it_stands() -> None:
    parts = Parts(
        cell_of({"x": 1.7, "y": 0.6, "z": 0.475}, {"x": 1.7, "y": 0.6, "z": 0.625}, plate=PLATE)
    )
    assert {p.plate for p in parts.present.values()} == {"robot/plate"}
    parts.turn("robot/plate")
    turned(parts, 90.0)
    for name, z in (("box.1", 0.475), ("box.2", 0.625)):
        assert parts.world(parts.present[name])[:3, 3] == pytest.approx([1.5, 0.8, z])
    assert on(parts, "box.2") == ("box.1",)
    change = parts.handle("robot", TAKE, above(1.5, 0.8, 0.7, math.pi / 2))
    assert (change.part, parts.present["box.2"].plate) == ("box.2", "")
    put = parts.handle("robot", RELEASE, above(1.5, 0.4, 0.55, math.pi / 2))
    assert (put.on, put.plate) == (("robot/plate",), "robot/plate")
    assert put.on_plate is not None and (put.on_plate.x, put.on_plate.y) == pytest.approx((-0.2, 0))
    turned(parts, 0.0)
    assert parts.world(parts.present["box.2"])[:3, 3] == pytest.approx([1.3, 0.6, 0.475])


def test_a_part_seen_or_removed_at_a_place_is_where_the_turntable_has_taken_it() -> None:
    cell = cell_of({"x": 1.7, "y": 0.6, "z": 0.475}, plate=PLATE)
    cell.places["infeed"] = Pose(1.5, 0.8, 0.475, 0.0, 0.0, 0.0)  # type: ignore[index]
    parts = Parts(cell)
    assert not parts.is_seen("infeed")
    turned(parts, 90.0)
    assert parts.is_seen("infeed", "box")
    parts.handle("feeder", Handling("removes", "box", "infeed"), None)
    assert not parts.present


def test_what_would_be_torn_off_a_turntable_is_a_fault() -> None:
    beside = {"name": "shelf", "size": [0.4, 0.4, 0.4], "pose": {"x": 2.06, "y": 0.6, "z": 0.2}}
    both = cell_of({"x": 1.84, "y": 0.6, "z": 0.475}, plate=PLATE, objects=[beside])
    parts = Parts(both)
    assert on(parts, "box.1") == ("robot/plate", "shelf")
    with pytest.raises(PartFault, match=r"`box\.1` on it also stands on `shelf`, which does not"):
        parts.turn("robot/plate")
    tilted = cell_of(
        {"x": 1.5, "y": 0.6, "z": 0.476},
        plate=PLATE | {"pose": {"x": 1.5, "y": 0.6, "z": 0.4, "roll": 1.0}},
    )
    with pytest.raises(PartFault, match=r"turns about a line that is not upright, and `box\.1`"):
        Parts(tilted).turn("robot/plate")


def test_nothing_is_handled_on_a_turntable_that_turns() -> None:
    parts = Parts(
        cell_of({"x": 1.7, "y": 0.6, "z": 0.475}, {"x": 1.0, "y": -0.6, "z": 0.075}, plate=PLATE)
    )
    parts.turning = frozenset({"robot/plate"})
    with pytest.raises(PartFault, match=r"takes `box\.1` from `robot/plate` while that turns"):
        parts.handle("other", TAKE, above(1.7, 0.6, 0.55))
    parts.handle("other", TAKE, above(1.0, -0.6, 0.15))
    with pytest.raises(PartFault, match=r"releases `box\.2` on `robot/plate` while that turns"):
        parts.handle("other", RELEASE, above(1.3, 0.6, 0.55))


def test_what_stands_elsewhere_after_something_was_taken_away_does_not_turn_any_more() -> None:
    beside = {"name": "shelf", "size": [0.4, 0.4, 0.55], "pose": {"x": 2.05, "y": 0.6, "z": 0.275}}
    parts = Parts(
        cell_of(
            {"x": 1.74, "y": 0.6, "z": 0.475},
            {"x": 1.92, "y": 0.6, "z": 0.625},
            plate=PLATE,
            objects=[beside],
        )
    )
    assert on(parts, "box.2") == ("box.1", "shelf") and parts.present["box.2"].plate
    parts.handle("robot", TAKE, above(1.74, 0.6, 0.55))
    (settled,) = parts.settled
    assert (settled.part, settled.on, settled.plate) == ("box.2", ("shelf",), "")
    turned(parts, 90.0)
    assert parts.world(parts.present["box.2"])[:3, 3] == pytest.approx([1.92, 0.6, 0.625])


# --- meshes, and what PyBullet says ----------------------------------------------------------------


def test_a_mesh_stands_as_its_hull_does(tmp_path: Path) -> None:
    """A pyramid: its middle is a fourth of its height above its base."""
    corners = [(0.3, 0, 0), (0, 0.3, 0), (-0.3, 0, 0), (0, -0.3, 0), (0, 0, 0.4)]
    lines = [f"v {1000 * x} {1000 * y} {1000 * z}" for x, y, z in corners]
    lines += [f"f {a} {b} 5" for a, b in ((1, 2), (2, 3), (3, 4), (4, 1))] + ["f 4 3 2 1"]
    file = tmp_path / "cone.obj"
    file.write_text("\n".join(lines))
    cell = cell_of(
        {"x": 1.0, "z": 0.475},
        cone={"kind": "mesh", "file": str(file), "scale": 0.001, "at": [{"y": 1.0}]},
        objects=[
            {
                "name": "fixture",
                "kind": "mesh",
                "file": str(file),
                "scale": 0.001,
                "pose": {"x": 1.0, "z": 0.4, "roll": 180.0},
            }
        ],
    )
    parts = Parts(cell)
    assert on(parts, "box.1") == ("fixture",)
    rest = parts.rest(parts.present["cone.1"])
    assert rest is not None and rest.on == ("floor",)
    assert rest.inside == pytest.approx(0.3 / math.sqrt(2) - 1e-4, abs=1e-6)


@pytest.mark.bullet
def test_gaps_are_those_that_the_collision_library_measures(
    request: pytest.FixtureRequest,
) -> None:
    """Boxes and cylinders, upright and lying, one above the other, with gaps of some millimetres."""
    kind = {"kind": "cylinder", "radius": 0.08, "length": 0.2}
    cell = cell_of({"x": 1.0, "z": 0.075}, can=kind)
    backend = open_backend("bullet", cell, looks=False)
    request.addfinalizer(backend.close)
    below = Parts(cell).present["box.1"]
    backend.set_part(below)
    ground = Ground.of(cell)
    random = Random(5)
    for i in range(40):
        name = random.choice(("can", "box"))
        lying = name == "can" and random.random() < 0.5
        half = 0.08 if lying else (0.1 if name == "can" else 0.075)
        gap = random.uniform(0.0002, 0.02)
        x, y = (random.uniform(-0.05, 0.05) for _ in range(2))
        roll = math.pi / 2 if lying else 0.0
        pose = Pose(1.0 + x, y, 0.15 + gap + half, roll, 0.0, random.uniform(-3.0, 3.0))
        part = Part(f"{name}.{i + 7}", cell.parts[name], matrix_of(pose))
        rest = ground.rest(part.kind, part.frame, [("box.1", below.kind, below.frame)], {})
        backend.set_part(part)
        measured = {b.name: b.distance for b in backend.around(part.name, 0.1) or ()}
        backend.remove_part(part.name)
        assert rest is not None and rest.below == "box.1"
        assert rest.gap == pytest.approx(measured["box.1"], abs=2e-4), (name, pose)
        assert bool(rest.on) is (rest.gap <= 0.005)


@pytest.mark.bullet
def test_the_collision_library_takes_a_part_along_with_a_turntable(
    request: pytest.FixtureRequest,
) -> None:
    pillar = {"name": "pillar", "size": [0.1, 0.1, 0.6], "pose": {"x": 1.5, "y": 0.95, "z": 0.3}}
    cell = cell_of({"x": 1.75, "y": 0.6, "z": 0.475}, plate=PLATE, objects=[pillar])
    backend = open_backend("bullet", cell, looks=False)
    request.addfinalizer(backend.close)
    keeper = PartKeeper(cell, backend)
    keeper.begin()
    home = np.array(cell.robot("robot").home)

    def nearest(degrees: float) -> float:
        backend.set_joints("robot", [*home[:-1], math.radians(degrees)])
        found = [c for c in backend.clearances(0.5) or () if (c.a, c.b) == ("box.1", "pillar")]
        assert all(c.stands and c.allowed == 0.001 for c in found)
        return min((c.distance for c in found), default=math.inf)

    assert nearest(0.0) > 0.05
    assert nearest(90.0) < -0.03


@pytest.mark.bullet
@pytest.mark.parametrize(("z", "distance"), [(0.6, 0.05), (0.55, 0.0), (0.5, -0.05)])
def test_what_a_tool_carries_keeps_clear_of_its_own_turntable(
    z: float, distance: float, request: pytest.FixtureRequest
) -> None:
    """It may be put there: it touches by no more than what it is put on permits."""
    cell = cell_of({"x": 1.7, "y": 0.6, "z": 0.475}, plate=PLATE)
    backend = open_backend("bullet", cell, looks=False)
    request.addfinalizer(backend.close)
    keeper = PartKeeper(cell, backend)
    keeper.begin()
    robot = cell.robot("robot")
    executor = RobotExecutor(robot, cell.motion)
    executor.begin(MoveJoint(Pose(1.7, 0.6, 0.55, math.pi, 0.0, 0.0)), 0.0)
    executor.finish()
    backend.set_joints("robot", executor.q)
    keeper.handle("robot", TAKE, matrix_of(executor.pose))
    executor.begin(MoveJoint(Pose(1.7, 0.6, z, math.pi, 0.0, 0.0)), 0.0)
    executor.finish()
    backend.set_joints("robot", executor.q)
    for found in (backend.clearances(0.5) or (), backend.distances.pairs("self", "robot", 0.5)):  # type: ignore[attr-defined]
        gaps = [c for c in found if (c.a, c.b) == ("robot/box.1", "robot/plate")]
        assert min(c.distance for c in gaps) == pytest.approx(distance, abs=1e-4)
        assert {c.allowed for c in gaps} == {0.001} and not any(c.stands for c in gaps)


# --- lifts and other axes of devices ---------------------------------------------------------------


@pytest.mark.bullet
def test_a_part_goes_with_the_lift_on_which_it_stands(request: pytest.FixtureRequest) -> None:
    beam = {"name": "beam", "size": [0.6, 0.1, 0.1], "pose": {"x": 1.5, "y": 0.6, "z": 0.9}}
    cell = cell_of(
        {"x": 1.6, "y": 0.6, "z": 0.475},
        {"x": 1.0, "y": -0.6, "z": 0.075},
        devices={"elevator": LIFT},
        objects=[beam],
    )
    backend = open_backend("bullet", cell, looks=False)
    request.addfinalizer(backend.close)
    keeper = PartKeeper(cell, backend)
    keeper.begin()
    parts = keeper.parts
    assert parts.present["box.1"].plate == "elevator/platform"
    parts.turn("elevator/platform")
    parts.stand("elevator", [0.3])
    assert parts.world(parts.present["box.1"])[:3, 3] == pytest.approx([1.6, 0.6, 0.775])
    backend.set_joints("elevator", [0.3])
    gaps = [c for c in backend.clearances(0.5) or () if (c.a, c.b) == ("box.1", "beam")]
    assert min(c.distance for c in gaps) == pytest.approx(0.0, abs=1e-4)
    backend.set_joints("elevator", [0.35])
    gaps = [c for c in backend.clearances(0.5) or () if (c.a, c.b) == ("box.1", "beam")]
    assert min(c.distance for c in gaps) == pytest.approx(-0.05, abs=1e-4)
    parts.handle("robot", TAKE, above(1.0, -0.6, 0.15))
    put = parts.handle("robot", RELEASE, above(1.4, 0.4, 0.85))
    assert (put.on, put.plate) == (("elevator/platform",), "elevator/platform")
    shelf = {"name": "shelf", "size": [0.1, 0.5, 0.4], "pose": {"x": 1.8, "y": 0.6, "z": 0.2}}
    both = cell_of({"x": 1.7, "y": 0.6, "z": 0.475}, devices={"elevator": LIFT}, objects=[shelf])
    with pytest.raises(PartFault, match=r"`elevator/platform` moves, but `box\.1` on it also"):
        Parts(both).turn("elevator/platform")


def test_the_jaws_of_a_clamp_carry_nothing() -> None:
    jaws = {"kind": "clamp", "pose": {"x": 1.5, "y": 0.6, "z": 0.4}, "from": 0.0, "to": 0.1}
    cell = cell_of(devices={"vice": {"axes": {"jaws": jaws | {"jaw": [0.1, 0.3, 0.1]}}}})
    assert not cell.devices[0].carrying and not Ground.of(cell).plates
