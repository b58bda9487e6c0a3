"""`pn2code simulate --replications` and `--report`, from outside."""

from __future__ import annotations

import json
import statistics
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from helpers.monitors import Spec, with_monitors
from pn2code.cli.main import app
from pn2code.simulate import programs
from pn2code.simulate.confidence import critical_point

QUEUE = """
net Queue
  standard
  colset JOB = int timed;
  var i : INT;
  place Next : JOB = 1`1
  place Wait : JOB
  place Done : JOB
  trans Arrive guard [i <= 6]
    in Next : i
    out Next : (i + 1) @+ discrete (1, 9)
    out Wait : i
  trans "Serve <b>"
    in Wait : i
    out Done : if i = ~1 then 100 div (i + 1) else i
"""
SIZE = Spec("Waiting", "Marking size", ["Queue.Wait"])
COUNT = Spec(
    "Served & gone", "Count transition occurrence", ["Queue.Serve <b>"], {}, {"Logging": "true"}
)


def simulated(net: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["simulate", str(net), "--engine", "reference", *options])


def made(tmp_path: Path, text: str = QUEUE, *monitors: Spec) -> Path:
    path = tmp_path / "queue.cpn"
    specs = [
        Spec(m.name, m.kind, [n.replace("Queue.", "Top.") for n in m.nodes], m.functions, m.options)
        for m in monitors or (SIZE, COUNT)
    ]
    path.write_bytes(with_monitors(text, *specs))
    return path


def test_averages_of_single_runs(tmp_path: Path) -> None:
    net = made(tmp_path)
    said: dict[str, Any] = json.loads(
        simulated(net, "--replications", "3", "--seed", "7", "--json").stdout
    )
    alone = [json.loads(simulated(net, "--seed", str(k), "--json").stdout) for k in (7, 8, 9)]
    assert [s["seed"] for s in said["simulations"]] == [7, 8, 9]
    assert [s["monitors"] for s in said["simulations"]] == [a["monitors"] for a in alone]
    assert len({s["time"] for s in said["simulations"]}) > 1
    waiting, served = said["collectors"]
    averages = [a["monitors"][0]["avg"] for a in alone]
    assert waiting["statistics"]["avrg"]["avg"] == pytest.approx(statistics.mean(averages))
    half = critical_point(90, 2) * statistics.stdev(averages) / 3**0.5
    assert waiting["statistics"]["avrg"]["half_90"] == pytest.approx(half)
    assert list(waiting["statistics"]) == ["count", "max", "min", "avrg"]  # timed: no sum
    assert served["statistics"]["sum"] == {
        "avg": 6.0, "half_90": 0.0, "half_95": 0.0, "half_99": 0.0, "std": 0.0, "min": 6, "max": 6,
    }  # fmt: skip


def test_a_simulation_without_values_counts_as_zero_and_that_is_said(tmp_path: Path) -> None:
    """As in the engine of CPN Tools: of two simulations, one with the value 7, the other without any, its variables for
    independent observations say count 0.5, min 3.5 and 0 at the least, avrg 3.5."""
    sometimes = """
net Sometimes
  standard
  var i : INT;
  place Start : INT = 1`0
  place Drawn : INT
  place Seen : INT
  trans Draw
    in Start : i
    out Drawn : discrete (0, 1)
  trans See guard [i = 1]
    in Drawn : i
    out Seen : i
"""
    seven = {
        "Predicate": "fun pred bindelem = true", "Observer": "fun obs bindelem = 7",
        "Init function": "fun init () = NONE", "Stop": "fun stop () = NONE",
    }  # fmt: skip
    net = made(tmp_path, sometimes, Spec("Sevens", "Data collection", ["Queue.See"], seven))
    page, counts, seed = tmp_path / "page.html", [0, 0], 0
    while sorted(counts) != [0, 1]:
        seed += 1
        text = simulated(net, "--replications", "2", "--seed", str(seed), "--json").stdout
        said: dict[str, Any] = json.loads(text)
        counts = [s["monitors"][0]["count"] for s in said["simulations"]]
    found = said["collectors"][0]
    assert found["without_values"] == 1
    assert found["statistics"]["count"]["avg"] == 0.5
    assert found["statistics"]["min"]["avg"] == found["statistics"]["avrg"]["avg"] == 3.5
    assert found["statistics"]["min"]["min"] == 0
    shown = simulated(net, "--replications", "2", "--seed", str(seed), "--report", str(page))
    note = "In 1 of 2 simulations it saw no value: each of its statistics counts as 0 there"
    assert note in shown.stdout and note in page.read_text(encoding="utf-8")
    assert "saw no value" not in simulated(made(tmp_path), "--replications", "2").stdout


@pytest.mark.cc
def test_the_net_is_made_ready_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    net, made_ready, generated = made(tmp_path), [], programs.generated

    def told(*args: Any) -> Any:
        made_ready.append(args)
        return generated(*args)

    monkeypatch.setattr(programs, "generated", told)
    said = simulated(net, "--engine", "compiled", "--replications", "3", "--json")
    assert said.exit_code == 0 and len(made_ready) == 1
    assert said.stdout == simulated(net, "--replications", "3", "--json").stdout


def test_the_reports(tmp_path: Path) -> None:
    net, page = made(tmp_path), tmp_path / "performance.html"
    result = simulated(net, "--replications", "2", "--report", str(page))
    assert result.exit_code == 0
    assert "2 of 2 simulations" in result.stdout and "±95 %" in result.stdout
    several = page.read_text(encoding="utf-8")
    assert "95 % half length" in several and "Served &amp; gone" in several
    assert "unicode-bidi: isolate" in several and f"<bdi>{net}</bdi>: 2 of 2" in several
    assert simulated(net, "--report", str(page), "-q").stdout == ""
    one = page.read_text(encoding="utf-8")
    assert "Timed statistics" in one and "Untimed statistics" in one and "Model time" not in one


def test_a_run_that_fails_is_the_last(tmp_path: Path) -> None:
    fails = QUEUE.replace("i = ~1 then 100 div (i + 1)", "discrete (1, 2) = 1 then 1 div 0")
    result = simulated(made(tmp_path, fails), "--replications", "50")
    assert result.exit_code == 1
    assert "of 50 simulations" in result.stdout and "Div" in result.output
    assert result.stdout.count("no more enabled transitions") < 5


def test_where_no_simulation_comes_to_its_end_nothing_is_said_of_collectors(tmp_path: Path) -> None:
    fails = made(
        tmp_path, QUEUE.replace("if i = ~1 then 100 div (i + 1)", "if i = 1 then 100 div 0")
    )
    result = simulated(fails, "--replications", "3")
    assert result.exit_code == 1 and "0 of 3 simulations" in result.stdout
    assert "no simulation came to its end" in result.stdout
    assert "the net has no data collectors" not in result.stdout


def test_logs_of_each_simulation(tmp_path: Path) -> None:
    folder = tmp_path / "files"
    folder.mkdir()
    simulated(made(tmp_path), "--replications", "2", "--files", str(folder))
    logs = sorted(str(p.relative_to(folder)) for p in folder.rglob("*.log"))
    assert logs == [f"output/sim_{i}/logfiles/Served.log" for i in (1, 2)]


def test_where_the_files_of_each_simulation_are(tmp_path: Path) -> None:
    """What is said of a file names the one that was written."""
    folder = tmp_path / "files"
    folder.mkdir()
    functions = {
        "Init": 'fun init () = "begin"',
        "Predicate": "fun pred bindelem = true",
        "Observer": 'fun obs bindelem = "x"',
        "Stop": 'fun stop () = "end"',
    }
    writer = Spec("Told", "Write in file", ["Queue.Arrive"], functions)
    net = made(tmp_path, QUEUE, writer)
    said = json.loads(
        simulated(net, "--replications", "2", "--files", str(folder), "--json").stdout
    )
    named = [m["file"] for s in said["simulations"] for m in s["monitors"]]
    assert named == sorted(str(p.relative_to(folder)) for p in folder.rglob("Told*"))
    assert len(named) == 2


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--replications", "2", "--trace", "t.jsonl"), "leave one of them out"),
        (("--replications", "1"), "1 is not in the range"),
        (("--report", "a.txt"), "does not end in .html or .htm"),
        (("--report", "missing/a.html"), "there is no folder"),
    ],
)
def test_what_cannot_be(tmp_path: Path, options: tuple[str, ...], said: str) -> None:
    result = simulated(made(tmp_path), *options)
    assert result.exit_code == 2
    assert said in " ".join(result.output.replace("│", " ").split())


def test_a_net_without_collectors(tmp_path: Path) -> None:
    page = tmp_path / "performance.html"
    result = simulated(
        made(tmp_path, QUEUE, Spec("At", "Place content break point", ["Top.Done"], {}, {"If is empty": "false"})),
        "--replications", "2", "--report", str(page),
    )  # fmt: skip
    assert "the net has no data collectors" in result.stdout and "breakpoint At" in result.stdout
