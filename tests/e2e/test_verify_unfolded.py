"""`verify` where a limit ends the exploration: what the unfolded net tells of all markings."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers import netbuilder
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.asked import Asked
from pn2code.verdict.opened import read
from pn2code.verdict.unfolded.look import contradiction, look
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Bounds, Exploration
from pn2code.verify.exploring.unfolded import Unfolded, Whole

TABLE = """
    net Table
      colset UNIT = unit;
      val n = 9;
      colset PH = index ph with 1..n;
      var p : PH;
      fun other (ph i) = ph (if i = n then 1 else i + 1);
      place Thinks : PH = PH.all ()
      place Forks : PH = PH.all ()
      place Waits : PH
      place Eats : PH
      trans Left
        in Thinks : p
        in Forks : p
        out Waits : p
      trans Right
        in Waits : p
        in Forks : other p
        out Eats : p
      trans Down
        in Eats : p
        out Thinks : p
        out Forks : 1`p ++ 1`other p
      trans Never
        in Eats : p
        in Thinks : p
        out Eats : p
"""
PROPERTIES = [
    "--property", "deadlock free",
    "--property", "bound Top'Eats <= 4",
    "--property", "mutex {cf (ph 1, Mark.Top'Eats 1) > 0}, {cf (ph 2, Mark.Top'Eats 1) > 0}",
    "--property", "ctl AG EF initial",
    "--property", "every fires(Top'Left) is followed by fires(Top'Down) within 9 firings",
]  # fmt: skip


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return netbuilder.write(TABLE, tmp_path_factory.mktemp("table") / "table.cpn")


def verify(*arguments: object) -> tuple[int, str]:
    timed = ("--max-seconds", "600")  # on a busy machine, too
    result = CliRunner().invoke(app, ["verify", *map(str, arguments), *timed])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout


def test_the_same_as_all_markings(table: Path, tmp_path: Path) -> None:
    """Explored to the end, up to a limit, and not at all: what is answered in each way is the same."""
    common = [table, "--json", *PROPERTIES, "-o", tmp_path]
    rows = {}
    for name, more in (("all", ()), ("limit", ("--max-states", 20)), ("none", ("--unfold",))):
        code, printed = verify(*common, *more)
        assert code == 1
        rows[name] = json.loads(printed)
    whole = rows["all"]
    assert whole["complete"] and whole["unfolded"] is None
    expected = [p["answer"] for p in whole["properties"]]
    assert expected == ["no", "yes", "yes", "no", "no"]
    for name in ("limit", "none"):
        told = rows[name]["unfolded"]
        assert (told["states"], told["arcs"]) == (whole["nodes"], whole["arcs"])
        assert told["has_dead_markings"] and told["dead_transitions"] == ["Top'Never 1"]
        assert told["upper_bounds"] == {place_name(b): b["upper"] for b in whole["bounds"]}
        answers = [p["answer"] for p in rows[name]["properties"]]
        assert answers == [*expected[:4], "inconclusive"]
        assert "cannot be asked: it counts steps" in rows[name]["properties"][4]["why"]
        shown = rows[name]["properties"][0]["evidence"]
        assert shown["confirmed"] and Path(shown["trace"]).is_file()
        assert rows[name]["properties"][1]["rests_on"] == "unfolded"
    assert not rows["none"]["complete"] and rows["none"]["dead_markings"] is None


def place_name(bound: dict[str, object]) -> str:
    return f"{bound['page']}.{bound['name']}"


def test_without_properties_all_markings_are_enough(table: Path, tmp_path: Path) -> None:
    code, printed = verify(table, "--unfold", "-o", tmp_path)
    assert code == 0
    assert "PARTIAL" not in printed
    assert "Dead markings        there are some, by " in printed
    assert "Verdict: COMPLETE. All reachable markings are known" in printed
    code, printed = verify(table, "--unfold", "--full", "-o", tmp_path)
    assert "Status: Partial" not in printed and "All markings:" in printed


def test_one_marking_that_was_asked_for_is_explored(table: Path, tmp_path: Path) -> None:
    code, printed = verify(table, "--max-states", 1, "--json", "-o", tmp_path)
    said = json.loads(printed)
    assert (code, said["why"], said["nodes"]) == (0, "states", 1)
    assert said["dead_markings"] == 0 and said["bounds"][0]["upper"] == 9


def test_never(table: Path, tmp_path: Path) -> None:
    code, printed = verify(table, "--max-states", 20, "--no-unfold", "--json", "-o", tmp_path)
    assert (code, json.loads(printed)["unfolded"]) == (3, None)


def test_a_net_that_cannot_be_asked(tmp_path: Path) -> None:
    text = """
        net Timed
          standard
          colset T = int timed;
          var n : T;
          place P : T = 1`0
          trans Grow
            in P : n
            out P : n + 1 @+ 1
    """
    net = netbuilder.write(text, tmp_path / "timed.cpn")
    for limit in ((), ("--max-seconds", 600)):  # of time, a part is kept only where it can be asked
        code, printed = verify(net, "--max-states", 20, *limit, "-o", tmp_path, "--unbounded-ok")
        assert code == 3
        assert "Unfolded net         it cannot be asked instead: place `Top.P` is timed" in printed
    code, printed = verify(net, "--unfold", "-o", tmp_path, "--property", "bound P <= 1")
    assert code == 3
    assert "PARTIAL: nothing was explored, and the unfolded net cannot be asked." in printed
    assert "?  property 1: not known: nothing was explored, and the unfolded net" in printed
    assert "limit" not in printed


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--unfold", "--max-states", "10"], "it explores no marking"),
        (["--unfold", "--reduce", "symmetry"], "it explores no marking"),
        (["--unfold", "--swarm", "2"], "it explores no marking"),
    ],
)
def test_what_does_not_go_together(options: list[str], says: str, table: Path) -> None:
    result = CliRunner().invoke(app, ["verify", str(table), *options])
    assert result.exit_code == 2
    assert says in " ".join(result.stderr.split())


def test_what_was_seen_must_agree() -> None:
    bounds = (Bounds(0, 3, None, None),)
    sizes = (7, 9, 0, 0.0, 0.0, 0.0, 0.0, 1)
    found = Exploration(
        False, "states", None, *sizes, (2,), bounds, 1, (), None, (), None, ()
    )  # fmt: skip
    good = Unfolded(whole=Whole(7, 9, ()), has_dead=True, bounds={0: 3})
    assert contradiction(found, good) == ""
    for wrong, says in (
        (replace(good, whole=Whole(6, 9, ())), "7 were seen"),
        (replace(good, has_dead=False), "no dead marking"),
        (replace(good, never=(0,)), "never occurs"),
        (replace(good, bounds={0: 2}), "fewer tokens"),
    ):
        assert says in contradiction(found, wrong)


def test_it_can_be_interrupted(table: Path) -> None:
    """What is known by then is said, and nobody waits for the rest."""
    opened = read(table, {"n": "60"}, Diagnostics())
    assert opened is not None
    bounds = (Bounds(0, 60, None, None),) * 4
    sizes = (7, 9, 0, 0.0, 0.0, 0.0, 0.0, 1)
    found = Exploration(
        False, "states", None, *sizes, (1, 0, 0, 0), bounds, 0, (), None, (), None, ()
    )  # fmt: skip
    told = look(opened, Asked(), found, Limits(), ExploreOptions(interrupted=lambda: True)).unfolded
    assert told is not None and told.is_asked and told.places == 240
    assert not told.is_whole


def test_a_colour_outside_its_colour_set(tmp_path: Path) -> None:
    """That a token becomes one is seen when the net is unfolded; then nothing is said of it."""
    text = """
        net Outside
          standard
          colset N = int with 0..50;
          var n : N;
          place P : N = 1`0
          place Q : UNIT = 9`()
          trans Up
            in P : n
            out P : n + 1
          trans Other
            in Q : ()
    """
    net = netbuilder.write(text, tmp_path / "outside.cpn")
    code, printed = verify(net, "--max-states", 20, "-o", tmp_path)
    assert code == 3
    assert "it cannot be asked instead: `Outside.Up[n=50]`" in printed or "raise" in printed
