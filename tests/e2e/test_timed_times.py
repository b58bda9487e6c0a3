"""Durations of timed nets: timers of the supervisor, waits of scripts and commands together, beside runs."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random

import pytest
from tools.adversary import times, waits, wander
from tools.adversary.wander import Pace
from typer.testing import CliRunner

from helpers import early_cell, timer_cell
from helpers.thorough import amount
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load
from pn2code.timing.look import CLOCK_RUNS, Measured
from pn2code.trace.replay import replay

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

ANSWERED = (
    "every fires(Sup'Start) is followed by fires(Sup'Drilled) || fires(Sup'Late) within {} seconds"
)


def runs(folder: Path, said: list[str]) -> list[tuple[Pace, wander.Run]]:
    built = wander.prepare(folder, Diagnostics())
    assert built is not None
    made = []
    for i, text in enumerate(said):
        (folder / "gauge.txt").write_text("\n".join(text) + "\n", encoding="utf-8")
        made.append((Pace.PLANNED, wander.run(built, i, pace=Pace.PLANNED)))
    return made


def test_best_and_worst_are_what_runs_take(tmp_path: Path) -> None:
    """A drill that thinks for 3 s is late for a watchdog of 4 s: at 5.3 s, which the clock counts as 5."""
    cell = timer_cell.write(tmp_path / "cell")
    measured: list[Measured] = []
    cycle = times.cycle_of(cell, measured)
    assert cycle is not None and not cycle.why and not cycle.others
    row = cycle.row()
    assert (row["least_s"], row["most_s"]) == (5.999, 14.001)
    assert row["at_most_s"] is None, "programs wait"
    made = runs(cell, ["00", "01", "12", "33"])
    assert [round(run.record.time, 6) for _, run in made] == [6.0, 7.0, 10.0, 14.0]
    assert not list(times.contradictions(cycle, iter(made)))
    assert not list(waits.contradictions(measured[0], Random(1), made))


@pytest.mark.parametrize("seed", [3, *range(100, 100 + amount(0, 40))])
def test_runs_of_random_timers_keep_the_bounds(seed: int, tmp_path: Path) -> None:
    random = Random(seed)
    numbers = timer_cell.drawn(random)
    cell = timer_cell.write(tmp_path / "cell", numbers)
    measured: list[Measured] = []
    cycle = times.cycle_of(cell, measured)
    assert cycle is not None and not cycle.why
    values = [str(i) for i in range(int(numbers["LONGEST"]) + 1)]
    made = runs(cell, ["".join(random.choices(values, k=4)) for _ in range(6)])
    assert all(run.end == "finished" for _, run in made)
    assert not list(times.contradictions(cycle, iter(made)))
    assert not list(waits.contradictions(measured[0], random, made))


@pytest.mark.parametrize(
    ("patience", "never"),
    [(1, ["Drilled"]), (4, []), (7, ["Time Out", "Late"])],
    ids=("too short", "sometimes over", "long enough"),
)
def test_what_a_timer_never_lets_occur(patience: int, never: list[str], tmp_path: Path) -> None:
    """The drill answers after 2.3 to 5.3 s, which follows from what it is told and does."""
    numbers = {**timer_cell.USUAL, "PATIENCE": patience}
    cycle = times.cycle_of(timer_cell.write(tmp_path / "cell", numbers))
    assert cycle is not None and not cycle.why
    assert cycle.row()["never"] == [f"Top.Supervisor.{name}" for name in never]


def test_a_script_waits_for_its_control_token_alone(tmp_path: Path) -> None:
    """What it notes with a later time stamp, where nobody reads, keeps it from nothing."""
    net = timer_cell.NET.replace(
        "      out Thinking : ()@+c\n", "      out Thinking : ()@+c\n      out Log : ()@+8\n"
    ).replace("    place Thinking : T\n", "    place Thinking : T\n    place Log : T\n")
    cycle = times.cycle_of(timer_cell.write(tmp_path / "cell", net=net))
    assert cycle is not None and not cycle.why
    assert (cycle.row()["least_s"], cycle.row()["most_s"]) == (5.999, 14.001)


@pytest.mark.parametrize(("waits", "least", "most"), [(0, 0.0, 2.001), (4, 3.999, 4.001)])
def test_a_robot_begins_nothing_after_the_supervisors_end(
    waits: int, least: float, most: float, tmp_path: Path
) -> None:
    """Its first command is done to its end, if it was begun; neither the second nor the next transition follows.

    Runs take 2 s and 4 s.
    """
    cycle = times.cycle_of(early_cell.write(tmp_path / "cell", waits))
    assert cycle is not None and not cycle.why and not cycle.others
    assert (cycle.row()["least_s"], cycle.row()["most_s"]) == (least, most)


def test_what_cannot_be_done_stops_a_run_whatever_others_still_do(tmp_path: Path) -> None:
    """A supervisor that looks each second goes on for ever beside an arm that stands still in the model."""
    cycle = times.cycle_of(early_cell.write(tmp_path / "cell", 0, *early_cell.unreached()))
    assert cycle is not None and not cycle.why
    assert any("a run may stop" in x for x in cycle.others)


def test_within_seconds_counts_timers_and_waits(tmp_path: Path) -> None:
    cell = timer_cell.write(tmp_path / "cell")
    asked = [x for n in ("6", "5") for x in ("--property", ANSWERED.format(n))]
    traces = ["--traces", str(tmp_path / "traces")]
    options = ["--durations", "--json", "--no-medium", "--no-controller", *traces]
    done = CliRunner().invoke(app, ["verify", str(cell), *asked, *options])
    yes, no = json.loads(done.stdout)["properties"]
    assert (yes["answer"], yes["value"]) == ("yes", 5.301)
    assert CLOCK_RUNS in yes["assumes"] and any("planned time" in x for x in yes["assumes"])
    assert not any("no command takes more" in x for x in yes["assumes"]), "not for shorter ones"
    assert (no["answer"], no["value"]) == ("no", 5.299)
    net = load(cell / "cell.cpn", Diagnostics())
    assert net is not None and replay(Path(no["evidence"]["trace"]), net).ok
