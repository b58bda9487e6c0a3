"""Poses that arms are told, in scripts and messages: `verify` and `generate` say what a run would come upon."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from helpers.small_cell import NET, TOML, write
from pn2code.cell.divide import divide
from pn2code.cli.main import app
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics, render
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.verify.controller.poses import Poses
from pn2code.verify.exploring import result
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

ARM = """model = "kr120_r2500"
tool = "counterpoint"
base = { x = 0.0, y = 0.0, z = 0.0, yaw = 0.0 }
"""
AT = "fun at n = {x = 100.0 * Real.fromInt n, y = 0.5, z = 0.0, rx = 0.0, ry = 0.0, rz = 90.0}"


def changed(text: str, *pairs: tuple[str, str]) -> str:
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def slots(pitch: float, *more: tuple[str, str], begin: float = 1200.0) -> str:
    """Pieces in a row that leads away from the arm: the message says where the arm shall go."""
    at = (
        f"fun at n = {{x = {begin} + {pitch} * Real.fromInt n, y = 0.0, z = 1200.0, rx = 0.0, ry = 90.0, "
        "rz = 0.0}"
    )
    return changed(NET, (AT, at), *more)


def verified(
    cell: Path, *options: str, channel_model: bool = False
) -> tuple[Result, dict[str, Any]]:
    """What `verify` says, and its checks by name; those of the medium take longer, and say nothing of poses."""
    left_out = [] if channel_model else ["--no-medium"]
    done = CliRunner().invoke(app, ["verify", str(cell), "--json", *left_out, *options])
    rows = json.loads(done.stdout)["controller"]
    return done, {row["check"]: row for row in rows}


def ran(cell: Path) -> tuple[str, str]:
    """Verdict and reason of a run without a picture."""
    d = Diagnostics()
    options = RunOptions(out=cell / "run", backend="fake", looks=False, checked=False)
    result = run_cell(cell, options, d)
    assert result is not None, render.report(d)
    return result.record.verdict, result.record.reason


def test_poses_in_messages_within_reach(tmp_path: Path) -> None:
    cell = write(tmp_path, slots(50.0), TOML + ARM)
    done, checks = verified(cell, channel_model=True)
    assert done.exit_code == 0, done.output
    assert checks["reach"]["answer"] == "yes"
    assert checks["reach"]["value"] == 3
    assert "each of the 3 poses" in checks["reach"]["says"]
    assert ran(cell)[0] == "finished"


def test_a_pose_in_a_message_out_of_reach(tmp_path: Path) -> None:
    """The third piece lies too far away: so say verify, generate and the run."""
    cell = write(tmp_path, slots(900.0), TOML + ARM)
    done, checks = verified(cell, "--traces", str(tmp_path / "traces"))
    assert done.exit_code == 1, done.output
    reach = checks["reach"]
    assert reach["answer"] == "no"
    assert (
        "`Top.Robot.Move` commands a move that is not possible: robot `robot1`: " in reach["says"]
    )
    assert "(3900.00, 0.00, 1200.00 mm" in reach["says"]
    trace = Path(reach["evidence"][0]["trace"]).read_text().splitlines()
    steps = [json.loads(x) for x in trace if "transition" in json.loads(x)]
    assert len(steps) == reach["evidence"][0]["steps"]
    # Two pieces are done, or skipped; the third one has been told.
    told = [x for x in steps if x["transition"].endswith(".Next")]
    assert [x["binding"]["n"] for x in told] == [1, 2, 3]
    # What needs the cell to go on is not said.
    assert checks["non-blocking"]["answer"] == "unknown"
    assert "`reach`" in checks["non-blocking"]["says"]
    verdict, reason = ran(cell)
    assert verdict == "failed"
    assert reach["says"].split("possible: ")[1] in reason
    refused = CliRunner().invoke(app, ["generate", str(cell), "-o", str(tmp_path / "out")])
    assert refused.exit_code == 1
    assert "reach: " in refused.output
    assert "out of reach" in refused.output or "joint limits" in refused.output


@pytest.mark.parametrize("is_exact", [True, False])
def test_a_move_that_never_comes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_exact: bool
) -> None:
    """A message out of reach that the robot takes without moving.

    Where the space is too large for its bindings to be told, it is looked up whether the robot ever moves there.
    """
    if not is_exact:
        monkeypatch.setattr(result, "_bindings", lambda found: None)
    net = slots(
        900.0,
        (
            "      out flag : MOVE\n",
            "      out flag : (if n = 3 then HOME else MOVE)\n",
        ),
        (
            "    trans GoHome guard [k = HOME] code action moveHome ()\n      in Told : k\n",
            "    trans GoHome guard [k = HOME] code action moveHome ()\n      in Told : k\n      in data : p\n",
        ),
        ("out flag : HOME\n", "out flag : HOME\n      out data : at 0\n"),
    )
    cell = write(tmp_path, net, TOML + ARM)
    done, checks = verified(cell)
    assert checks["reach"]["answer"] == "yes", done.output
    says = {
        True: "each of the 2 poses that arms are told can be reached",
        False: "each of the 3 poses that arms are told can be reached; one more that is on its way as something else "
        "is never moved to, which was looked up in another exploration",
    }
    assert checks["reach"]["says"] == says[is_exact]
    assert ran(cell)[0] == "finished"


def test_a_move_that_comes_from_a_computation(tmp_path: Path) -> None:
    """The message is a number; the code segment makes a pose of it."""
    net = slots(
        900.0,
        ("    place data : POSE\n", "    place data : INT\n"),
        ("    place data port out : POSE\n", "    place data port out : INT\n"),
        ("    place data port in : POSE\n", "    place data port in : INT\n"),
        ("      out data : at n\n", "      out data : n\n"),
        ("code input (p); action moveJoint p", "code input (n); action moveJoint (at n)"),
        ("      in data : p\n", "      in data : n\n"),
    )
    cell = write(tmp_path, net, TOML + ARM)
    done, checks = verified(cell)
    assert checks["reach"]["answer"] == "no", done.output
    assert ran(cell)[0] == "failed"


def test_a_move_that_nothing_decides(tmp_path: Path) -> None:
    """The script names the pose itself, so that no token has to do with it."""
    net = slots(50.0, ("action moveJoint p", "action moveJoint (at 90)"))
    cell = write(tmp_path, net, TOML + ARM)
    reach = verified(cell)[1]["reach"]
    assert reach["answer"] == "no"
    assert "(5700.00, 0.00, 1200.00 mm" in reach["says"]
    assert ran(cell)[0] == "failed"


def test_at_a_limit(tmp_path: Path) -> None:
    """What is told in the part that was seen is certain, the rest is not known."""
    cell = write(tmp_path / "far", slots(900.0, begin=2900.0), TOML + ARM)
    states = ("--max-states", "20")
    assert verified(cell, *states)[1]["reach"]["answer"] == "no"
    cell = write(tmp_path / "near", slots(50.0), TOML + ARM)
    assert verified(cell, *states)[1]["reach"]["answer"] == "unknown"


def test_in_one_of_the_layouts(tmp_path: Path) -> None:
    """A layout in which the arm stands too far away is named."""
    layouts = "[layouts.front]\n[layouts.back.robots.robot1]\nbase = { x = -2.0, y = 0.0, z = 0.0, yaw = 0.0 }\n"
    cell = write(tmp_path, slots(50.0, begin=1400.0), TOML + ARM + layouts)
    reach = verified(cell)[1]["reach"]
    assert reach["answer"] == "no"
    assert "(layout `back`)" in reach["says"]


def test_moves_that_depend_on_a_reference(tmp_path: Path) -> None:
    """What a reference holds is in no place: nothing is said."""
    net = slots(
        50.0,
        ("  var n, k: INT;\n", "  var n, k: INT;\n  globref offset = 0;\n"),
        ("action moveJoint p", "action (if !offset = 0 then moveJoint p else moveJoint (at 0))"),
    )
    opened = open_net(write(tmp_path, net, TOML + ARM), {})
    d = Diagnostics()
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None and opened.config is not None
    poses = Poses(partition, opened.config.primitives, NoArms(), {})
    assert [t.short for t in poses.moving] == ["Move"]
    found = explore(opened.flat, {}, Limits(threads=1), d)
    told = poses.told(found)
    assert "reads a reference" in told.open
    assert not told.bad


class NoArms:
    """Reach nothing."""

    robots = frozenset({"robot1"})

    def why_unreachable(self, robot: str, command: object) -> str:
        return f"{robot} cannot"


def test_a_robot_without_an_arm(tmp_path: Path) -> None:
    """Where nothing is said of its arm, nothing is said of its reach."""
    assert "reach" not in verified(write(tmp_path))[1]
