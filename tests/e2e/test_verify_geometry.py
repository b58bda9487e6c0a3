"""`verify CELL --geometry`: what is said of arms in space counts for the verdict like other answers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from helpers.meeting_cell import meeting_cell
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]


def asked(folder: Path, *more: str) -> Result:
    words = ["verify", str(folder), "--no-medium", "--geometry", "--traces", str(folder / "traces")]
    return CliRunner().invoke(app, [*words, *more])


@pytest.mark.parametrize("apart", [True, False])
def test_arms_that_meet_are_a_no_of_the_verdict(tmp_path: Path, apart: bool) -> None:
    meeting_cell(tmp_path, guarded=apart)
    done = asked(tmp_path, "--json")
    row: dict[str, Any] = json.loads(done.stdout)
    (layout,) = row["geometry"]["layouts"]
    assert (layout["moves_answer"], layout["pairs_answer"]) == ("yes", "yes" if apart else "no")
    assert done.exit_code == (0 if apart else 1)
    if not apart:
        files = [Path(p["run"]["trace"]) for p in layout["pairs"]]
        assert files and all(f.parent == tmp_path / "traces" and f.exists() for f in files)
    screen = " ".join(asked(tmp_path).stdout.split())
    said, end = ("yes", "Verdict: YES. All") if apart else ("NO", "Verdict: NO. 1 of")
    assert "Arms in space yes each move" in screen and f" {said} no two arms collide" in screen
    assert end in screen and "in space: `check" not in screen
    assert ("may be under way at once" in screen) is not apart


def test_where_the_time_is_up_nothing_is_known_of_arms(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pn2code.base.deadline import TimeIsOverError
    from pn2code.geometry import verified

    def late(*_args: object) -> None:
        raise TimeIsOverError

    monkeypatch.setattr(verified, "examine", late)
    meeting_cell(tmp_path, guarded=True)
    done = asked(tmp_path, "--json")
    row = json.loads(done.stdout)["geometry"]
    assert row == {"answer": "unknown", "why": "the limit of time was reached", "layouts": []}
    assert done.exit_code == 3


def test_a_net_without_a_cell_and_a_report_are_refused(tmp_path: Path) -> None:
    meeting_cell(tmp_path, guarded=True)
    done = asked(tmp_path, "--report", str(tmp_path / "x.html"))
    assert done.exit_code == 2 and "pn2code report" in done.output
    (tmp_path / "cell.toml").unlink()
    (net,) = tmp_path.glob("*.cpn")
    done = CliRunner().invoke(app, ["verify", str(net), "--geometry"])
    assert done.exit_code == 1 and "only a cell has a geometry" in done.output
