"""State spaces whose sizes are known from the literature, or from a formula."""

from __future__ import annotations

import pytest

from helpers.explored import Explorers
from helpers.netbuilder import flat
from helpers.thorough import amount

pytestmark = pytest.mark.cc

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
      place Active : E
      trans Change
        in Inactive : s
        in Passive : e
        in Unused : mes s
        out Waiting : s
        out Active : e
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
        in Active : e
        in Acknowledged : mes s
        out Inactive : s
        out Passive : e
        out Unused : mes s
"""

PROTOCOL = """
    net Protocol
      colset INT = int;
      colset BOOL = bool;
      colset DATA = string;
      colset PACKET = product INT * DATA;
      colset SLOT = with slot;
      var n, k : INT;
      var p, text : DATA;
      var isFine : BOOL;
      val stop = "####";
      val limit = 1;
      val keepsGreater = false;
      fun acknowledged (old, fresh) = if keepsGreater then Int.max (old, fresh) else fresh;
      place ToSend : PACKET = 1`(1, "Verif") ++ 1`(2, "icati") ++ 1`(3, "on#") ++ 1`(4, stop)
      place NextSend : INT = 1`1
      place A : PACKET
      place B : PACKET
      place C : INT
      place D : INT
      place NextReceived : INT = 1`1
      place Received : DATA = 1`""
      place Limit : SLOT = limit`slot
      trans Send
        both ToSend : (n, p)
        both NextSend : n
        in Limit : slot
        out A : (n, p)
      trans CarryPacket
        in A : (n, p)
        out B : if isFine then 1`(n, p) else empty
        out Limit : if isFine then empty else 1`slot
      trans Receive
        in B : (n, p)
        in NextReceived : k
        in Received : text
        out NextReceived : if n = k then k + 1 else k
        out Received : if n = k andalso p <> stop then text ^ p else text
        out C : if n = k then k + 1 else k
      trans CarryAnswer
        in C : n
        out D : if isFine then 1`n else empty
        out Limit : if isFine then empty else 1`slot
      trans ReceiveAnswer
        in D : n
        in NextSend : k
        out NextSend : acknowledged (k, n)
        out Limit : slot
"""

PHILOSOPHERS = """
    net Philosophers
      val n = 5;
      colset PH = index ph with 1..n;
      colset CS = index cs with 1..n;
      var p : PH;
      fun forks (ph (i)) = 1`cs (i) ++ 1`cs (if i = n then 1 else i + 1);
      place Think : PH = PH.all ()
      place Eat : PH
      place Unused : CS = CS.all ()
      trans Take
        in Think : p
        in Unused : forks p
        out Eat : p
      trans PutDown
        in Eat : p
        out Think : p
        out Unused : forks p
"""


@pytest.mark.parametrize("n", [2, 3, 4, 6, 7])
def test_distributed_database(explorers: Explorers, n: int) -> None:
    report = explorers.explore(flat(DATABASE, {"n": str(n)})).report
    assert report["complete"]
    assert report["nodes"] == 1 + n * 3 ** (n - 1)
    assert report["arcs"] == 2 * n * (1 + (n - 1) * 3 ** (n - 2))
    assert report["graph"]["scc_nodes"] == 1
    assert report["graph"]["home_count"] == report["nodes"]
    assert report["graph"]["live"] == [True] * 4
    assert report["dead_count"] == 0
    upper = {"Inactive": n, "Waiting": 1, "Unused": n * (n - 1), "Sent": n - 1}
    places = [p.short for p in flat(DATABASE).places]
    for name, most in upper.items():
        assert report["bounds"][places.index(name)]["upper"] == most, name


PROTOCOL_SIZES = {
    (1, "false"): (33, 44),
    (2, "false"): (428, 1130),
    (3, "false"): (3329, 12825),
    (4, "false"): (18520, 91220),
    (1, "true"): (33, 44),
    (2, "true"): (293, 764),
    (3, "true"): (1829, 6860),
    (4, "true"): (9025, 43124),
}


@pytest.mark.parametrize("case", [*PROTOCOL_SIZES][: amount(7, 8)], ids=str)
def test_simple_protocol(explorers: Explorers, case: tuple[int, str]) -> None:
    limit, keeps_greater = case
    values = {"limit": str(limit), "keepsGreater": keeps_greater}
    report = explorers.explore(flat(PROTOCOL, values)).report
    assert report["complete"]
    assert (report["nodes"], report["arcs"]) == PROTOCOL_SIZES[case]
    assert report["dead_count"] == 1
    limit_place = [p.short for p in flat(PROTOCOL).places].index("Limit")
    assert report["bounds"][limit_place]["upper"] == limit


def eating(n: int) -> int:
    """Ways in which some of n philosophers at a round table eat, no two beside each other: the Lucas numbers."""
    before, now = 2, 1
    for _ in range(n - 1):
        before, now = now, before + now
    return now


@pytest.mark.parametrize("n", [3, 5, 12])
def test_philosophers(explorers: Explorers, n: int) -> None:
    found = [explorers.explore(flat(PHILOSOPHERS, {"n": str(n)}), "--threads", t) for t in (1, 2)]
    for report in (f.report for f in found):
        assert report["nodes"] == eating(n)
        assert report["graph"]["scc_nodes"] == 1
        assert report["bounds"][1]["upper"] == n // 2
    assert found[0].nodes == found[1].nodes, "numbers of nodes depend on the threads"
    assert sorted(found[0].arcs) == sorted(found[1].arcs)
