"""The explorer under the sanitizers for addresses, undefined behaviour and threads."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.explored import THREADS, Explored, Explorers, agrees
from helpers.netbuilder import flat
from helpers.questions import ask
from helpers.random_graphs import numbered
from helpers.thorough import amount

pytestmark = pytest.mark.cc

BAGS = """
    net Bags
      colset INT = int;
      colset LIST = list INT;
      var n : INT;
      var l : LIST;
      place Numbers : INT = 1`1 ++ 1`2 ++ 1`3 ++ 1`4
      place Lists : LIST = 1`[] ++ 1`[7]
      trans Put
        in Numbers : n
        in Lists : l
        out Lists : n :: l
"""

CONDITIONS = (
    "List.all (fn n => n > 0) Numbers",
    "length Lists > 1 andalso length Numbers > 2",
    "hd Numbers > 0",
)
QUESTIONS = [
    *("pred 0", "pred 1", "not 1", "pred 2", "eg 1", "au 1 2", "ex 2"),
    *(
        "? invariant 0",
        "? invariant 1",
        "? initially 4",
        "? initially 5",
        "? within-firings f0 s1 1",
    ),
    *(
        "? lasso",
        "automaton 2 0",
        "accepting 1",
        "arc 0 1 +3 -f0",
        "arc 1 1",
        "strong 0",
        "weak 0",
        "end",
    ),
]


def sorted_bounds(found: Explored) -> list[dict[str, object]]:
    """Colours come in the order in which they were seen."""
    return [
        {k: sorted(map(str, v)) if isinstance(v, list) else v for k, v in place.items()}
        for place in found.report["bounds"]
    ]


@pytest.mark.parametrize("what", ["addresses", "threads"][: amount(1, 2)])
def test_sanitized(sanitized: Explorers, tmp_path: Path, what: str) -> None:
    explorers = sanitized
    if what == "threads":
        explorers = Explorers.open(tmp_path / "explorers", THREADS)
    bags = flat(BAGS)
    one = explorers.explore(bags, "--threads", 1, "--traces", 3, "--trace-to", tmp_path / "t")
    for options in (("--threads", 2), ("--threads", 2, "--order", "dfs"), ("--spill", tmp_path)):
        other = explorers.explore(bags, *options)
        assert other.report["complete"]
        assert (other.report["nodes"], other.report["arcs"]) == (
            one.report["nodes"],
            one.report["arcs"],
        )
        assert sorted_bounds(other) == sorted_bounds(one)
        assert (other.nodes, other.arcs) == (one.nodes, one.arcs)
    assert len(list(tmp_path.glob("*.trace.jsonl"))) == 3
    for kind in ("hash", "bitstate"):
        explorers.explore(bags, "--approximate", kind, "--threads", 2)
    for how in (("--shuffle", 4), ("--walk", "--max-states", 300)):
        one = explorers.explore(
            bags, "--swarm", 3, *how, "--sketch", 20, "--trace-to", tmp_path / "s"
        )
        assert one.report["swarm"]["dead_trace"]["steps"] == 4
    explorers.explore(bags, "--max-states", 100)
    asked = ask(explorers, BAGS, CONDITIONS, "asked")
    whole, answers = asked.say(QUESTIONS, "--threads", 2)
    assert whole.report["complete"]
    assert [a["answer"] for a in answers] == ["yes", "no", "no", "yes", "no", "unknown"]
    ends = ("owner 0 0", "within 0 9 -", "ef 0", "? ends 1")  # walks look what follows, too
    walk = ("--swarm", 2, "--walk", "--max-depth", 2, "--max-states", 9_000, "--sketch", 20)
    _, (trapped,) = asked.say(ends, *walk)
    assert trapped["answer"] == "no" and trapped["steps"] == 0
    early, answers = asked.say([*QUESTIONS[:4], "? invariant 1", "? invariant 3"], "--threads", 2)
    assert early.report["why"] == "decided" and [a["steps"] for a in answers] == [2, None]
    for number in (1, 5)[: amount(what == "addresses", 2)]:
        agrees(explorers, flat(numbered(number)), "--threads", 2, width=number % 3)
