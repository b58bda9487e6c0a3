"""A tool has a name that no part or axis has of a robot that carries it: `left/plate` would be both."""

from __future__ import annotations

import tomllib
from pathlib import Path
from random import Random
from typing import Any

import pytest

from helpers.changing_cells import changing_cell
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.scene import load


@pytest.mark.parametrize(("axis", "is_right"), [("plate", True), ("gripper", False)])
def test_no_tool_is_called_as_a_turntable(axis: str, is_right: bool, tmp_path: Path) -> None:
    data: dict[str, Any] = tomllib.loads(changing_cell(Random(3))[1])
    data["robots"]["left"]["axes"] = {
        axis: {
            "kind": "turntable", "pose": {"x": 3.0, "z": 0.5}, "from": -90, "to": 90, "radius": 0.3,
        },
    }  # fmt: skip
    d = Diagnostics()
    found = load(data, tmp_path, lambda *_: Origin("cell.toml"), d)
    assert (found is not None) is is_right, [e.message for e in d.errors]
    if not is_right:
        (error,) = d.errors
        assert "robot `left` are called `gripper`" in error.message
