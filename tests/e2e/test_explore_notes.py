"""What transitions do is remembered by the places that they look at: nothing else may come of it."""

from __future__ import annotations

from typing import Any

import pytest

from helpers.explored import Explored, Explorers, agrees
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

NETWORK = """
    net Network
      standard
      colset LUCK = int with 1..4;
      colset DATA = string;
      colset PACKET = product INT * DATA;
      colset PACKETS = list PACKET;
      colset CREDIT = int with 0..2;
      var n, k : INT;
      var d, e : DATA;
      var r : LUCK;
      var ps : PACKETS;
      var c : CREDIT;
      place Send : PACKET = 1`(1, "ab") ++ 1`(2, "cd") ++ 1`(3, "ab")
      place Next : INT = 1`1
      place Credit : CREDIT = 1`2
      place Lost : PACKET
      place Wire : PACKET
      place Log : DATA = 2`"ab"
      place Queue : PACKETS = 1`[]
      place Got : DATA = 1`""
      trans Put
        in Next : n
        both Send : (n, d)
        in Credit : c
        guard [c > 0]
        out Credit : c - 1
        out Next : n + 1
        out Wire : (n, d)
      trans Carry
        in Wire : (n, d)
        in Queue : ps
        out Queue : if r < 3 then ps ^^ [(n, d)] else ps
        out Lost : if r < 3 then empty else 1`(n, d)
        out Log : if r = 1 then 2`d else 1`(d ^ "!")
      trans Take
        in Queue : (n, d) :: ps
        in Got : e
        in Credit : c
        inhibit Wire
        out Credit : c + 1
        out Queue : ps
        out Got : e ^ d
      trans Drop
        in Lost : (n, d)
        out Got : d
"""
TIMED = """
    net Timed
      standard
      colset DATA = string timed;
      colset TIMES = int timed;
      var d : DATA;
      var n : INT;
      place In : DATA = 1`"a"@0 ++ 1`"b"@2 ++ 1`"c"@3
      place Busy : DATA
      place Done : DATA
      place Tick : TIMES = 1`0
      trans Start
        in In : d
        out Busy : d@+(if d = "a" then 3 else 1)
      trans End
        in Busy : d
        out Done : d
        out Done : (d ^ d)@+2
      trans Count
        in Tick : n
        guard [n < 4]
        out Tick : (n + 1)@+1
      trans Join
        in Done : d
        in Done : d ^ d
        guard [String.size d = 1]
"""
LONG = """
    net Long
      %s
      standard
      colset TEXT = string timed;
      colset WIDE = product INT * STRING timed;
      colset TIMES = int timed;
      var d, e : STRING;
      var n : INT;
      place In : WIDE = 1`(1, "a long text, many bytes")@%s ++ 1`(2, "another one, long, too")@%s ++ 2`(3, "x")@%s
      place Busy : WIDE
      place Log : TEXT = 1`"written before the beginning"
      place Tick : TIMES = 1`0
      trans Start
        in In : (n, d)
        out Busy : (n, d)@%s
      trans End
        in Busy : (n, d)@+1
        in Log : e
        out Log : e@+2
        out Log : (d ^ ", at the end")@%s
      trans Count
        in Tick : n
        guard [n < 3]
        out Tick : (n + 1)@+1
"""
LUCKY = """
    net Lucky
      standard
      colset TEXT = string timed;
      var d : STRING;
      var n : INT;
      place In : TEXT = 1`"a"@0 ++ 1`"b"@2 ++ 1`"c"@3
      place Busy : TEXT
      place Left : INT = 1`4
      place Got : STRING = 1`""
      trans Start
        in In : d
        in Left : n
        guard [n > 0 andalso discrete(0, 9) < 9]
        out Left : n - 1
        out Busy : d@+discrete(1, 50)
      trans Again
        in Busy : d
        out In : d@+discrete(1, 3)
      trans End
        in Busy : d
        guard [bernoulli(0.5) = 1]
        out Got : d
"""
CHOICES = """
    net Choices
      standard
      colset K = int with 1..%d;
      colset KS = list K;
      var k, m : K;
      var ks : KS;
      place Todo : INT = %s
      place Seen : KS = 1`[]
      place Done : KS
      var n : INT;
      trans Pick
        in Todo : n
        in Seen : ks
        out Seen : k :: ks
        out Done : %s
"""


def _said(found: Explored) -> dict[str, Any]:
    """All that does not depend on how fast it was."""
    left = {"seconds", "cpu_seconds", "states_per_second", "bytes_per_state", "store_bytes"}
    left |= {"peak_mib", "threads", "order", "depth"}
    said = {k: v for k, v in found.report.items() if k not in left}
    said["graph"] = {k: v for k, v in said["graph"].items() if k != "seconds"}
    for bound in said["bounds"]:
        for multiset in ("lower_multiset", "upper_multiset"):
            bound[multiset] = sorted(bound[multiset])
    return said


@pytest.mark.parametrize("width", [0, 2])
@pytest.mark.parametrize("text", [NETWORK, TIMED])
def test_as_the_token_game_has_it(explorers: Explorers, text: str, width: int) -> None:
    """Tokens that are only put, taken and put, added up; bindings that lead to the same; lists, time, inhibitors."""
    assert agrees(explorers, flat(text), width=width, nodes=3000, arcs=20000) == "same"


@pytest.mark.parametrize("text", [NETWORK, TIMED])
def test_the_same_without_notes(explorers: Explorers, text: str) -> None:
    net = flat(text)
    plain = explorers.explore(net, "--no-notes")
    assert plain.report["nodes"] > 20
    for options in ([], ["--threads", 2], ["--order", "dfs"], ["--lay-again", 30]):
        found = explorers.explore(net, *options)
        assert _said(found) == _said(plain), options
        assert (found.nodes, found.arcs) == (plain.nodes, plain.arcs)


@pytest.mark.parametrize(
    "filled",
    [
        ("", "0", "2", "1", "+3", "+1"),
        ("option realtimestamp true", "0.1", "2.7", "0.4", "++0.3", "++0.7"),
    ],
    ids=["integers", "reals"],
)
def test_long_values_with_stamps(explorers: Explorers, filled: tuple[str, ...]) -> None:
    """Their values are stored apart; tokens may be taken before their stamps."""
    net = flat(LONG % filled)
    assert agrees(explorers, net, width=2, nodes=3000, arcs=20000) == "same"
    plain = explorers.explore(net, "--no-notes")
    for options in ([], ["--threads", 2], ["--order", "dfs"], ["--lay-again", 30]):
        assert _said(explorers.explore(net, *options)) == _said(plain), options


def test_what_is_drawn_is_noted(explorers: Explorers) -> None:
    """The stream starts anew each time, so in the same marking the same is drawn."""
    net = flat(LUCKY)
    plain = explorers.explore(net, "--no-notes")
    assert plain.report["complete"]
    assert plain.report["nodes"] > 20
    for options in ([], ["--threads", 2], ["--order", "dfs"], ["--lay-again", 30]):
        found = explorers.explore(net, *options)
        assert _said(found) == _said(plain), options
        assert (found.nodes, found.arcs) == (plain.nodes, plain.arcs)


def test_notes_are_forgotten_when_there_is_no_room(explorers: Explorers) -> None:
    """More notes than a sixteenth of the memory can hold, and one that is too long by itself."""
    for size, todo, done, memory in ((99, "1`1 ++ 1`2", "k :: ks", 5), (99, "1`1", "[k, m]", 64)):
        net = flat(CHOICES % (size, todo, f"1`({done})"))
        plain = explorers.explore(net, "--no-notes", "--no-graph", reads=False)
        found = explorers.explore(net, "--memory", memory, "--no-graph", reads=False)
        assert found.report["complete"]
        for member in ("nodes", "arcs", "fired", "bounds"):
            assert found.report[member] == plain.report[member], (size, member)


def test_an_exception_comes_all_the_same(explorers: Explorers) -> None:
    """What was noted before it counts; where it is raised is said as without notes."""
    text = NETWORK.replace("out Got : e ^ d", 'out Got : if e = "ab" then hd [] else e ^ d')
    net = flat(text)
    plain, found = (explorers.explore(net, *options) for options in (["--no-notes"], []))
    assert plain.report["why"] == found.report["why"] == "error"
    assert plain.report["error"] == found.report["error"]
    assert (plain.report["arcs"], plain.report["fired"]) == (
        found.report["arcs"],
        found.report["fired"],
    )
