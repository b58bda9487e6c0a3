"""A zone that nobody guards, where one coloured place says of all robots and jobs what is being done."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.geometry_told import tell
from helpers.meeting_cell import NET, TOML, meeting_cell

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

_REST = (
    "trans Rest{0} guard [n <> 2] code action (moveHome ())\n      in Waiting : ()\n      in f : n\n"
    + ("      out d : n\n      out Waiting : ()\n")
)


def coloured(net: str = NET) -> str:
    """One place for both robots and for both of their jobs, of which only the second one leads into the zone."""
    out = net.replace("    place Busy1 : INT\n    place Busy2 : INT\n", "    place Doing : DOING\n")
    out = out.replace("  var n : INT;\n", "  colset DOING = product INT * INT;\n  var n : INT;\n")
    for r in ("1", "2"):
        out = out.replace(f"out Busy{r} : n", f"out Doing : ({r}, n)")
        out = out.replace(f"in Busy{r} : n", f"in Doing : ({r}, n)")
        out = out.replace(
            f"trans Visit{r} code", f"{_REST.format(r)}    trans Visit{r} guard [n = 2] code"
        )
    return out


def test_a_coloured_place_tells_who_is_there_and_why(tmp_path: Path) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=False, net=coloured())
    told = tell(cell, tmp_path)
    found = told.layout
    assert (found["moves_answer"], found["pairs_answer"]) == ("yes", "no")
    (proposal,) = found["proposals"]
    assert proposal["works"], proposal
    assert proposal["takes"] == ["Top.Supervisor.Send1", "Top.Supervisor.Send2"]
    assert proposal["takes_when"] == ["n = 2", "n = 2"]
    assert proposal["gives_when"] == ["n = 2", "n = 2"]
    assert proposal["while"] == ["Top.Supervisor.Doing"] * 2
    assert proposal["while_with"] == ["#1 = 1 and #2 = 2", "#1 = 2 and #2 = 2"]
    done = told.command()
    assert (
        "taken by `Top.Supervisor.Send1` if `n = 2` and `Top.Supervisor.Send2` if `n = 2`"
        in done.stdout
    )
    assert "if CONDITION then 1`() else empty" in done.stdout
    assert proposal["refused"] is None
    assert "`generate` objects to nothing in its supervisor" in done.stdout


def test_with_the_place_that_is_proposed_arms_keep_apart(tmp_path: Path) -> None:
    """As it is drawn after what was said."""
    net = coloured().replace("TAKE", "in Free : if n = 2 then 1`() else empty")
    net = net.replace("GIVE", "out Free : if n = 2 then 1`() else empty")
    found = tell(meeting_cell(tmp_path / "cell", guarded=True, net=net), tmp_path).layout
    assert (found["moves_answer"], found["pairs_answer"]) == ("yes", "yes")


def test_one_transition_for_all_robots(tmp_path: Path) -> None:
    """It sends to the one or the other, and only then its token belongs to the zone."""
    net = NET.replace("    place Busy1 : INT\n    place Busy2 : INT\n", "    place Doing : DOING\n")
    net = net.replace(
        "    place Left1 : INT = 1`2\n    place Left2 : INT = 1`2\n",
        "    place Left : DOING = 1`(1, 2) ++ 1`(2, 2)\n",
    )
    net = net.replace(
        "  var n : INT;\n", "  colset DOING = product INT * INT;\n  var n, r : INT;\n"
    )
    begin, end = net.index("    trans Send1"), net.index("    trans Finish")
    net = (
        net[:begin]
        + """    trans Send guard [n > 0]
      in Left : (r, n)
      TAKE
      out f1 : if r = 1 then 1`n else empty
      out f2 : if r = 2 then 1`n else empty
      out Doing : (r, n)
    trans Got1
      in Doing : (1, n)
      in d1 : n
      GIVE
      out Left : (1, n - 1)
    trans Got2
      in Doing : (2, n)
      in d2 : n
      GIVE
      out Left : (2, n - 1)
    trans End
      in Left : 1`(1, 0) ++ 1`(2, 0)
      out Done1 : ()
      out Done2 : ()
"""
        + net[end:]
    )
    found = tell(
        meeting_cell(tmp_path / "cell", guarded=False, net=net, toml=TOML), tmp_path
    ).layout
    assert found["pairs_answer"] == "no"
    (proposal,) = found["proposals"]
    assert proposal["works"], proposal
    assert proposal["takes"] == ["Top.Supervisor.Send"]
    assert proposal["gives"] == ["Top.Supervisor.Got1", "Top.Supervisor.Got2"]
    assert proposal["while_with"] == ["#1 = 1", "#1 = 2"]
    guarded = net.replace("    trans Send guard", "    trans Send guard")
    found = tell(
        meeting_cell(tmp_path / "guarded", guarded=True, net=guarded, toml=TOML), tmp_path
    ).layout
    assert found["pairs_answer"] == "yes"


def test_an_arm_that_rests_there_is_told_as_such(tmp_path: Path) -> None:
    """It shares no zone: it stands there, from the start or where a command has left it."""
    stays = NET.replace("work (); moveLinear (at (1100.0, rz)); moveHome ());", "work ());")
    assert stays != NET
    cell = meeting_cell(tmp_path / "stays", guarded=False, net=stays)
    told = tell(cell, tmp_path)
    (proposal,) = told.layout["proposals"]
    assert {(x["robot"], x["from_start"]) for x in proposal["rests"]} <= {
        ("robot1", False),
        ("robot2", False),
    }
    assert proposal["rests"] and not any("at rest" in x for x in proposal["transitions"])
    done = told.command()
    assert "share a zone" not in done.stdout and "come to where robot1" in done.stdout
    assert "rests at 1500 0 700, 180 0" in done.stdout
    assert "where a command has left it: bring it out" in done.stdout
    # Robot 2 is never commanded, and its HOME is where robot 1 works.
    idle = NET.replace("place Left2 : INT = 1`2", "place Left2 : INT = 1`0")
    toml = TOML.replace(
        "base = { x = 3.0, y = 0.0, z = 0.0, yaw = 180.0 }\nhome = [0.0, -120.0, 125.0, 0.0, 85.0, 0.0]",
        "base = { x = 3.0, y = 0.0, z = 0.0, yaw = 180.0 }\nhome = [0.0, -45.0, 90.0, 0.0, 45.0, 0.0]",
    )
    assert idle != NET and toml != TOML
    cell = meeting_cell(tmp_path / "idle", guarded=False, net=idle, toml=toml)
    told = tell(cell, tmp_path)
    (proposal,) = told.layout["proposals"]
    assert [(x["robot"], x["from_start"]) for x in proposal["rests"]] == [("robot2", True)]
    done = told.command()
    assert "`Top.Robot1.Visit1` comes to where robot2 rests" in done.stdout
    assert "from the start of each run, so that no place alone keeps them apart" in done.stdout


def test_a_place_that_is_there_and_serves_only_one_of_them(tmp_path: Path) -> None:
    """It is said whom it serves and whom not, and it is what is proposed, not a second one.

    Its arcs are written with a number of tokens, or not at all, as people write them.
    """
    net = NET.replace("      TAKE\n", "      in Free\n", 1)
    net = net.replace("      GIVE\n", "      out Free\n", 1)
    net = net.replace("out Busy2 : n", "out Busy2 : 1`n")
    toml = TOML.replace('order = "documented"\n', "")
    cell = meeting_cell(tmp_path / "cell", guarded=False, net=net, toml=toml)
    told = tell(cell, tmp_path)
    (proposal,) = told.layout["proposals"]
    assert proposal["works"], proposal
    # Whoever draws it is not surprised: nothing was said of that.
    sends = "`Top.Supervisor.Send1` or `Top.Supervisor.Send2` comes first matters"
    assert sends in proposal["refused"] and proposal["refused"].startswith("confluence: ")
    assert 'if that may be so, write `order = "documented"`' in told.command().stdout
    assert (proposal["place"], proposal["place_is_there"]) == ("Top.Supervisor.Free", True)
    assert proposal["takes"] == ["Top.Supervisor.Send2"]
    assert proposal["gives"] == ["Top.Supervisor.Got2"]
    (served,) = proposal["served"]
    assert served["during"] == ["Top.Robot1.Visit1"]
    assert served["but_not"] == ["Top.Robot2.Visit2"]
    said = told.command().stdout
    assert "(robot1 and robot2) share a zone" in said
    assert (
        "the token of `Top.Supervisor.Free` is away whenever `Top.Robot1.Visit1` is under way, "
        "but not always while `Top.Robot2.Visit2` is"
    ) in said
    assert "proposal: the token `()` of `Top.Supervisor.Free`, a place that is there" in said
    assert "also taken by `Top.Supervisor.Send2`" in said
    assert (
        "arcs to draw: `Top.Supervisor.Free` -> `Top.Supervisor.Send2`, "
        "`Top.Supervisor.Got2` -> `Top.Supervisor.Free`"
    ) in said
