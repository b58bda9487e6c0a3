"""Seven axes, a SCARA, a gantry and coupled axes, from the net to the arm: scripts, checks, geometry and runs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from helpers.small_cell import NET, TOML, write
from pn2code.cli.main import app
from pn2code.conform.cell import ProgramComparison
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

DOWN = "rx = 180.0, ry = 0.0, rz = {yaw}"
ARMS = {
    "iiwa14_r820": ("[0, 30, 0, -90, 0, 60, 0]", (500.0, -80.0, 400.0), 120.0, "arm_angle = 20.0"),
    "cobra_s600": ("[20, 60, 0.05, 0]", (400.0, -80.0, 267.0), 0.0, ""),
    "gantry_3000": ("[1.0, 0.2, 0.3, 0]", (1500.0, -80.0, 900.0), 0.0, ""),
    "lrmate200id": ("[0, 10, -20, 0, -60, 0]", (400.0, -80.0, 350.0), 0.0, ""),
}


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def cell(folder: Path, model: str, entry: str = "", tilt: float = 0.0) -> Path:
    """The small cell with another arm, whose tool looks down at places beside each other."""
    home, (x, y, z), yaw, key = ARMS[model]
    turn = DOWN.format(yaw=yaw).replace("180.0", str(180.0 - tilt))
    at = f"fun at n = {{x = {x}, y = 40.0 * Real.fromInt n - {-y}, z = {z}, {turn}}}"
    net = changed(NET, NET[NET.index("fun at n") : NET.index("  var n, k")], at + "\n")
    robot = f'model = "{model}"\nbase = {{ x = 0.0 }}\nhome = {home}\n{key}\n'
    entry = entry or '{ command = "move_linear", frame = "world", approach = 0.05, speed = 0.2 }'
    return write(folder, net, changed(TOML, '{ command = "move_joint" }', entry) + robot)


def ask(*words: str) -> Result:
    return CliRunner().invoke(app, list(words))


@pytest.mark.bullet
@pytest.mark.parametrize("model", ["iiwa14_r820", "cobra_s600"])
def test_a_cell_is_checked_in_space_and_runs(model: str, tmp_path: Path) -> None:
    where = cell(tmp_path / "cell", model)
    done = ask("check", str(where), "--geometry", "--json")
    assert done.exit_code == 0, done.output
    d = Diagnostics()
    options = RunOptions(tmp_path / "run", backend="bullet", looks=False, checked=False)
    found = run_cell(where, options, d)
    assert found is not None, [e.message for e in d.errors]
    assert found.record.verdict == "finished", found.record.reason


def test_the_arm_angle_comes_into_the_script_and_conform_sees_it(tmp_path: Path) -> None:
    entry = '{ command = "move_linear", frame = "world", approach = 0.05, arm_angle = 30.0 }'
    d = Diagnostics()
    found = generate(cell(tmp_path, "iiwa14_r820", entry), d, checked=False)
    assert found is not None, [e.message for e in d.errors]
    text = next(f.text for f in found.files if f.path == "robot1.tdl")
    assert "move $joint before(p, 50 mm) in world with $arm angle = 30 deg at 100 %" in text
    assert "move $linear p in world with $arm angle = 30 deg" in text
    owner = found.partition.owners[1]
    for program, is_same in (
        (text, True),
        (changed(text, "angle = 30 deg", "angle = 31 deg"), False),
    ):
        report = ProgramComparison(found).script(owner, program, Diagnostics())
        assert report is not None and (report.deviation is None) == is_same


@pytest.mark.parametrize("model", ["gantry_3000"])
def test_a_pose_that_cannot_be_had_is_no_yes(model: str, tmp_path: Path) -> None:
    where = str(cell(tmp_path, model, '{ command = "move_joint" }', tilt=5.0))
    done = ask("verify", where, "--json", "--no-medium", "--most-traces", "0")
    checks = json.loads(done.stdout)["controller"]
    (found,) = [c for c in checks if c["check"] == "non-blocking"]
    assert found["answer"] == "unknown"
    assert "it tilts the tool by 5 deg" in done.stdout


@pytest.mark.parametrize(
    ("model", "values", "says"),
    [
        ("cobra_s600", "a1 = 10.0, a2 = 20.0, a3 = 100.0, a4 = 0.0", ""),
        ("cobra_s600", "a1 = 10.0, a2 = 20.0, a3 = 300.0, a4 = 0.0", "300.00 mm, outside"),
        (
            "cobra_s600",
            ", ".join(f"a{i} = 0.0" for i in range(1, 7)),
            "a joint position has 4 finite numbers",
        ),
        ("lrmate200id", "a1 = 0.0, a2 = ~5.0, a3 = 206.0, a4 = 0.0, a5 = 0.0, a6 = 0.0", "counted"),
    ],
)
def test_joint_positions_in_nets(model: str, values: str, says: str, tmp_path: Path) -> None:
    where = cell(tmp_path / "cell", model, '{ command = "move_axes" }')
    net = NET.replace("moveJoint (p : POSE)", "moveJoint (q : AXES)")
    record = " * ".join(f"{x.split(' =')[0]}:REAL" for x in values.split(", "))
    net = changed(net, "  val MOVE", f"  colset AXES = record {record};\n  val MOVE")
    net = changed(net, "action moveJoint p", f"action moveJoint {{{values}}}")
    write(where, net, (where / "cell.toml").read_text())
    done = ask("check", str(where))
    assert (done.exit_code == 0) == (not says), done.output
    assert says in " ".join(done.output.split())
    if not says:
        d = Diagnostics()
        options = RunOptions(tmp_path / "run", backend="fake", looks=False, checked=False)
        found = run_cell(where, options, d)
        assert found is not None, [e.message for e in d.errors]
        assert found.record.verdict == "finished", found.record.reason
        assert any(x.label == "axes" and x.end > x.start for x in found.record.actions)


@pytest.mark.parametrize(
    ("has_axes", "command", "says"),
    [
        (False, 'move_joint", arm_angle = 3.0', "has an `arm_angle`, but its arm `cobra_s600` has 4 axes"),
        (True, 'move_axes"', "has 4 numbers, one for each axis of its arm `cobra_s600`, but 6"),
    ],
)  # fmt: skip
def test_what_an_arm_cannot_be_told_whatever_the_values(
    has_axes: bool, command: str, says: str, tmp_path: Path
) -> None:
    where = cell(tmp_path / "cell", "cobra_s600", f'{{ command = "{command} }}')
    if has_axes:
        record = " * ".join(f"a{i}:REAL" for i in range(1, 7))
        fields = ", ".join(f"a{i} = #x p" for i in range(1, 7))
        net = NET.replace("moveJoint (p : POSE)", "moveJoint (q : AXES)")
        net = changed(net, "  val MOVE", f"  colset AXES = record {record};\n  val MOVE")
        net = changed(net, "action moveJoint p", f"action moveJoint {{{fields}}}")
        write(where, net, (where / "cell.toml").read_text())
    done = ask("check", str(where))
    assert done.exit_code == 1
    assert says in " ".join(done.output.replace("|", " ").split()), done.output


def test_a_map_of_bases_knows_the_arm_angle(tmp_path: Path) -> None:
    where = cell(tmp_path / "cell", "iiwa14_r820")
    done = ask(
        "reach", str(where), "--robot", "robot1", "--around", "0.2", "--steps", "3", "--json",
        "-o", str(tmp_path / "map"),
    )  # fmt: skip
    assert done.exit_code in (0, 1), done.output
    assert '"reach": 1.0' in done.stdout
