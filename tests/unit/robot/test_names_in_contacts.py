"""Names of things in contact rules that nobody has written: they stand for themselves, whatever signs they have."""

from __future__ import annotations

import fnmatch
from pathlib import Path
from typing import Any

import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.scene import load

pytest.importorskip("eaik")  # the solver of the arm, which does not come with every Python


def said_of(contacts: list[dict[str, Any]]) -> list[tuple[str, str]]:
    """The errors about rules of contacts in a cell of an arm, a door, a belt, a shelf and boxes: words and hints."""
    door = {"from": 0.0, "to": 0.5, "objects": [{"name": "leaf", "size": [0.1, 0.1, 0.1]}]}
    belt = {"kind": "belt", "length": 1.0, "width": 0.2, "pose": {"x": 5.0, "z": 0.5}}
    data: dict[str, Any] = {
        "robots": {"arm": {"model": "gp25", "tool": "vacuum_gripper", "base": {"z": 0.5}}},
        "devices": {"mill": {"instance": "Mill", "axes": {"door": door, "belt": belt}}},
        "parts": {"box": {"size": [0.1, 0.1, 0.1]}},
        "scene": {
            "objects": [{"name": "shelf", "size": [0.1, 0.1, 0.1], "pose": {"x": 3.0, "z": 0.1}}],
            "contacts": contacts,
        },
    }
    data["robots"]["arm"]["home"] = [0, 0, 0, 0, -90, 0]
    d = Diagnostics()
    load(data, Path(), lambda *_: Origin("cell.toml"), d)
    return [(e.message, e.hint) for e in d.errors]


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("arm/link_9", "did you mean `arm/link_"),
        ("arm/tool_tipp", "did you mean `arm/tool_tip`"),
        ("arm", "there are `arm/base_link`, "),
        ("mill/dor", "did you mean `mill/door`"),
        ("shelf/board", "it is `shelf`"),
        ("box", "did you mean `box.1`?"),
    ],
)
def test_a_part_that_nothing_has_is_refused(name: str, hint: str) -> None:
    """A rule about it would do nothing."""
    ((message, hinted),) = said_of([{"a": "shelf", "b": name}])
    assert message == (
        f"`b` of the 1st of `scene.contacts` is `{name}`, but a part of a robot or of the scene is expected"
    )
    assert hinted.startswith(hint)


def test_parts_that_are_there_are_accepted() -> None:
    names = ["*", "arm/*", "arm/link_?", "arm/tool_*", "arm/box.2", "box.7", "box.*", "*/box.1"]
    names += ["floor", "panel/skin", "arm_pedestal", "mill/door", "mill/belt", "shel*", "*/link_6"]
    assert said_of([{"a": name, "b": "shelf"} for name in names]) == []


@pytest.mark.parametrize("name", ["*", "shelf[1]", "a?"])
def test_a_thing_with_signs_of_patterns(name: str, tmp_path: Path) -> None:
    """A part that is carried may touch this thing, and not the other arm for its sake."""
    arm: dict[str, Any] = {
        "model": "ur5e",
        "tool": "vacuum_gripper",
        "base": {"z": 0.5},
        "home": [0, -90, 90, -90, -90, 0],
    }
    thing = {"name": name, "kind": "box", "size": [0.1, 0.1, 0.1], "pose": {"x": 3.0, "z": 0.05}}
    data: dict[str, Any] = {
        "robots": {"left": arm, "right": {**arm, "base": {"x": 9.0}}},
        "scene": {"objects": [thing]},
        "parts": {"box": {"kind": "box", "size": [0.1, 0.1, 0.1]}},
    }
    d = Diagnostics()
    cell = load(data, tmp_path, lambda *_: Origin("cell.toml"), d)
    assert cell is not None, [e.message for e in d.errors]
    rules = [r for r in cell.scene.contacts if fnmatch.fnmatchcase("left/box.1", r.a)]
    assert any(fnmatch.fnmatchcase(name, r.b) for r in rules)
    assert not any(fnmatch.fnmatchcase("right/link_3", r.b) for r in rules)
