"""`--reduce time`: the same answers as the whole space, and the very quotient that the token game gives."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.explored import Explored, Explorers
from helpers.netbuilder import flat, write
from helpers.quotient import quotient
from pn2code.cli.main import app
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.time_reduction import why_not_reducible

pytestmark = pytest.mark.cc

# Early tokens, several stamps of one colour, reset and inhibitor arcs, delays below zero are in `ODD`.
TWO_MACHINES = """
    net Machines
      colset PART = with screw | nut timed;
      colset MACHINE = index m with 1..2 timed;
      var p: PART;  var x: MACHINE;
      place Stock : PART = 1`screw ++ 1`nut
      place Free : MACHINE = 1`m(1) ++ 1`m(2)
      place Work : WORK
      place Done : PART
      colset WORK = product MACHINE * PART timed;
      trans Begin
        in Stock : p
        in Free : x
        out Work : (x, p)@+(if p = screw then 3 else 5)
      trans End
        in Work : (x, p)
        out Free : x@+1
        out Done : p
      trans Back delay @+7
        in Done : p
        out Stock : p
"""
CONVEYOR = """
    net Conveyor
      standard
      val P_HIGH = 100;
      colset BOX = int with 1..3 timed;
      colset SLOT = unit timed;
      colset KIND = int with 1..3;
      var b: BOX;  var k: KIND;
      place Source : BOX = 1`1 ++ 1`2 ++ 1`3
      place Kinds : KIND = 1`1 ++ 1`2 ++ 1`3
      place Belt : BOX
      place Room : UNIT = 2`()
      place Sink : BOX
      trans Load priority P_HIGH
        in Source : b
        in Room : ()
        out Belt : b@+10
      trans Take guard [k = b]
        in Belt : b@+(2 * k)
        both Kinds : k
        out Room : ()
        out Sink : b@+4
      trans Return
        in Sink : b
        out Source : b@+(20 - b)
"""
ODD = """
    net Odd
      standard
      colset T = int with 0..2 timed;
      colset K = int with 0..4;
      var t: T;  var k: K;  var u: T;
      place A : T = 1`0@0 +++ 2`1@3
      place B : T
      place C : T = 1`0@4
      place Budget : UNIT = 1`()
      place Keys : K = 1`1 ++ 1`4
      trans Early
        in A : t@+k
        both Keys : k
        out B : t@+ (t - 1)
      trans Clear
        in C : u
        in B : 1
        in Budget : ()
        reset A
        out C : u@+6
        out A : 1`0@+1
      trans Idle
        inhibit B
        in A : 0
        out B : 2@+3
      trans Again
        in B : 2`1
        out A : 1`1@+ ~4 +++ 1`1@+2
      trans Return
        in B : t
        out A : t@+9
"""
FINITE = """
    net Finite
      standard
      colset JOB = int with 1..3 timed;
      var j: JOB;
      place Waiting : JOB = 1`1 ++ 1`2 ++ 1`3
      place Tools : UNIT = 2`()
      place Delays : INT = 1`3 ++ 1`8
      var n: INT;
      place Busy : JOB
      place Ready : JOB
      place Never : JOB
      trans Start
        in Waiting : j
        in Tools : ()
        out Busy : j@+(2 * j)
      trans Stop
        in Busy : j
        out Tools : ()
        out Ready : j@+1
      trans Again
        in Delays : n
        in Ready : j
        out Waiting : j@+n
      trans Unused
        in Never : j
        out Ready : j
"""


def parts(found: Explored) -> tuple[Counter[str], Counter[tuple[str, str, str]]]:
    """Markings without time, and arcs between them without times."""
    nodes = [json.dumps(json.loads(node)[1], sort_keys=True) for node in found.nodes]
    arcs = [
        (nodes[a], nodes[b], json.dumps(json.loads(e)[1:], sort_keys=True))
        for a, b, e in found.arcs
    ]
    return Counter(nodes), Counter(arcs)


def assert_is_quotient(explorers: Explorers, net: FlatNet, *options: object) -> Explored:
    assert why_not_reducible(net) is None
    found = explorers.explore(net, "--reduce", "time", *options)
    expected = quotient(net)
    assert found.report["complete"] and found.report["reductions"] == ["time"]
    nodes, arcs = parts(found)
    assert nodes == Counter(expected.nodes)
    assert arcs == expected.arcs
    assert found.report["nodes"] == len(expected.nodes)
    assert found.report["dead_count"] == expected.dead
    return found


@pytest.mark.parametrize("text", [TWO_MACHINES, CONVEYOR, ODD], ids=["machines", "conveyor", "odd"])
def test_a_cyclic_net_becomes_finite(explorers: Explorers, text: str) -> None:
    net = flat(text)
    whole = explorers.explore(net, "--max-states", 5000, "--no-graph")
    assert whole.report["why"] == "states"
    assert_is_quotient(explorers, net, "--threads", 2)


def verdicts(report: dict[str, Any]) -> dict[str, Any]:
    return {
        "dead": report["dead_count"] > 0,
        "bounds": report["bounds"],
        "dead transitions": [count == 0 for count in report["fired"]],
        "live transitions": report["graph"]["live"],
        "infinite": report["graph"]["fairness"] is not None,
        "fairness": report["graph"]["fairness"],
    }


def test_verdicts_are_those_of_the_whole_space(explorers: Explorers) -> None:
    net = flat(FINITE)
    whole = explorers.explore(net)
    reduced = assert_is_quotient(explorers, net)
    assert reduced.report["nodes"] < whole.report["nodes"]
    assert verdicts(reduced.report) == verdicts(whole.report)


COUNTING = """
    net Counting
      standard
      colset PART = int with 1..2 timed;
      var p: PART;  var n: INT;
      globref worn = 0;
      place Stock : PART = 1`1 ++ 1`2
      place Done : PART
      trans Make delay @+p code action (worn := (!worn + 1) mod 3)
        in Stock : p
        out Done : p@+3
      trans Renew guard [!worn <> 1]
        in Done : p
        out Stock : p@+5
      trans Mend code action (worn := 2)
        in Done : p@+1
        out Stock : p@+(1 + !worn)
"""
LINE = "\n        "
COUNTED = (
    COUNTING.replace("globref worn = 0;", "place Worn : INT = 0")
    .replace(
        "code action (worn := (!worn + 1) mod 3)",
        f"{LINE}in Worn : n{LINE}out Worn : (n + 1) mod 3",
    )
    .replace("guard [!worn <> 1]", f"guard [n <> 1]{LINE}both Worn : n")
    .replace("code action (worn := 2)", f"{LINE}in Worn : n{LINE}out Worn : 2")
    .replace("1 + !worn", "1 + 2")
)


def test_references_are_as_good_as_places(explorers: Explorers) -> None:
    """What they hold is a part of the state (docs/verify.md)."""
    place = assert_is_quotient(explorers, flat(COUNTED))
    net = flat(COUNTING)
    assert why_not_reducible(net) is None
    found = explorers.explore(net, "--reduce", "time")
    for key in ("complete", "nodes", "dead_count", "fired"):
        assert found.report[key] == place.report[key]
    assert found.report["nodes"] > 20 and len(found.arcs) == len(place.arcs)


REFUSED = """
    net Refused
      standard
      colset T = int timed;
      var t, n: T;
      globref kept = [1@0];
      fun late () = time() > 5
      place A : T = 1`1
      place N : T
      trans Go %s
        in A : t
        out N : %s
"""


@pytest.mark.parametrize(
    ("clauses", "output", "why"),
    [
        ("guard [late ()]", "t", "reads the model time"),
        ("guard [step() < 7]", "t", "reads the number of steps"),
        ("delay @+discrete(1, 2)", "t", "draws random numbers"),
        ("code action (kept := [2@7])", "t", "makes or looks at time stamps"),
        ("", "!kept", "makes or looks at time stamps"),
        ("", "[t@7]", "makes or looks at time stamps"),
        ("", "if [1@0] = [t@0] then 1`t else empty", "makes or looks at time stamps"),
    ],
)
def test_what_reads_the_time_is_refused(clauses: str, output: str, why: str) -> None:
    found = why_not_reducible(flat(REFUSED % (clauses, output)))
    assert found is not None and why in found.message


@pytest.mark.parametrize(
    ("delay", "refused"),
    [("(~1)", True), ("3", False), ("n", True), ("soon", False), ("past", True), ("odd", True)],
)
def test_early_delays_must_not_be_negative(delay: str, refused: bool) -> None:
    text = REFUSED.replace("in A : t", f"in A : t@+{delay}")
    values = "val soon = 2 * 3; val past = ~2; val (odd, even) = (~1, 2);"
    text = text.replace("globref", f"{values}\n      globref", 1)
    net = flat(text % ("", "t") + "        in N : n\n" * (delay == "n"))
    assert (why_not_reducible(net) is not None) == refused


def test_real_clocks_are_refused() -> None:
    found = why_not_reducible(
        flat(TWO_MACHINES.replace("net Machines", "net Machines\n      option realtimestamp true"))
    )
    assert found is not None and "rounded" in found.message


STUCK = """
    net Stuck
      standard
      colset PART = int with 1..4 timed;
      var p: PART;  var n: INT;
      place Stock : PART = 1`1 ++ 1`2
      place Wear : INT = 1`0
      place Done : PART
      trans Make guard [n < 4] delay @+p
        in Stock : p
        in Wear : n
        out Wear : n + 1
        out Done : p@+3
      trans Renew
        in Done : p@+1
        out Stock : p@+5
"""


def test_traces_have_the_true_times(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    net = write(STUCK, tmp_path / "stuck.cpn")
    monkeypatch.chdir(tmp_path)
    run = CliRunner().invoke(app, ["verify", str(net), "--reduce", "time", "--report", "r.txt"])
    assert run.exit_code == 0, run.output
    assert "REDUCED by time" in Path("r.txt").read_text()
    (trace,) = tmp_path.glob("stuck.traces/stuck.dead-*.trace.jsonl")
    assert any('"t": 1' in line for line in trace.read_text().splitlines())
    replay = ["replay", str(trace), str(net), "--json", "--engine", "reference"]
    answer = json.loads(CliRunner().invoke(app, replay).stdout)
    assert answer["ok"] and answer["steps"] >= 4, answer
    assert answer["time"] >= 10


def test_a_net_that_reads_the_time_is_explored_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = STUCK.replace("guard [n < 4]", "guard [n < 4, time() < 100]")
    net = write(text, tmp_path / "stuck.cpn")
    monkeypatch.chdir(tmp_path)
    run = CliRunner().invoke(app, ["verify", str(net), "--reduce", "time", "--most-traces", "0"])
    assert run.exit_code == 0, run.output
    assert "reduction-not-possible" in run.output and "reads the model time" in run.output
    assert "REDUCED" not in run.output
