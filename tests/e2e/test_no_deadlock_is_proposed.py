"""A place that is there is proposed for others too: in a cell with deadlocks it must not bring about new ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.geometry_told import tell
from helpers.meeting_cell import NET, TOML, meeting_cell

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

SUPERVISOR = """    place f1 port out : INT
    place d1 port in : INT
    place f2 port out : INT
    place d2 port in : INT
    place Start = 1
    place Asked
    place Go1
    place Go2
    place Ok
    place Busy1
    place Busy2
    place Later
    place Done1
    place Done2
    place Free = 1
    place Finished
    trans Ask
      in Start : ()
      out f1 : 0
      out Asked : ()
    trans Both
      in Asked : ()
      in d1 : 10
      out Go1 : ()
      out Go2 : ()
      out Ok : ()
    trans Second
      in Asked : ()
      in d1 : 11
      out Go2 : ()
      out Later : ()
      out Ok : ()
    trans Never
      in Asked : ()
      in d1 : 12
      out Go1 : ()
      out Go2 : ()
    trans Send1
      in Go1 : ()
      in Free : ()
      out f1 : 1
      out Busy1 : ()
    trans Got1
      in Busy1 : ()
      in d1 : 1
      out Done1 : ()
    trans Send2
      in Go2 : ()
      out f2 : 1
      out Busy2 : ()
    trans Got2
      in Busy2 : ()
      in d2 : n
      out Done2 : ()
    trans Then
      in Later : ()
      in Done2 : ()
      out Done2 : ()
      out Go1 : ()
    trans Finish
      in Done1 : ()
      in Done2 : ()
      in Ok : ()
      out Free : ()
      out Finished : ()
"""
WORK = """    trans Visit1 code input (n) action (visit 0.0)
      in Waiting : ()
      in f : n
      out d : n
      out Waiting : ()"""
TOSSES = """    place Tossed : TOSS
    trans Toss
      in Waiting : ()
      in f : 0
      out Tossed : coin
    trans Say
      in Tossed : coin
      out d : 10 + coin
      out Waiting : ()
    trans Visit1 code action (visit 0.0)
      in Waiting : ()
      in f : 1
      out d : 1
      out Waiting : ()"""


def tossed(supervisor: str) -> str:
    """Robot 1 says by chance whether both begin at once, robot 2 begins, or nothing ever comes to its end."""
    net = NET.replace(
        "  var n : INT;", "  colset TOSS = int with 0..2;\n  var n : INT;\n  var coin : TOSS;"
    )
    head, rest = net.split("  page Sup\n")
    robots = rest.split("  page Rob1\n", 1)[1]
    assert WORK in robots
    return head + "  page Sup\n" + supervisor + "  page Rob1\n" + robots.replace(WORK, TOSSES)


def test_where_robot_1_keeps_the_place_it_is_not_proposed_for_robot_2(tmp_path: Path) -> None:
    """Robot 1 gives it back when both are done. There are fewer states without a way to the end then, but others."""
    net = tossed(SUPERVISOR)
    toml = TOML + "[sensors.coin]\n"
    found = tell(meeting_cell(tmp_path / "cell", guarded=False, net=net, toml=toml), tmp_path)
    assert found.layout["pairs_answer"] == "no"
    (proposal,) = found.layout["proposals"]
    assert not (proposal["works"] and proposal["place_is_there"]), proposal


def test_where_it_is_given_back_it_is_proposed(tmp_path: Path) -> None:
    """There are no deadlocks, before and after."""
    net = NET.replace("1`2", "1`1").replace(
        "      TAKE\n      out f1", "      in Free : ()\n      out f1"
    )
    net = net.replace("      in d1 : n\n      GIVE\n", "      in d1 : n\n      out Free : ()\n")
    found = tell(meeting_cell(tmp_path / "cell", guarded=False, net=net), tmp_path)
    (proposal,) = found.layout["proposals"]
    assert proposal["works"] and proposal["place"] == "Top.Supervisor.Free", proposal
    assert proposal["place_is_there"]
    guarded = net.replace("TAKE", "in Free : ()").replace("GIVE", "out Free : ()")
    again = tell(meeting_cell(tmp_path / "again", guarded=False, net=guarded), tmp_path).layout
    assert (again["moves_answer"], again["pairs_answer"]) == ("yes", "yes")
