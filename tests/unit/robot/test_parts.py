"""Parts: what actions do to them, and what cannot be done."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from helpers.carrying_cell import TOML
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.choose_backend import open_backend
from pn2code.robot.commands import Handling, Pose
from pn2code.robot.part import PartChange, PartFault
from pn2code.robot.parts import Parts
from pn2code.robot.scene import RobotCell, load
from pn2code.robot.transforms import matrix_of
from pn2code.run.handling import PartKeeper

TAKE, RELEASE = Handling("takes", "box"), Handling("releases", "box")
FEED, CLEAR = Handling("creates", "box", "infeed"), Handling("removes", "box", "infeed")
ABOVE = Pose(1.5, -0.6, 0.65, math.pi, 0.0, 0.0)
"""of the TCP, where a box at the infeed can be gripped"""


def nowhere(*_path: object) -> Origin:
    return Origin("cell.toml")


def moved(pose: Pose, x: float = 0.0, y: float = 0.0, z: float = 0.0, rz: float = 0.0) -> Pose:
    return Pose(pose.x + x, pose.y + y, pose.z + z, pose.rx, pose.ry, pose.rz + rz)


def read(change: Callable[[dict[str, Any]], None] = lambda _: None) -> tuple[Any, Diagnostics]:
    data = tomllib.loads(TOML)
    change(data)
    d = Diagnostics()
    return load(data, Path(), nowhere, d), d


@pytest.fixture
def cell() -> RobotCell:
    found, d = read()
    assert found is not None, list(d)
    return found


def test_a_part_is_fed_taken_carried_and_put_down(cell: RobotCell) -> None:
    parts = Parts(cell)
    assert parts.handle("feeder", FEED, None) == PartChange(
        "creates", "box.1", cell.places["infeed"], ("table",)
    )
    assert parts.handle("robot", TAKE, matrix_of(ABOVE)).part == "box.1"
    held = parts.held_by("robot")
    assert held is not None and held.holder == "robot"
    there = moved(ABOVE, x=0.2, y=0.9, z=-0.5, rz=0.3)
    change = parts.handle("robot", RELEASE, matrix_of(there))
    assert (change.effect, change.part) == ("releases", "box.1")
    pose = change.pose
    assert (pose.x, pose.y, pose.z) == pytest.approx((1.7, 0.3, 0.075))
    assert abs(pose.rz) == pytest.approx(0.3)
    assert parts.held_by("robot") is None
    assert parts.handle("feeder", FEED, None).part == "box.2"
    assert parts.handle("feeder", CLEAR, None).part == "box.2"
    assert list(parts.present) == ["box.1"]


@pytest.mark.parametrize(
    ("before", "handling", "at", "message"),
    [
        ([], TAKE, ABOVE, "`robot` grips air: there is no part `box` to take"),
        ([FEED], TAKE, moved(ABOVE, z=0.006), "`box.1`, is 6.0 mm from where it can be gripped"),
        ([FEED], TAKE, moved(ABOVE, rz=0.1), "`box.1`, is 0.0 mm and 5.7 deg from where"),
        ([FEED, TAKE], TAKE, ABOVE, "its tool holds `box.1` already"),
        ([FEED], RELEASE, ABOVE, "`robot` releases a part `box`, but its tool holds nothing"),
        ([FEED], FEED, None, "at place `infeed`, but `box.1` is there"),
        ([], CLEAR, None, "from place `infeed`, but no part is there"),
        ([FEED, TAKE], CLEAR, None, "from place `infeed`, but no part is there"),
    ],
)
def test_what_cannot_be(
    cell: RobotCell, before: list[Handling], handling: Handling, at: Pose | None, message: str
) -> None:
    parts = Parts(cell)
    for step in before:
        parts.handle("robot", step, matrix_of(ABOVE))
    kept = dict(parts.present)
    with pytest.raises(PartFault) as fault:
        parts.handle("robot", handling, None if at is None else matrix_of(at))
    assert message in str(fault.value)
    assert parts.present == kept


def test_a_part_in_another_tool_is_not_taken_from_there(cell: RobotCell) -> None:
    """It was as if there were none."""
    parts = Parts(cell)
    parts.handle("feeder", FEED, None)
    parts.handle("robot", TAKE, matrix_of(ABOVE))
    with pytest.raises(
        PartFault, match=r"that stands \(`box.1` is in the tool of `robot`, and must"
    ):
        parts.handle("other", TAKE, matrix_of(ABOVE))


def test_of_several_parts_at_a_place_the_nearest_is_removed() -> None:
    at = [{"x": 1.5, "y": -0.6, "z": z} for z in (0.725, 0.575)]
    cell, d = read(lambda data: data["parts"]["box"].update(at=at, grip_tolerance=0.2))
    assert cell is not None, list(d)
    with pytest.raises(PartFault, match=r"removes `box.2` .* but `box.1` stands on it"):
        Parts(cell).handle("feeder", CLEAR, None)


def test_parts_of_the_start() -> None:
    cell, d = read(lambda data: data["parts"]["box"].update(at=[{"x": 1.0}, {"x": 2.0, "yaw": 90}]))
    assert cell is not None, list(d)
    parts = Parts(cell).present
    assert [(p.name, *p.frame[:3, 3]) for p in parts.values()] == [
        ("box.1", 1.0, 0.0, 0.0),
        ("box.2", 2.0, 0.0, 0.0),
    ]


def test_without_grips_any_turn_will_do() -> None:
    cell, _ = read(lambda data: data["parts"]["box"].pop("grips"))
    parts = Parts(cell)
    parts.handle("feeder", FEED, None)
    assert parts.handle("robot", TAKE, matrix_of(moved(ABOVE, z=-0.075, rz=1.0))).part == "box.1"


def put(*path: str, value: object) -> Callable[[dict[str, Any]], None]:
    def change(data: dict[str, Any]) -> None:
        table = data
        for key in path[:-1]:
            table = table[key]
        table[path[-1]] = value

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (put("parts", "box", "kind", value="ball"), "`parts.box.kind` is `ball`"),
        (put("parts", "box", "size", value=[1, 2]), "a list of three numbers"),
        (put("parts", "box", "grip_tolerance", value=0), "a number above 0"),
        (put("parts", "box", "grip_angle_deg", value=200), "a number above 0 to 180"),
        (put("parts", "box", "weight", value=1), "unknown key `weight`"),
        (put("parts", "box", "at", value={}), "a list of tables"),
        (put("parts", "box", "grips", value=[{"zz": 1}]), "unknown key `zz`"),
        (put("parts", "1x", value={"size": [1, 1, 1]}), "`1x` is not a name for parts"),
        (put("places", "infeed", "pitsch", value=0), "unknown key `pitsch`"),
        (put("places", "in feed", value={}), "`in feed` is not a name for places"),
        (
            put("scene", "objects", value=[{"name": "box", "size": [1, 1, 1]}]),
            "a kind of parts are called",
        ),
    ],
)
def test_mistakes(change: Callable[[dict[str, Any]], None], message: str) -> None:
    cell, d = read(change)
    assert cell is None
    assert any(message in e.message + e.hint for e in d.errors), [e.message for e in d.errors]


# --- beside other things ---------------------------------------------------------------------------


@pytest.fixture
def keeper(cell: RobotCell, request: pytest.FixtureRequest) -> PartKeeper:
    backend = open_backend("bullet", cell, looks=False)
    request.addfinalizer(backend.close)
    found = PartKeeper(cell, backend)
    found.begin()
    found.handle("feeder", FEED, None)
    found.handle("robot", TAKE, matrix_of(ABOVE))
    return found


@pytest.mark.bullet
@pytest.mark.parametrize(
    ("at", "message"),
    [
        (moved(ABOVE, x=0.6, z=-0.5), ""),  # on the floor
        (moved(ABOVE, x=0.6, z=-0.496), ""),  # a little above
        (
            moved(ABOVE, x=0.6, z=-0.4),
            "in the air: `floor`, the nearest thing below it, is 100.0 mm away",
        ),
        (moved(ABOVE, x=0.6, z=0.4), "in the air: there is nothing below it within 500 mm"),
        (moved(ABOVE, x=0.301, z=-0.3), "in the air: `floor`"),  # beside the table is not on it
        (moved(ABOVE, x=0.29, z=-0.5), "which is 10.0 mm deep in `table` (at most 1 mm)"),
        (moved(ABOVE, z=-0.01), "which is 10.0 mm deep in `table`"),
    ],
)
def test_where_a_part_may_be_released(keeper: PartKeeper, at: Pose, message: str) -> None:
    if not message:
        assert keeper.handle("robot", RELEASE, matrix_of(at)).part == "box.1"
        return
    with pytest.raises(PartFault) as fault:
        keeper.handle("robot", RELEASE, matrix_of(at))
    assert message in str(fault.value)


@pytest.mark.bullet
def test_parts_stand_on_parts(keeper: PartKeeper) -> None:
    keeper.handle("robot", RELEASE, matrix_of(moved(ABOVE, x=0.6, z=-0.5)))
    keeper.handle("feeder", FEED, None)
    keeper.handle("robot", TAKE, matrix_of(ABOVE))
    on_top = keeper.handle("robot", RELEASE, matrix_of(moved(ABOVE, x=0.6, z=-0.35)))
    assert on_top.part == "box.2" and on_top.pose.z == pytest.approx(0.225)


@pytest.mark.bullet
def test_a_part_of_the_start_overlaps_nothing(request: pytest.FixtureRequest) -> None:
    cell, _ = read(put("parts", "box", "at", value=[{"x": 1.5, "y": -0.6, "z": 0.56}]))
    backend = open_backend("bullet", cell, looks=False)
    request.addfinalizer(backend.close)
    with pytest.raises(
        PartFault, match=r"`box\.1`, as `\[parts\.box\]` places it, is 15.0 mm deep in `table`"
    ):
        PartKeeper(cell, backend).begin()
