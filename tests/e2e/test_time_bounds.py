"""`pn2code time`: what it says of cycles is what runs take, and no run breaks a bound."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tools.adversary import times, wander
from tools.adversary.wander import Pace
from typer.testing import CliRunner

from helpers import belt_cell, meeting_cell
from helpers.netbuilder import cpn
from helpers.thorough import amount
from helpers.timed_runs_cell import NET, write
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions
from pn2code.timing.doings import NS
from pn2code.trace.replay import replay

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

SEEDS = (101, 134, *range(200, 260))[: amount(1, 62)]


def asked(*arguments: str, code: int = 0) -> Any:
    done = CliRunner().invoke(app, ["time", *arguments, "--json"])
    assert done.exit_code == code, done.output
    return json.loads(done.stdout)


def ran(folder: Path, out: Path) -> float:
    options = RunOptions(out, backend="fake", looks=False, checked=False)
    result = run_cell(folder, options, Diagnostics())
    assert result is not None and result.record.verdict == "finished"
    return result.record.time


def test_best_and_worst_are_what_runs_take(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell")
    found = asked(str(cell), "-o", str(tmp_path / "time"))
    (layout,) = found["layouts"]
    assert [(c["robot"], c["command"], c["least_s"], c["most_s"]) for c in layout["commands"]] == [
        ("drill", "tool drill", 2.0, 2.0),
        ("press", "tool press", 3.0, 3.0),
    ]
    cycle = layout["cycle"]
    assert (cycle["least_s"], cycle["most_s"]) == (2.999, 4.001)
    assert (cycle["at_least_s"], cycle["at_most_s"]) == (2.999, 7.001)
    assert cycle["others"] == [] and cycle["repeats"] == [] and cycle["why"] is None
    assert ran(cell, tmp_path / "run") == 3.0
    (cell / "gauge.txt").write_text("bad\n", encoding="utf-8")
    assert ran(cell, tmp_path / "run") == 4.0
    (ending,) = cycle["endings"]
    assert ending["final"] == ["Top.Supervisor.Finished"]
    net = load(cell / "cell.cpn", Diagnostics())
    assert net is not None
    for which, again in (("fastest", False), ("slowest", True)):
        trace = Path(ending[which])
        assert replay(trace, net).ok
        assert ("Top.Supervisor.Again" in trace.read_text(encoding="utf-8")) == again
    table = (tmp_path / "time" / "durations.tsv").read_text(encoding="utf-8").splitlines()
    assert len(table) == 3 and table[0].startswith("layout\trobot\t")
    assert json.loads((tmp_path / "time" / "time.json").read_text()) == found


def test_within_so_many_seconds(tmp_path: Path) -> None:
    cell = str(write(tmp_path))
    for seconds, answer, code in (("4.1", "yes", 0), ("3.9", "no", 1), ("4", "unknown", 3)):
        (said,) = asked(cell, "--within", seconds, code=code)["within"]
        assert said["answer"] == answer
    done = CliRunner().invoke(app, ["time", cell, "--within", "3.9"])
    assert "NO: each run comes to its end within 3.9 s: a run takes at least 3.999 s" in done.stdout


TEN = """
net ten
  standard
  colset COUNT = int with 0..10;
  fun drill () = ();
  fun press () = ();
  var n : COUNT;
  page Top
    place f1
    place d1
    place f2
    place d2
    subst Supervisor = Sup (f1 -> f1, d1 -> d1, f2 -> f2, d2 -> d2)
    subst Drill = Drill (f -> f1, d -> d1)
    subst Press = Press (f -> f2, d -> d2)
  page Sup
    place f1 port out
    place d1 port in
    place f2 port out
    place d2 port in
    place Ready = ()
    place Busy
    place Other
    place Finished
    trans Start
      in Ready : ()
      out f1 : ()
      out f2 : ()
      out Busy : ()
      out Other : ()
    trans End
      in Busy : ()
      in d1 : ()
      out Finished : ()
    trans Pressed
      in Other : ()
      in d2 : ()
  page Drill
    place f port in
    place d port out
    place Waiting = ()
    place Told : COUNT
    trans Accept
      in Waiting : ()
      in f : ()
      out Told : 0
    trans Drill guard [n < 10] code action drill ()
      in Told : n
      out Told : n + 1
    trans Report guard [n = 10]
      in Told : n
      out d : ()
      out Waiting : ()
  page Press
    place f port in
    place d port out
    place Waiting = ()
    place Told : COUNT
    trans Accept
      in Waiting : ()
      in f : ()
      out Told : 0
    trans Press guard [n < 10] code action press ()
      in Told : n
      out Told : n + 1
    trans Report guard [n = 10]
      in Told : n
      out d : ()
      out Waiting : ()
"""


def test_milliseconds_add_up_and_are_no_proof_that_it_takes_longer(tmp_path: Path) -> None:
    """The drill needs 10 s. What ends 0.9 ms later may end before it, ten times; so far that was a *no*."""
    cell = write(tmp_path)
    (cell / "cell.cpn").write_bytes(cpn(TEN))
    toml = (cell / "cell.toml").read_text().replace("_s = 2.0", "_s = 1.0")
    asks = """
[[property]]
name = "drilled"
holds = "every fires(Sup'Start) is followed by fires(Sup'End) within 10.005 seconds"
"""
    toml = toml.partition("[sensors")[0].replace("_s = 3.0", "_s = 1.0009") + asks
    (cell / "cell.toml").write_text(toml)
    for seconds, answer, code in (("10.02", "yes", 0), ("10.005", "unknown", 3), ("9.99", "no", 1)):
        (said,) = asked(str(cell), "--within", seconds, code=code)["within"]
        assert said["answer"] == answer, said
    assert asked(str(cell))["layouts"][0]["cycle"]["most_s"] == 10.010
    done = CliRunner().invoke(app, ["verify", str(cell), "--durations", "--no-medium", "--json"])
    (said,) = (x for x in json.loads(done.stdout)["properties"] if x["name"] == "drilled")
    assert said["answer"] == "inconclusive", said
    assert said["why"] == (
        "the longest wait takes between 9.999 s and 10.010 s, as what ends within a millisecond of each other may end "
        "in either order"
    )


@pytest.mark.bullet
def test_a_belt_with_a_stop_leaves_both_bounds(tmp_path: Path) -> None:
    """How far it runs is not followed: between nothing and all of its way."""
    cell = belt_cell.belt_cell(tmp_path / "cell")
    (layout,) = asked(str(cell), code=3)["layouts"]
    (run,) = (c for c in layout["commands"] if "belt" in c["command"])
    assert run["least_s"] == 0.0 and run["most_s"] > 4.0
    cycle = layout["cycle"]
    assert "how far a belt runs" in cycle["why"] and layout["open"] is None
    took = ran(cell, tmp_path / "run")
    assert 0.0 < cycle["at_least_s"] < took < cycle["at_most_s"]
    fast = tmp_path / "fast"
    belt_cell.belt_cell(fast, toml=belt_cell.TOML.replace("speed = 0.25", "speed = 2.0"))
    (other,) = asked(str(fast), code=3)["layouts"]
    assert other["cycle"]["at_least_s"] <= cycle["at_least_s"]
    assert other["cycle"]["at_most_s"] < cycle["at_most_s"]
    done = CliRunner().invoke(app, ["time", str(cell)])
    assert "than its planned time (a belt with a stop may take none)." in done.stdout


def test_an_answer_may_come_too_late(tmp_path: Path) -> None:
    """The press answers after 3 s; the drill takes 4 s with two answers."""
    cell = write(tmp_path)
    toml = (cell / "cell.toml").read_text(encoding="utf-8")
    for timeout, code in (("3.5", 0), ("2.5", 3)):
        text = toml.replace('["Finished"]', f'["Finished"]\nreply_timeout_s = {timeout}')
        (cell / "cell.toml").write_text(text, encoding="utf-8")
        found = asked(str(cell), "--within", "10", code=code)
        others = found["layouts"][0]["cycle"]["others"]
        late = "an answer of device `press` may come after 3.000 s, later than reply_timeout_s (2.5 s) allows"
        assert others == ([late] if code else [])


def test_an_answer_may_come_too_late_in_a_timed_net(tmp_path: Path) -> None:
    """The press answers after 3 s, whatever the time stamps of the supervisor are."""
    cell = write(tmp_path)
    timed = NET.replace("AGAIN", "n + 1").replace("    place Busy2\n", "    place Busy2 : TIMED\n")
    timed = timed.replace("  fun drill", "  colset TIMED = unit timed;\n  fun drill")
    (cell / "cell.cpn").write_bytes(cpn(timed.replace("out Busy2 : ()", "out Busy2 : ()@+1")))
    toml = (cell / "cell.toml").read_text(encoding="utf-8")
    for timeout, late in (("3.5", []), ("2.5", ["device `press`"])):
        text = toml.replace('["Finished"]', f'["Finished"]\nreply_timeout_s = {timeout}')
        (cell / "cell.toml").write_text(text, encoding="utf-8")
        cycle = asked(str(cell))["layouts"][0]["cycle"]
        assert cycle["why"] is None
        assert cycle["late"] == [
            f"an answer of {who} may come after 3.000 s, later than reply_timeout_s (2.5 s) allows"
            for who in late
        ]


def test_what_can_be_repeated_has_no_upper_bound(tmp_path: Path) -> None:
    cell = str(write(tmp_path, again="0"))
    cycle = asked(cell)["layouts"][0]["cycle"]
    assert cycle["least_s"] == 2.999 and cycle["most_s"] is None and cycle["at_most_s"] is None
    assert "Top.Supervisor.Again" in cycle["repeats"]
    (said,) = asked(cell, "--within", "100000", code=1)["within"]
    assert said["answer"] == "no" and "repeat" in said["why"]
    done = CliRunner().invoke(app, ["time", cell])
    assert "worst no upper bound" in done.stdout and "as often as it likes" in done.stdout


def test_a_false_bound_would_be_found(tmp_path: Path) -> None:
    cell = write(tmp_path, said="bad")
    cycle = times.cycle_of(cell)
    built = wander.prepare(cell, Diagnostics())
    assert cycle is not None and built is not None
    runs = list(times.runs_of(built, 2))
    assert not list(times.contradictions(cycle, iter(runs)))
    (ending,) = cycle.endings
    short = replace(cycle, endings=(replace(ending, most=3 * NS),))
    assert any("more than" in x for x in times.contradictions(short, iter(runs)))
    long = replace(cycle, endings=(replace(ending, least=5 * NS),))
    assert any("less than" in x for x in times.contradictions(long, iter(runs)))
    late = replace(cycle, endings=(), at_least=30 * NS)
    assert any(x.startswith("late") for x in times.contradictions(late, iter(runs)))
    assert {pace for pace, _ in runs} == set(Pace) - {Pace.ANY}


@pytest.mark.parametrize("seed", SEEDS)
def test_runs_of_random_cells_keep_the_bounds(seed: int, tmp_path: Path) -> None:
    wrong, _ = times.judge(seed, tmp_path, 3)
    assert not wrong


EXAMPLES = ("handover", "tending", "palletiser", "minimal", "welding", "assembly")


@pytest.mark.parametrize("name", EXAMPLES[: amount(1, 6)])
def test_runs_of_examples_keep_the_bounds(name: str, root: Path, tmp_path: Path) -> None:
    """With planned times, and with sensors that say something else."""
    folder = root / "examples" / name
    cycle = times.cycle_of(folder)
    assert cycle is not None and not cycle.why and cycle.least is not None
    assert cycle.most is not None and not cycle.others
    options = RunOptions(tmp_path, backend="fake", looks=False, checked=False)
    result = run_cell(folder, options, Diagnostics())
    assert result is not None and result.record.verdict == "finished"
    said = cycle.row()
    assert said["least_s"] <= result.record.time <= said["most_s"]
    assert said["at_least_s"] <= result.record.time <= said["at_most_s"]
    if cycle.least == cycle.most:
        assert result.record.time == pytest.approx(cycle.least / NS, abs=1e-6)


def test_a_net_alone_has_no_durations(tmp_path: Path) -> None:
    (write(tmp_path) / "cell.toml").unlink()
    done = CliRunner().invoke(app, ["time", str(tmp_path / "cell.cpn")])
    assert done.exit_code == 1 and "time-no-cell" in done.stderr


def test_why_a_run_takes_as_long_as_it_does(tmp_path: Path) -> None:
    cell = write(tmp_path / "cell", said="bad")
    assert ran(cell, tmp_path / "run") == 4.0
    found = asked(str(cell), "--run", str(tmp_path / "run"))
    assert found["ended"] == "finished" and found["seconds"] == 4.0
    assert [(s["owner"], s["begin_s"], s["end_s"]) for s in found["critical_path"]] == [
        ("drill", 0.0, 2.0),
        ("drill", 2.0, 4.0),
    ]
    drill, press = found["activities"]
    assert (drill["times"], drill["busy_s"], drill["critical_s"], drill["gain_s"]) == (2, 4, 4, 1)
    assert (press["busy_s"], press["critical_s"], press["gain_s"]) == (3, 0, 0)
    sides = {s["owner"]: s for s in found["sides"]}
    assert sides["drill"]["utilisation"] == 1.0 and sides["press"]["utilisation"] == 0.75
    assert sides["drill"]["waits_s"] == {}
    done = CliRunner().invoke(app, ["time", str(cell), "--run", str(tmp_path / "run")])
    assert (
        "No overlapping makes it shorter than 4.000 s: so long `drill` is at work." in done.stdout
    )
    trace = tmp_path / "run" / "cell.trace.jsonl"
    text = trace.read_text(encoding="utf-8")
    trace.write_text(text.replace('"v": "bad"', '"v": "good"', 1), encoding="utf-8")
    done = CliRunner().invoke(app, ["time", str(cell), "--run", str(trace)])
    assert done.exit_code == 1 and "time-no-run" in done.stderr
    done = CliRunner().invoke(app, ["time", str(cell), "--run", str(tmp_path / "none")])
    assert done.exit_code == 1 and "cannot be read" in done.stderr
    done = CliRunner().invoke(app, ["time", str(cell), "--run", str(trace), "--within", "3"])
    assert done.exit_code == 2


def test_short_moves_add_up(tmp_path: Path) -> None:
    """Places that are a hundredth of a micrometre apart are as good as one, but the way there takes milliseconds."""
    moves = "; ".join(f"moveLinear (at (1100.0{'' if i % 2 else '00003'}, rz))" for i in range(60))
    text = meeting_cell.NET.replace("      TAKE\n", "").replace("      GIVE\n", "")
    text = text.replace(
        "  fun visit rz = (come rz; work (); moveLinear (at (1100.0, rz)); moveHome ());",
        f"  fun visit rz = (moveJoint (at (1100.0, rz)); {moves});",
    )
    text = text.replace("action (visit 180.0)", "action (work ())").replace("= 1`2", "= 1`1")
    cell = tmp_path / "cell"
    cell.mkdir()
    (cell / "cell.cpn").write_bytes(cpn(text))
    (cell / "cell.toml").write_text(meeting_cell.TOML, encoding="utf-8")
    (layout,) = asked(str(cell))["layouts"]
    cycle = layout["cycle"]
    assert cycle["least_s"] <= ran(cell, tmp_path / "run") <= cycle["most_s"], cycle


@pytest.mark.parametrize("verb", [("time",), ("check", "--geometry"), ("reach",)], ids="-".join)
@pytest.mark.parametrize(
    ("given", "other", "said"),
    [
        ("work = {", "wrok = {", "has no function `wrok`"),
        (
            'work = { command = "tool", action = "work", duration_s = 1.0 }\n',
            "",
            "primitive-unnamed",
        ),
    ],
)
def test_nothing_is_said_of_programs_that_check_refuses(
    tmp_path: Path, verb: tuple[str, ...], given: str, other: str, said: str
) -> None:
    """A call that is no command would be missing from what is looked at."""
    text = meeting_cell.NET.replace("      TAKE\n", "").replace("      GIVE\n", "")
    (tmp_path / "cell.cpn").write_bytes(cpn(text))
    assert meeting_cell.TOML.count(given) == 1
    (tmp_path / "cell.toml").write_text(meeting_cell.TOML.replace(given, other), encoding="utf-8")
    done = CliRunner().invoke(app, [*verb, str(tmp_path)])
    assert done.exit_code == 1 and said in done.output, done.output
