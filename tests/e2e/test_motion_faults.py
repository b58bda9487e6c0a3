"""What stops a cell: a pose out of reach, a line that leaves it, a collision: script line, transition, robot, pose."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult
from pn2code.trace.replay import replay

pytestmark = pytest.mark.usefixtures("quick_build", "generated_once")

POSE = r"TCP pose \(-?[\d.]+, -?[\d.]+, -?[\d.]+ mm; -?[\d.]+, -?[\d.]+, -?[\d.]+ deg\)"


def run(
    root: Path, tmp_path: Path, backend: str, first: str, last: str, *, checked: bool = True
) -> RunResult:
    input_file = tmp_path / "points.txt"
    input_file.write_text(f"5\n{first}\n{last}\n")
    options = RunOptions(out=tmp_path / "out", input=input_file, backend=backend, checked=checked)  # type: ignore[arg-type]
    d = Diagnostics()
    result = run_cell(root / "examples" / "riveting", options, d)
    assert result is not None, [e.message for e in d.errors]
    return result


def check_stopped(result: RunResult, tmp_path: Path, root: Path) -> None:
    """The run says why, in all its files; what did occur is still an occurrence sequence of the net."""
    record = result.record
    assert record.verdict == "failed"
    assert re.search(POSE, record.reason)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert (summary["verdict"], summary["reason"]) == ("failed", record.reason)
    last = json.loads((tmp_path / "out" / "cell.trace.jsonl").read_text().splitlines()[-1])
    assert last["why"] == "failed"
    # The supervisor was told: its own trace ends with the reason.
    told = (tmp_path / "out" / "supervisor.trace.jsonl").read_text().splitlines()[-1]
    assert record.reason[:40] in json.loads(told)["why"]
    net = load(root / "examples" / "riveting" / "cell.cpn", Diagnostics())
    assert net is not None
    found = replay(
        tmp_path / "out" / "cell.trace.jsonl", net, storage=result.prepared.config.storage
    )
    assert found.ok, found.message()


@pytest.mark.cc
def test_pose_out_of_reach(root: Path, tmp_path: Path) -> None:
    poses = "9750 5898.8 2135.05 -105 0 0", "9950 5898.8 2135.05 -105 0 0"
    with pytest.raises(AssertionError, match="reach: .* commands a move that is not possible"):
        run(
            root, tmp_path, "fake", *poses
        )  # what is checked is the cell with the file that is given
    result = run(root, tmp_path, "fake", *poses, checked=False)
    check_stopped(result, tmp_path, root)
    reason = result.record.reason
    assert re.match(
        r"robot1\.tdl:\d+ \(net transition Cell\.Robot1\.MoveJoint\): robot `robot1`: ", reason
    )
    assert "out of reach" in reason
    assert result.record.time == 0.0


@pytest.mark.cc
def test_a_line_that_leaves_the_reach(root: Path, tmp_path: Path) -> None:
    """The last pitch of a seam that is too long: what went well before is in the results."""
    result = run(
        root, tmp_path, "fake", "5750 5898.8 2135.05 -105 0 0", "7950 5898.8 2135.05 -105 0 0"
    )
    check_stopped(result, tmp_path, root)
    assert "(net transition Cell.Robot1.MoveLinear)" in result.record.reason
    assert 0 < result.summary["counts"]["rivets"] < 7


@pytest.mark.cc
@pytest.mark.bullet
def test_collision(root: Path, tmp_path: Path) -> None:
    """References 200 mm inside the fuselage: the tool would go through the skin on a joint move."""
    result = run(
        root, tmp_path, "bullet", "5750 6098.8 2135.05 -105 0 0", "6750 6098.8 2135.05 -105 0 0"
    )
    check_stopped(result, tmp_path, root)
    reason = result.record.reason
    assert "`panel/skin` collide" in reason
    assert "robot1/tool" in reason
    assert re.search(
        r"robot1\.tdl:\d+ \(net transition Cell\.Robot1\.MoveJoint\): robot1: joint 5750", reason
    )
