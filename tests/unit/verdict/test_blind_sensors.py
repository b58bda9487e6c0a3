"""Sensors that look at a place where no part can ever stand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from pn2code.cell.config import SensorConfig
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.commands import Handling, Pose
from pn2code.verdict.scene_sensors import blind

HERE = Pose(1.0, 0.0, 0.5, 0.0, 0.0, 0.0)
THERE = Pose(1.0, 0.01, 0.5, 0.0, 0.0, 0.0)
AT = Origin("cell.toml")


def primitive(effect: Any, place: str = "") -> Any:
    return SimpleNamespace(command="tool", handling=Handling(effect, "box", place))


MOVES = SimpleNamespace(command="move_external", handling=None)


@pytest.mark.parametrize(
    ("part", "at", "primitives", "says"),
    [
        ("box", (), [primitive("creates", "infeed")], ""),
        ("", (), [primitive("creates", "infeed")], ""),
        ("box", (HERE,), [], ""),
        ("box", (), [primitive("takes")], "no part of kind `box` ever comes into the cell"),
        ("", (), [], "no part ever comes into the cell"),
        ("can", (HERE,), [primitive("creates", "infeed")], "no part of kind `can` ever comes into"),
        ("box", (THERE,), [], "comes into the cell at `infeed`, and no tool takes one there"),
        ("box", (THERE,), [primitive("takes"), primitive("releases")], ""),
        ("box", (THERE,), [MOVES], ""),
    ],
)
def test_blind_sensors(part: str, at: tuple[Pose, ...], primitives: list[Any], says: str) -> None:
    parts = {
        "box": SimpleNamespace(at=at, tolerance=0.005),
        "can": SimpleNamespace(at=(), tolerance=0.005),
    }
    cell: Any = SimpleNamespace(parts=parts, places={"infeed": HERE})
    config: Any = SimpleNamespace(
        sensors=(SensorConfig("eye", "b", "", None, 1, AT, "infeed", part),),
        primitives=dict(enumerate(primitives)),
        locator=SimpleNamespace(origin=lambda *_: AT),
    )
    d = Diagnostics()
    blind(cell, config, "", d)
    assert [says in x.message and x.code for x in d.items] == (["sensor-blind"] if says else [])
