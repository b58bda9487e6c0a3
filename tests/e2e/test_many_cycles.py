"""`pn2code run --cycles`: runs one after the other, sensors and stops that go on, and what is reported."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.timed_runs_cell import write
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def ran(cell: Path, out: Path, *more: str, code: int = 0) -> Any:
    arguments = ["run", str(cell), "--backend", "fake", "--unchecked", "-o", str(out), *more]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == code, done.output
    return json.loads((out / "cycles.json").read_text(encoding="utf-8")), done.stdout


def test_sensors_go_on_from_run_to_run(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell", said="good\ngood\nbad\nbad")
    found, text = ran(cell, tmp_path / "run", "--cycles", "5", "--warm-up", "1")
    # The cycles hear: good; good; bad bad; good; good; bad bad.
    assert [c["seconds"] for c in found["cycles"]] == [3.0, 3.0, 4.0, 3.0, 3.0, 4.0]
    assert [c["warm_up"] for c in found["cycles"]] == [True] + 5 * [False]
    assert found["counted"] == found["finished"] == 5
    assert found["seconds"]["mean"] == 3.4 and found["seconds"]["max"] == 4.0
    assert found["per_hour"]["cycles"] == pytest.approx(5 * 3600 / 17, abs=1e-6)
    assert "5 cycles after 1 of warm-up: 5 came to their end" in text
    assert len((tmp_path / "run" / "cycles.tsv").read_text().splitlines()) == 7
    trace = tmp_path / "run" / "slowest" / "cell.trace.jsonl"
    done = CliRunner().invoke(app, ["replay", str(trace), str(cell)])
    assert done.exit_code == 0, done.output
    assert "Again" in trace.read_text(encoding="utf-8")
    described = json.loads((trace.parent / "run.json").read_text(encoding="utf-8"))
    assert described["end"] == 4.0
    assert (trace.parent / "replay.html").is_file()
    done = CliRunner().invoke(app, ["show", str(trace.parent), "-o", str(tmp_path / "page.html")])
    assert done.exit_code == 0, done.output


def test_stops_hold_commands_up(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell")
    often = ("--cycles", "6", "--stops", "drill:3/2", "--seed", "4")
    found, text = ran(cell, tmp_path / "run", *often)
    stopped = [c for c in found["cycles"] if c["stops"]]
    assert stopped and "stops, " in text
    for c in found["cycles"]:  # the press takes 3 s, the drill 2 s and its stops
        assert c["seconds"] == pytest.approx(max(3.0, 2.0 + c["stopped_s"]), abs=1e-5)
    again, _ = ran(cell, tmp_path / "run", *often)
    assert again == found
    trace = tmp_path / "run" / "slowest" / "cell.trace.jsonl"
    assert '"event": "stand"' in trace.read_text(encoding="utf-8")
    done = CliRunner().invoke(app, ["replay", str(trace), str(cell)])
    assert done.exit_code == 0, done.output
    (cell / "cell.toml").write_text(
        (cell / "cell.toml")
        .read_text()
        .replace('final = ["Finished"]', 'final = ["Finished"]\nreply_timeout_s = 2.5')
    )
    found, text = ran(cell, tmp_path / "run", "--cycles", "2", code=1)
    assert found["finished"] == 0 and found["seconds"] is None and "cycle 1 failed" in text
    assert (tmp_path / "run" / "failed" / "summary.json").is_file()
    assert (tmp_path / "run" / "failed" / "run.json").is_file()
    assert not (tmp_path / "run" / "slowest").exists()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--warm-up", "2"], "only with"),
        (["--stops", "drill:3/2"], "only with"),
        (["--cycles", "2", "--realtime"], "lock-step"),
        (["--cycles", "2", "--stops", "drill:3"], "WHO:BETWEEN/LASTING"),
    ],
)
def test_options_that_do_not_fit(options: list[str], says: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["run", str(tmp_path), *options])
    assert done.exit_code == 2 and says in " ".join(done.stderr.split())


def test_who_could_stop_is_known(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell")
    options = ["--cycles", "2", "--stops", "dril:3/2", "-o", str(tmp_path / "run"), "--unchecked"]
    done = CliRunner().invoke(app, ["run", str(cell), "--backend", "fake", *options])
    assert done.exit_code == 1 and "did you mean `drill`?" in done.stderr
