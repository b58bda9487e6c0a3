"""A place that grows without bound: `verify` ends early, says which and by which run, and refutes its bounds."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from helpers.netbuilder import write
from helpers.processes import pn2code
from helpers.small_cell import NET as CELL
from helpers.small_cell import write as write_cell
from helpers.thorough import amount
from pn2code.verify.controller import proofs

pytestmark = pytest.mark.cc

NET = """
net Grows
  standard
  var n : INT
  page Top
    place A : INT = 1`1++1`2
    place B : INT
    place C
    place D = 1`()
    trans Go
      in A : n
      out B : n
      out C : ()
    trans Back
      in B : n
      out A : n
    trans Use
      in C : ()
      out D : ()
"""
MAY_SEE = ("--max-states", "200")
"""As soon as so many are known, it is asked whether there is an end."""


@pytest.fixture(scope="module")
def net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(NET, tmp_path_factory.mktemp("grows") / "grows.cpn")


def test_the_place_and_the_run_are_said(net: Path, tmp_path: Path) -> None:
    done = pn2code("verify", net, *MAY_SEE, "--traces", tmp_path)
    text = " ".join(done.stdout.split())
    assert done.returncode == 3
    assert (
        "PARTIAL: the state space is infinite. Place `Top.C` grows without bound: from the start `Top.Go`, "
        in text
    )
    assert "`Top.Back` can be repeated for ever, and each round adds 1 to `Top.C`" in text
    assert text.endswith("Verdict: NOT COMPLETE. The state space is infinite.")
    (trace,) = tmp_path.iterdir()
    assert str(trace) in text.replace(" ", "") or trace.name in text
    again = pn2code("replay", trace, net)
    assert again.returncode == 0, again.stdout + again.stderr


TIMER = """
net Timer
  standard
  colset TU = unit timed;
  page Top
    place Clock : TU = 1`()
    trans Tick
      in Clock : ()
      out Clock : ()@+3
"""


def test_a_time_that_goes_on_for_ever_is_said(tmp_path: Path) -> None:
    """Without a limit nothing else would end it; where it is counted apart, or a limit is set, all is as it was."""
    net = write(TIMER, tmp_path / "timer.cpn")
    done = pn2code("verify", net, "--traces", tmp_path / "runs")
    text = " ".join(done.stdout.split())
    assert done.returncode == 3
    assert (
        "PARTIAL: the state space is infinite. Time goes on for ever, and each marking has its time"
        in text
    )
    assert (
        "`Top.Tick` can be repeated for ever, every 3 units of time, and all is as before" in text
    )
    assert "`--reduce time` counts markings that differ in the time alone as one" in text
    assert "Grows, perhaps" not in text
    (trace,) = (tmp_path / "runs").iterdir()
    again = pn2code("replay", trace, net)
    assert again.returncode == 0, again.stdout + again.stderr
    said = json.loads(pn2code("verify", net, "--traces", tmp_path / "runs", "--json").stdout)
    assert (said["why"], said["unbounded"]["places"], said["unbounded"]["later"]) == (
        "infinite",
        [],
        3,
    )
    assert pn2code("verify", net, "--reduce", "time", "-o", tmp_path).returncode == 0
    limited = json.loads(
        pn2code("verify", net, "--max-states", "200", "--json", "-o", tmp_path).stdout
    )
    assert (limited["why"], limited["unbounded"]) == ("states", None)


def test_bounds_are_refuted_whatever_was_seen(net: Path, tmp_path: Path) -> None:
    asked = (
        "bound C <= 7",
        "bound C <= 1234",
        "bound 0 <= D <= 1",
        "bound Top'A <= 2",
        "deadlock free",
        "bound C <= 9999999",
    )
    options = [word for text in asked for word in ("--property", text)]
    done = pn2code("verify", net, *MAY_SEE, "--traces", tmp_path, "--json", *options)
    said = json.loads(done.stdout)
    assert done.returncode == 1
    assert (said["why"], said["complete"]) == ("infinite", False)
    assert said["unbounded"]["places"] == [{"name": "Top.C", "adds": 1}]
    assert said["unbounded"]["round"] == ["Top.Go", "Top.Back"]
    answers = [p["answer"] for p in said["properties"]]
    assert answers == ["no", "no", "no", "inconclusive", "inconclusive", "no"]
    first, second, third, open_, _, huge = said["properties"]
    assert (
        first["evidence"]["confirmed"]
        and second["evidence"]["confirmed"]
        and third["evidence"]["confirmed"]
    )
    assert second["evidence"]["steps"] > 1234
    assert (huge["evidence"], huge["rests_on"]) == (None, "run")
    assert open_["why"] == "the state space is infinite"
    for p in (first, second, third):
        again = pn2code("replay", p["evidence"]["trace"], net)
        assert again.returncode == 0, again.stdout + again.stderr


def test_going_on_if_that_is_wanted(net: Path, tmp_path: Path) -> None:
    done = pn2code("verify", net, *MAY_SEE, "--unbounded-ok", "--traces", tmp_path, "--json")
    said = json.loads(done.stdout)
    assert (done.returncode, said["why"], said["unbounded"]) == (3, "states", None)
    assert said["nodes"] == 200


def test_without_any_limit_it_ends(net: Path, tmp_path: Path) -> None:
    """The search runs beside the explorer, and tells it to end; what was seen until then is answered."""
    done = pn2code("verify", net, "--traces", tmp_path, "--json", "--property", "never { size (Mark.Top'D 1) > 3 }",
                   "--property", "ctl AG EF initial")  # fmt: skip
    said = json.loads(done.stdout)
    assert (said["why"], [p["answer"] for p in said["properties"]]) == (
        "infinite",
        ["no", "inconclusive"],
    )
    assert said["properties"][0]["evidence"]["confirmed"]


ENDLESS = (
    CELL.replace("guard [n <= 3]", "")
    .replace("out Pieces : n + 1", "out Pieces : n")
    .replace("    trans Report\n", "    place Made\n    trans Report\n      out Made : ()\n")
)
"""The robot counts what it has done: the arc to `Made` should come from there."""


def test_a_cell_in_which_an_arc_is_the_wrong_way_round(tmp_path: Path) -> None:
    cell = write_cell(tmp_path / "cell", ENDLESS)
    done = pn2code("verify", cell, "--max-states", "300", "--traces", tmp_path / "traces", "--json")
    said = json.loads(done.stdout)
    assert said["why"] == "infinite" and done.returncode == 3, done.stderr
    assert [p["name"] for p in said["unbounded"]["places"]] == ["Top.Robot.Made"]
    trace = said["unbounded"]["trace"]
    assert pn2code("replay", trace, cell / "cell.cpn").returncode == 0


def test_generate_says_it_before_anything_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However far the cell is explored: it has no end."""
    monkeypatch.setattr(proofs, "MOST_STATES", 20_000)
    cell = write_cell(tmp_path / "cell", ENDLESS)
    done = pn2code("generate", cell, "-o", tmp_path / "out")
    assert done.returncode == 1
    text = " ".join(done.stderr.split())
    assert "place `Top.Robot.Made` grows without bound in the closed net: " in text
    assert "`Top.Robot.Report`" in text and "is one drawn the wrong way round" in text


GROWING = """
net Grow
  standard
  colset L = list INT;
  var n: INT;
  var l: L;
  page Top
    place Count : INT = 1`0
    place Free = 1
    place Busy
    trans Begin
      in Count : n
      out Count : n + 1
      in Free : ()
      out Busy : ()
    trans Finish
      in Busy : ()
      out Free : ()
"""
QUEUE = GROWING.replace("place Count : INT = 1`0", "place Count : L = 1`[]").replace(
    "      in Count : n\n      out Count : n + 1\n",
    "      in Count : l\n      out Count : l ^^ [1]\n",
)


@pytest.mark.parametrize(
    ("text", "options"),
    [(GROWING, ()), (GROWING, ("--full",)), (QUEUE, ()), (QUEUE, ("--full",))][: amount(3, 4)],
    ids=["a number", "a number, full", "a list", "a list, full"][: amount(3, 4)],
)
def test_what_grows_inside_a_token(tmp_path: Path, text: str, options: tuple[str, ...]) -> None:
    """No place holds more than one token, and there is no end of markings."""
    net = write(text, tmp_path / "net.cpn")
    done = pn2code("verify", net, "--no-unfold", "--max-states", "3000", *options)
    assert done.returncode == 3, done.stderr
    said = " ".join(done.stdout.split())
    assert re.search(r"place `Top.Count` has held 1,50\d different multi-sets", said)


def test_places_that_differ_seldom_are_not_named(tmp_path: Path) -> None:
    """The counter ends; what makes the markings many is how they are put together."""
    text = GROWING.replace("trans Begin\n", "trans Begin guard [n < 30]\n")
    text = text.replace("    trans Finish\n", THREE + "    trans Finish\n")
    options = ("--max-states", "3000", "--no-unfold")
    done = pn2code("verify", write(text, tmp_path / "net.cpn"), *options)
    assert done.returncode == 3, done.stderr
    assert "Grows" not in done.stdout


THREE = "".join(
    f"    place X{k} : INT = 1`0\n    trans Up{k} guard [n < 30]\n      in X{k} : n\n      out X{k} : n + 1\n"
    for k in range(3)
)


def test_times_that_grow_are_not_taken_for_numbers(tmp_path: Path) -> None:
    """Three clocks whose delays have no common part: the markings differ in the times alone."""
    head = "\nnet slow\n  standard\n  colset CLOCK = UNIT timed;\n  page Top\n"
    for i, delay in enumerate((1_000_000_000, 999_999_937, 999_999_893)):
        head += f"    place P{i} : CLOCK = 1`()@0\n"
        head += f"    trans T{i}\n      in P{i} : ()\n      out P{i} : ()@+{delay}\n"
    net = write(head, tmp_path / "net.cpn")
    for options, words in (
        ((), "or the time of a token does, so that there is no end of markings (`--reduce time`"),
        (("--reduce", "time"), "or long delays are gone through in small steps"),
    ):
        done = pn2code("verify", net, "--max-states", "3000", *options)
        assert done.returncode == 3, done.stderr
        assert words in " ".join(done.stdout.split()), done.stdout
