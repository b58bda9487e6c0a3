"""Zones: what is in them, how fast it is there, and whether a move is slow enough in them over its whole way."""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.door_cell import TOML, door_cell
from helpers.robot_cells import nowhere, pose_mm
from pn2code.cell.load import load as load_cell
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.shown import Shown
from pn2code.geometry.zone_speeds import slow_enough
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Along, MoveExternal, MoveJoint, MoveLinear
from pn2code.robot.model import MODELS
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import matrix_of
from pn2code.robot.zones import ZoneWatch, _off

ZONES = """
[zones.front]
pose = { x = 0.7, z = 1.0, yaw = 20.0 }
size = [0.6, 0.8, 0.8]
max_speed = 0.5

[zones.far]
pose = { x = 4.0, z = 1.0 }
size = [1.0, 1.0, 1.0]
"""


def cell_of(most: float = 0.5) -> RobotCell:
    data: dict[str, Any] = tomllib.loads(TOML + ZONES)
    data["zones"]["front"]["max_speed"] = most
    d = Diagnostics()
    found = load(data, Path(), nowhere, d)
    assert found is not None, [e.message for e in d.errors]
    return found


CELL = cell_of()
SHUT = np.array([0.0, 0.02, 0.02])
OPEN = np.array([0.9, 0.02, 0.02])


def with_flange(folder: Path, solid: str) -> dict[str, Any]:
    """The cell with a shape on the flange of its arm."""
    text = (MODELS / "gp25.urdf").read_text(encoding="utf-8")
    shape = f'<link name="flange"><collision><geometry>{solid}</geometry></collision></link>'
    assert '<link name="flange"/>' in text
    arm = text.replace('<link name="flange"/>', shape)
    arm = arm.replace('filename="', f'filename="{MODELS}/').replace(f"{MODELS}/flat", "flat")
    (folder / "arm.urdf").write_text(arm, encoding="utf-8")
    data: dict[str, Any] = tomllib.loads(TOML + ZONES)
    data["robots"]["arm"]["model"] = "arm.urdf"
    return data


def test_what_has_no_shape_that_can_be_read_is_not_left_out_of_zones(tmp_path: Path) -> None:
    """Nobody would see how fast it is there."""
    flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    (tmp_path / "flat.obj").write_text(flat, encoding="utf-8")
    data = with_flange(tmp_path, '<mesh filename="flat.obj"/>')
    for zones in ({}, data.pop("zones")):
        d = Diagnostics()
        found = load({**data, "zones": zones}, tmp_path, nowhere, d)
        said = [e.message for e in d.errors]
        words = (
            "a shape of `arm/flange` cannot be read, so that nobody knows whether it is in a zone"
        )
        assert said == ([words] if zones else []), said
        assert (found is None) is bool(zones)


def test_a_capsule_counts_with_its_round_ends(tmp_path: Path) -> None:
    data = with_flange(tmp_path, '<capsule radius="0.1" length="0.3"/>')
    d = Diagnostics()
    found = load(data, tmp_path, nowhere, d)
    assert found is not None, [e.message for e in d.errors]
    (box,) = (b for b in ZoneWatch(found).boxes("arm") if b[0] == "arm/flange")
    _, axis, corners = box
    lengths = np.sort(np.ptp(corners, axis=0))
    assert axis == 6 and lengths == pytest.approx([0.2, 0.2, 0.5])


def at(x: float, y: float, z: float) -> np.ndarray[Any, Any]:
    arm = CELL.robot("arm")
    target = np.linalg.inv(arm.T_world_base) @ matrix_of(pose_mm(x, y, z, 180, 0, 0))
    found = arm.kinematics.nearest(target, arm.home)
    assert found is not None
    return found.q


def test_a_box_is_off_another_one_by_no_more_than_its_points() -> None:
    random = np.random.default_rng(7)
    unit = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    inside = random.random((400, 3))
    met = 0
    for _ in range(60):
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        size, shift, half = random.random(3), random.normal(size=3), random.random(3) + 0.1
        corners, points = ((x * size) @ turn + shift for x in (unit, inside))
        off = _off(corners, half)
        away = np.linalg.norm(np.maximum(np.abs(points) - half, 0.0), axis=1).min()
        assert off <= away + 1e-12
        met += off > 0.0
    assert 10 < met < 55


def test_an_arm_and_what_it_carries_are_in_a_zone_and_a_door_is_not() -> None:
    watch = ZoneWatch(CELL)
    inside, home = {"arm": at(700, 0, 900), "mill": SHUT}, {"arm": at(0, -900, 1400), "mill": SHUT}
    assert watch.occupied("front", inside, ())
    assert not watch.occupied("front", home, ())
    assert not watch.occupied("far", inside, ())
    # A part reaches further down than the tool.
    over = {"arm": at(700, 0, 1550), "mill": SHUT}
    parts = Parts(CELL)
    blank = parts.present["blank.1"]
    assert not watch.occupied("front", over, ())
    held = type(blank)("blank.1", blank.kind, matrix_of(pose_mm(0, 0, 75, 0, 180, 0)), "arm")
    assert watch.occupied("front", over, [held])


def test_what_is_in_a_zone_where_speeds_are_limited() -> None:
    """As for each link by itself; in `far` nothing is limited."""
    watch = ZoneWatch(CELL)
    random = np.random.default_rng(5)
    met = set()
    for _ in range(60):
        q = random.uniform(CELL.robot("arm").arm.lower, CELL.robot("arm").arm.upper)
        is_in = any(watch.off("front", corners) <= 0.0 for _, corners in watch.placed("arm", q, ()))
        assert list(watch.in_limited({"arm": q}, ())) == ["arm"] * is_in
        met.add(is_in)
    assert met == {False, True}
    assert list(watch.in_limited({"mill": SHUT, "arm": at(0, -900, 1400)}, ())) == ["mill"]


def test_what_is_too_fast_is_told_with_its_speed() -> None:
    watch = ZoneWatch(CELL)
    joints = {"mill": SHUT}
    assert watch.too_fast(joints, {"mill": np.array([0.49, 0.0, 0.0])}, ()) is None
    found = watch.too_fast(joints, {"mill": np.array([0.52, 0.0, 0.0])}, ())
    assert found is not None and found.link == "mill/door"
    assert found.speed == pytest.approx(0.52)
    assert "`mill/door` is 520.0 mm/s fast at" in found.words()
    assert "in zone `front`, where 500.0 mm/s are allowed" in found.words()
    assert watch.too_fast({"mill": OPEN}, {"mill": np.array([0.52, 0.0, 0.0])}, ()) is None


def test_of_several_the_worst_is_told() -> None:
    """The door in `front`, where 0.5 m/s are allowed, and the arm, which comes to be twice too fast."""
    watch = ZoneWatch(CELL)
    q = at(700, 0, 1000)
    fast = np.zeros(6)
    fast[0] = 2.0
    alone = watch.too_fast({"arm": q}, {"arm": fast}, ())
    assert alone is not None
    every = [x for x, _ in watch.placed("arm", q, ())]
    assert alone.link in every and alone.times == pytest.approx(alone.speed / 0.5)
    door = np.array([0.5001, 0.0, 0.0])
    both = watch.too_fast({"mill": SHUT, "arm": q}, {"mill": door, "arm": fast}, ())
    assert both is not None and both.link == alone.link


def test_the_speed_that_is_told_is_seen_to_be_above_what_is_allowed() -> None:
    found = ZoneWatch(CELL).too_fast({"mill": SHUT}, {"mill": np.array([0.50001, 0.0, 0.0])}, ())
    assert found is not None
    assert "is 500.010 mm/s fast" in found.words() and "where 500.000 mm/s are" in found.words()


# --- whole ways ----------------------------------------------------------------------------------


class _Legs:
    def __init__(self) -> None:
        self.backend = BulletBackend(CELL, looks=False)
        self.planner = Planner(CELL)
        start = self.planner.leg(
            self.planner.home("arm"), MoveJoint(pose_mm(0, -900, 900, 180, 0, 0))
        )
        self.joint = self.planner.leg(start.end, MoveJoint(pose_mm(600, 0, 900, 180, 0, 0)))
        self.line = self.planner.leg(
            self.joint.end, MoveLinear(pose_mm(1000, 0, 900, 180, 0, 0), speed=0.25)
        )
        self.door = self.planner.leg(
            self.planner.home("mill"), MoveExternal((Along("door", 0.9, True),))
        )

        self.compared = Comparison(CELL, self.planner, Shown(self.backend))

    def says(self, leg: Leg, most: float) -> tuple[str, str]:
        _, track = self.compared._track(leg, ())
        return slow_enough(ZoneWatch(cell_of(most)), track, ())

    def answer(self, leg: Leg, most: float) -> str:
        return self.says(leg, most)[0]

    def fastest(self, leg: Leg) -> float:
        """In the zone, at samples."""
        watch = ZoneWatch(cell_of(1e-4))
        assert leg.path is not None
        found = [
            watch.too_fast({leg.robot: leg.path.q(t)}, {leg.robot: leg.path.qd(t)}, ())
            for t in np.linspace(0.0, leg.path.duration, 60).tolist()
        ]
        return max(x.speed for x in found if x is not None)


@pytest.fixture(scope="module")
def legs() -> Iterator[_Legs]:
    out = _Legs()
    yield out
    out.backend.close()


@pytest.mark.bullet
@pytest.mark.parametrize("name", ["joint", "line", "door"])
def test_a_move_is_slow_enough_if_it_is_nowhere_too_fast(legs: _Legs, name: str) -> None:
    """The first link that is too fast tells its speed; the fastest of all is not below what samples show."""
    leg = getattr(legs, name)
    assert leg.fault is None
    fastest = legs.fastest(leg)
    assert legs.answer(leg, fastest * 0.95) == "no"
    slow = next(f for f in (1.05, 1.3, 2.0, 4.0) if legs.answer(leg, fastest * f) == "yes")
    assert slow <= (4.0 if name == "joint" else 2.0)


@pytest.mark.bullet
def test_as_fast_as_may_be_is_not_too_fast(legs: _Legs) -> None:
    """The door goes at 0.6 m/s, to the last digits."""
    assert legs.says(legs.door, 0.6) == ("yes", "")
    assert legs.answer(legs.door, 0.5999) == "no"


@pytest.mark.bullet
def test_of_a_move_that_is_too_fast_the_worst_is_told_and_what_would_do(legs: _Legs) -> None:
    fastest = 1000.0 * legs.fastest(legs.joint)
    answer, why = legs.says(legs.joint, fastest / 8000.0)
    assert answer == "no" and why.endswith(
        "mm/s are allowed: the worst of 65 instants; about 12 % of this speed would do"
    )
    assert float(why.split(" is ")[1].split(" mm/s")[0]) == pytest.approx(fastest, rel=0.02)


@pytest.mark.bullet
def test_speeds_in_pieces_are_bounds(legs: _Legs) -> None:
    for leg in (legs.joint, legs.line, legs.door):
        _, track = legs.compared._track(leg, ())
        edges = np.linspace(0.0, 1.0, 9)
        most = track.speeds(edges[:-1], edges[1:])
        for i, (a, b) in enumerate(itertools.pairwise(edges.tolist())):
            way = np.linspace(a, b, 21)
            assert leg.path is not None
            corners = track.boxes(leg.path.on_way(way))
            shown = (
                np.linalg.norm(np.diff(corners, axis=0), axis=3).max(axis=2) / np.diff(way)[:, None]
            )
            assert (shown.max(axis=0) <= most[i] * (1.0 + 1e-6) + 1e-9).all()
            if b - a < 0.2 and leg is not legs.line:
                assert (most[i] <= 2.5 * shown.max(axis=0) + 0.3).all()


# --- sensors -------------------------------------------------------------------------------------


def test_an_axis_is_at_a_position() -> None:
    mill = CELL.robot("mill")
    assert mill.is_at("door", np.array([0.0006, 0.02, 0.02]), 0.0)
    assert not mill.is_at("door", np.array([0.002, 0.02, 0.02]), 0.0)
    assert mill.is_at("vice", np.array([0.0, 0.06, 0.06]), 0.12)
    assert not mill.is_at("vice", np.array([0.0, 0.06, 0.06]), 0.06)


BELT = """
[devices.mill.axes.belt]
kind = "belt"
pose = { x = 3.0, z = 0.5 }
length = 1.0
width = 0.2
"""


def test_what_a_sensor_sees_is_there(tmp_path: Path) -> None:
    for sensor, words in (
        ('sees = "mill.dor"\nat = 0.0', "`sees` names `mill.dor`, but no device has such an axis"),
        (
            f'sees = "mill.belt"\n{BELT}',
            "`sees` names `mill.belt`, but that is a belt: how far it has run s",
        ),
        ('sees = "mill.door"', "`sees` names axis `mill.door`, but not at which position"),
        ('sees = "inVice"\nat = 0.1', "`at` says where an axis is seen, but `sees` names none"),
        ('sees = "front"\npart = "blank"', "but `front` is no place"),
        ('sees = "frnt"', "there is no `[places.frnt]`"),
        ('sees = ""', "`sees` is empty, but the name of a place, a zone or an axis is expected"),
        ('sees = "inVice"\npart = ""', "`part` is empty, but the name of a kind of parts is exp"),
        ('file = ""', "`file` is empty, but a file name is expected"),
        ('sees = "front"\nsays = ""', ""),
        ('sees = "front"', ""),
        ('sees = "mill.door"\nat = 0.9', ""),
    ):
        d = Diagnostics()
        toml = TOML + ZONES + f'[sensors.eye]\nvariable = "x"\n{sensor}\n'
        load_cell(door_cell(tmp_path, toml=toml), d)
        said = [e.message for e in d.errors]
        assert any(words in e for e in said) if words else not said, (sensor, said)
