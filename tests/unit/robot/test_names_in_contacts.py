"""Names of things in contact rules that nobody has written: they stand for themselves, whatever signs they have."""

from __future__ import annotations

import fnmatch
from pathlib import Path
from typing import Any

import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.scene import load

pytest.importorskip("eaik")  # the solver of the arm, which does not come with every Python


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
