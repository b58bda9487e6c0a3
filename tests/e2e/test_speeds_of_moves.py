"""The speed of a move: in `[primitives]`, or beside the pose in the net; in scripts, in proofs, in runs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code.cli.main import app
from pn2code.conform.cell import ProgramComparison
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import Generated, generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

ROBOT = """model = "kr120_r2500"
base = { x = -1.0, y = 0.0, z = 0.0, yaw = 0.0 }
"""
AT = "fun at n = {x = 500.0 + 100.0 * Real.fromInt n, y = 0.5, z = 1200.0, rx = 0.0, ry = 90.0, rz = 0.0}"


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def cell(folder: Path, speed: str = "", command: str = "move_joint", key: str = "") -> Path:
    """The small cell; its moves have a speed that the net says, or cell.toml."""
    net = changed(NET, NET[NET.index("fun at n") : NET.index("  var n, k")], AT + "\n")
    if speed:
        net = changed(
            net, "fun moveJoint (p : POSE) = ()", "fun moveJoint (p : POSE, v : real) = ()"
        )
        net = changed(net, "action moveJoint p", f"action moveJoint (p, {speed})")
    frame = ', frame = "world"' if command == "move_linear" else ""
    toml = changed(TOML, '{ command = "move_joint" }', f'{{ command = "{command}"{frame}{key} }}')
    return write(folder, net, toml + ROBOT)


def made(folder: Path) -> Generated:
    d = Diagnostics()
    found = generate(folder, d, checked=False)
    assert found is not None, [e.message for e in d.errors]
    return found


def script(found: Generated) -> str:
    return next(f.text for f in found.files if f.path == "robot1.tdl")


@pytest.mark.parametrize(
    ("speed", "command", "key", "written"),
    [
        ("", "move_joint", "", "move $joint p\n"),
        ("", "move_joint", ", speed = 0.3", "at 30 %\n"),
        ("", "move_linear", ", speed = 0.05", "in world at 50 mm/s\n"),
        ("57.0", "move_joint", "", "at 57 %\n"),
        ("#x p / 10.0", "move_joint", "", "at p.x / 10.0 / 1 mm * 1 %\n"),
        ("#x p / 7.0", "move_linear", "", "in world at "),
    ],
)
def test_scripts_move_as_the_net_says(
    speed: str, command: str, key: str, written: str, tmp_path: Path
) -> None:
    found = made(cell(tmp_path, speed, command, key))
    text = script(found)
    line = next(x for x in text.splitlines(keepends=True) if "move $" in x and "home" not in x)
    assert line.endswith(written) or (written.endswith("at ") and written in line), line
    owner = found.partition.owners[1]
    d = Diagnostics()
    assert ProgramComparison(found).script(owner, text, d).deviation is None
    slower = line.rstrip("\n") + " * 0.5\n" if " at " in line else line.rstrip("\n") + " at 50 %\n"
    assert ProgramComparison(found).script(owner, changed(text, line, slower), d).deviation


@pytest.mark.parametrize(
    ("speed", "command", "message"),
    [
        ("0.0", "move_joint", "no robot can move at 0 %"),
        (
            "101.0",
            "move_joint",
            "no robot can move at 101 %: a speed is above zero, and at most 100 %",
        ),
        ("~5.0", "move_linear", "no robot can move at -5 mm/s"),
    ],
)
def test_speeds_that_are_not_possible(
    speed: str, command: str, message: str, tmp_path: Path
) -> None:
    d = Diagnostics()
    assert generate(cell(tmp_path, speed, command), d, checked=False) is None
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]


@pytest.mark.parametrize(
    ("key", "speed", "message"),
    [
        (", speed = 0", "", "`speed` is 0, but must be at least 0.0001, at most 1, and finite"),
        (", speed = 30", "", "`speed` is 30, but must be at least 0.0001, at most 1, and finite"),
        (", speed = 0.3", "5.0", "`moveJoint` takes a speed, and the entry has one, too"),
    ],
)
def test_mistakes_in_the_entry(key: str, speed: str, message: str, tmp_path: Path) -> None:
    d = Diagnostics()
    assert generate(cell(tmp_path, speed, key=key), d, checked=False) is None
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]


@pytest.mark.parametrize(
    ("speed", "answer"), [("#x p / 10.0", "yes"), ("#x p - 600.0", "no"), ("#x p", "no")]
)
def test_a_speed_that_stops_the_script_stops_the_cell(
    speed: str, answer: str, tmp_path: Path
) -> None:
    """600, 700 and 800 mm: a tenth of it is possible, 0 at the first, and more than 100 % are not."""
    done = CliRunner().invoke(
        app, ["verify", str(cell(tmp_path, speed)), "--json", "--no-medium", "--most-traces", "0"]
    )
    checks = json.loads(done.stdout)["controller"]
    assert {c["check"]: c["answer"] for c in checks}["non-blocking"] == answer, done.stdout


def test_a_slower_move_takes_longer(tmp_path: Path) -> None:
    times = []
    for key in ("", ", speed = 0.1"):
        d = Diagnostics()
        options = RunOptions(tmp_path / f"run{key}", backend="fake", looks=False, checked=False)
        seen = run_cell(cell(tmp_path / f"cell{key}", key=key), options, d)
        assert seen is not None and seen.record.verdict == "finished", [e.message for e in d.errors]
        times.append(seen.record.time)
    assert times[1] > 1.5 * times[0]
