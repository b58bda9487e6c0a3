"""The table of channels that `check` prints."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

from helpers import small_cell
from pn2code.cli.main import app

ARM = """model = "kr120_r2500"
tool = "counterpoint"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
"""


def checked(cell: Path, *options: str) -> str:
    done = CliRunner().invoke(app, ["check", str(cell), *options])
    assert done.exit_code == 0, done.output
    return done.stdout


def test_each_channel_with_its_kind_and_what_decided_it(tmp_path: Path) -> None:
    kind = 'file = "data.robcad"\nkind = "data"'
    assert kind in small_cell.TOML
    toml = small_cell.TOML.replace(kind, 'file = "data.robcad"') + ARM
    cell = small_cell.write(tmp_path / "cell", toml=toml)
    lines = {" ".join(line.split()) for line in checked(cell).splitlines()}
    assert {
        "place from to colour set kind decided by file",
        "Top.data supervisor robot1 POSE data 6 values data.robcad",
        "Top.flag supervisor robot1 INT flag cell.toml flag.robcad",
    } <= lines
    (row,) = [
        c for c in json.loads(checked(cell, "--json"))["channels"] if c["file"] == "data.robcad"
    ]
    assert row == {
        "place": "Top.data",
        "writer": "supervisor",
        "reader": "robot1",
        "colset": "POSE",
        "kind": "data",
        "why": "6 values",
        "file": "data.robcad",
    }


def test_a_net_has_none(root: Path) -> None:
    assert "Channels" not in checked(root / "examples" / "philosophers")
    assert "channels" not in json.loads(checked(root / "examples" / "philosophers", "--json"))
