"""Reductions of the state space: the answers are those of the whole space."""

from __future__ import annotations

import json
import re
from itertools import permutations
from pathlib import Path
from random import Random

import pytest

from helpers.concurrent_nets import concurrent
from helpers.explored import Explored, Explorers, node_key
from helpers.netbuilder import flat, write
from helpers.table_nets import TableExplorer, orbits, random_net, symmetric_net
from helpers.thorough import amount
from pn2code.cli import main
from pn2code.net.flat import FlatNet
from pn2code.verify.answers.path import steps
from pn2code.verify.exploring.dependency import dependency
from pn2code.verify.exploring.elements import elements

pytestmark = pytest.mark.cc

PHILOSOPHERS = """
    net Philosophers
      val n = 5;
      colset PH = int with 0..4;
      var p: PH;
      fun next i = (i + 1) mod n;
      place Think : PH = PH.all ()
      place One : PH
      place Other : PH
      place Eat : PH
      place Fork : PH = PH.all ()
      trans Left
        in Think : p
        in Fork : p
        out One : p
      trans Right
        in Think : p
        in Fork : next p
        out Other : p
      trans Both
        in One : p
        in Fork : next p
        out Eat : p
      trans Too
        in Other : p
        in Fork : p
        out Eat : p
      trans Stop
        in Eat : p
        out Think : p
        out Fork : 1`p ++ 1`(next p)
"""

DATABASE = """
    net Database
      val n = 4;
      colset E = with e;
      colset DBM = index d with 1..n;
      colset PAIR = product DBM * DBM;
      fun others (x, y) = x <> y;
      colset MES = subset PAIR by others;
      var s, r : DBM;
      fun mes x = PAIR.mult (1`x, DBM.all () -- 1`x);
      place Inactive : DBM = DBM.all ()
      place Waiting : DBM
      place Performing : DBM
      place Unused : MES = MES.all ()
      place Sent : MES
      place Received : MES
      place Acknowledged : MES
      place Passive : E = 1`e
      trans Change
        in Inactive : s
        in Passive : e
        in Unused : mes s
        out Waiting : s
        out Sent : mes s
      trans Receive
        in Inactive : r
        in Sent : (s, r)
        out Performing : r
        out Received : (s, r)
      trans Answer
        in Performing : r
        in Received : (s, r)
        out Inactive : r
        out Acknowledged : (s, r)
      trans Finish
        in Waiting : s
        in Acknowledged : mes s
        out Inactive : s
        out Passive : e
        out Unused : mes s
"""


def reduced(
    explorers: Explorers, net: FlatNet, *reductions: str, options: tuple[object, ...] = ()
) -> Explored:
    """Explore with reductions."""
    table = explorers.folder / f"{net.name}.elements"
    table.write_text(elements(net, wants_symmetry=True).text())
    asked = [text for name in reductions for text in ("--reduce", name)]
    return explorers.explore(net, *asked, "--elements", table, *options, name=net.name)


@pytest.fixture(scope="module")
def tables(explorers: Explorers) -> TableExplorer:
    """The program that explores tables."""
    return TableExplorer.build(explorers)


def test_dead_markings_of_random_nets(tables: TableExplorer) -> None:
    less = dead = 0
    for seed in range(amount(40, 400)):
        net = random_net(Random(seed))
        space = net.graph(1500)
        if space is None:
            continue
        found = tables.explore(net, "partial-order")
        assert found["complete"], (seed, found["error"])
        assert found["dead_count"] == len(found["dead"]) == len(net.dead(space)), seed
        less += found["nodes"] < len(space)
        dead += found["dead_count"] > 0
    assert less > 15
    assert dead > 5


def dead_of(found: Explored) -> set[str]:
    """The markings from which no arc leaves, in the graph that was written."""
    nodes: dict[int, str] = {}
    left: set[int] = set()
    for line in found.lines:
        entry = json.loads(line)
        if "node" in entry:
            nodes[entry["node"]] = node_key(entry["t"], entry["marking"])
        else:
            left.add(entry["from"])
    return {text for node, text in nodes.items() if node not in left}


def by_transitions(
    explorers: Explorers, net: FlatNet, *, is_complete: bool = True
) -> tuple[Explored, Explored]:
    """Without partial order, and with that of transitions."""
    whole = explorers.explore(net, name=net.name, reads=False)
    assert whole.report["complete"] is is_complete, whole.report
    table = explorers.folder / f"{net.name}.dependency"
    table.write_text(dependency(net).text())
    options = ("--reduce", "partial-order", "--dependency", table)
    return whole, explorers.said(explorers.folder / net.name, *options)


@pytest.mark.parametrize("seed", range(amount(1, 20)))
def test_dead_markings_of_processes(explorers: Explorers, seed: int) -> None:
    """With code segments, references, priorities, lists; all nets of the file in one program."""
    whole, found = by_transitions(explorers, flat(concurrent(seed, amount(5, 30))))
    assert found.report["complete"], found.report
    assert found.report["nodes"] < whole.report["nodes"]
    assert dead_of(found) == dead_of(whole)
    assert found.report["dead_count"] == whole.report["dead_count"] > 10


@pytest.mark.parametrize("seed", range(amount(1, 20)))
def test_dead_markings_of_processes_that_count(explorers: Explorers, seed: int) -> None:
    """Where transitions replace the only tokens of places, in ways of which some commute."""
    whole, found = by_transitions(explorers, flat(concurrent(seed, amount(4, 30), counters=3)))
    assert found.report["complete"], found.report
    assert found.report["nodes"] < 0.7 * whole.report["nodes"]
    assert dead_of(found) == dead_of(whole)
    assert found.report["dead_count"] == whole.report["dead_count"] > 10


BEGIN = """
          trans Begin
            in Q : ()
            out A : ()"""
PLUS = """
          trans Plus
            in A : ()
            in N : n
            out N : n + 3"""
MINUS = """
          trans Minus
            in B : ()
            in N : n
            out N : n - 3"""


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("order", list(permutations((BEGIN, PLUS, MINUS))))
def test_a_sum_that_gets_too_great_is_not_missed(
    explorers: Explorers, order: tuple[str, ...], first: int
) -> None:
    """In one order only; `Plus` may have to wait for a step with which `Minus` has nothing to do."""
    text = f"""
        net Raises
          standard
          colset SMALL = int with 0..5;
          var n: SMALL;
          place N : SMALL = 1`4
          place Q = {1 - first}
          place A = {first}
          place B = 1
{"".join(order)}
    """
    _, found = by_transitions(explorers, flat(text), is_complete=False)
    assert found.report["error"]["kind"] == "exception", found.report


def test_an_exception_is_not_missed(explorers: Explorers) -> None:
    """Although another process, which has nothing to do with it, could go on for ever."""
    text = """
        net Raises
          colset INT = int;
          var x, y: INT;
          place A : INT = 1`1
          place B : INT
          place C : INT = 1`0
          trans Tick
            in C : y
            out C : 1 - y
          trans Move
            in A : x
            out B : x - 1
          trans Divide
            in B : x
            out A : 6 div x
    """
    net = flat(text)
    whole = explorers.explore(net, name=net.name, reads=False)
    table = explorers.folder / f"{net.name}.dependency"
    table.write_text(dependency(net).text())
    options = ("--reduce", "partial-order", "--dependency", table)
    found = explorers.said(explorers.folder / net.name, *options)
    assert whole.report["error"]["kind"] == found.report["error"]["kind"] == "exception"


def test_orbits_of_random_nets(tables: TableExplorer) -> None:
    less = 0
    for seed in range(amount(40, 400)):
        net, group = symmetric_net(Random(seed))
        space = net.graph(1500)
        if space is None:
            continue
        found = tables.explore(net, "symmetry")
        dead = orbits(net.dead(space), group)
        assert found["complete"], (seed, found["error"])
        assert (found["nodes"], found["dead_count"]) == (orbits(space, group), dead), seed
        both = tables.explore(net, "symmetry", "partial-order")
        assert both["complete"], (seed, both["error"])
        assert both["dead_count"] == dead, seed
        less += found["nodes"] < len(space)
    assert less > 10


def test_philosophers(explorers: Explorers, tmp_path: Path) -> None:
    net = flat(PHILOSOPHERS)
    whole = explorers.explore(net, name=net.name)
    assert whole.report["nodes"] == 243
    assert whole.report["dead_count"] == 2
    for reductions, nodes in (
        (("partial-order",), 15),
        (("symmetry",), 51),
        (("partial-order", "symmetry"), 11),
    ):
        options = ("--trace-to", tmp_path / "t", "--traces", 9, "--threads", 2)
        found = reduced(explorers, net, *reductions, options=options)
        report = found.report
        assert report["reductions"] == list(reductions)
        assert (report["nodes"], report["dead_count"]) == (nodes, 2)
        assert report["graph"] is None
        assert len(report["traces"]) == len(report["dead"]) == 2
        ends = set()
        for trace in report["traces"]:
            told = steps(net, {}, Path(trace["file"]), most=99)  # the token game plays it
            assert len(told) == trace["steps"] == 5
            ends.add(frozenset(t.transition for t in told))
        assert ends == {frozenset({"Top.Left"}), frozenset({"Top.Right"})}


def test_database(explorers: Explorers) -> None:
    net = flat(DATABASE)
    found = reduced(explorers, net, "symmetry").report
    assert (
        found["nodes"] == 1 + 4 * 5 // 2
    )  # how many have got the message, and how many have answered
    assert found["dead_count"] == 0
    found = reduced(explorers, net, "partial-order").report
    assert found["nodes"] < 4 * 3**3
    assert found["dead_count"] == 0


def test_a_table_of_another_net_is_found_out(explorers: Explorers) -> None:
    net = flat(PHILOSOPHERS)
    text = elements(net).text()
    table = explorers.folder / "wrong.elements"
    lines = text.splitlines()
    at = max(i for i, line in enumerate(lines) if line == "25") + 1  # the first element
    without = [*lines[: at - 1], "24", *lines[at + 1 :]]
    assert lines[at].endswith(" 1 0 0")  # it puts one token
    other = [*lines[:at], lines[at].removesuffix("1 0 0") + "2 0 0", *lines[at + 1 :]]
    for wrong, kind in (
        (without, "mismatch"),
        (other, "mismatch"),
        ([lines[0], "5 5 5 5 5 6", *lines[2:]], "reduction"),
        (lines[:-3], "reduction"),
        (["something else"], "reduction"),
    ):
        table.write_text("\n".join(wrong) + "\n")
        options = ("--reduce", "partial-order", "--elements", table)
        report = explorers.explore(net, *options, name=net.name).report
        assert not report["complete"]
        assert report["error"]["kind"] == kind, report["error"]


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(PHILOSOPHERS, tmp_path / "net.cpn")

    def verify(*options: str) -> str:
        with pytest.raises(SystemExit) as ended:
            main.app(["verify", str(path), "--traces", str(tmp_path), *options])
        assert not ended.value.code
        return capsys.readouterr().out

    found = json.loads(verify("--json", "--reduce", "partial-order"))
    assert (found["complete"], found["nodes"], found["dead_markings"]) == (True, 15, 2)
    assert found["reductions"] == ["partial-order"]
    for unknown in ("arcs", "scc_nodes", "home_markings", "live_transitions", "dead_transitions"):
        assert found[unknown] is None
    assert found["fairness"] is None
    assert found["bounds"] == []
    found = json.loads(verify("--json", "--reduce", "symmetry", "--most-traces", "0"))
    assert found["symmetries"] == ["rotations of PH"]
    assert found["nodes"] == 51
    assert found["dead_transitions"] == []
    assert {b["name"]: (b["lower"], b["upper"]) for b in found["bounds"]}["Eat"] == (0, 2)
    found = json.loads(verify("--json", "--reduce", "symmetry", "--no-reduction"))
    assert (found["nodes"], found["reductions"]) == (243, [])
    assert found["arcs"] is not None
    text = verify("--full", "--reduce", "partial-order", "--reduce", "symmetry")
    assert "REDUCED by partial-order, symmetry." in text
    assert re.search(r"Arcs: +complete: [\d,]+ of the reduced space", text)
    assert "Home Markings" not in text
