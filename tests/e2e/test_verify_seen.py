"""What an answer rests on: markings without the graph, approximations, bounds that are cut. No clock is asked."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from helpers.explored import Explorers, wide
from helpers.netbuilder import flat, write
from helpers.processes import pn2code
from helpers.questions import Asked, ask
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.result_rows import row
from pn2code.verify.report.text import report
from pn2code.verify.report.webpage import webpage

pytestmark = pytest.mark.cc

NET = """
    net Steps
      colset N = int;
      colset S = int with 0..5;
      val last = 5;
      var n : N;
      var s : S;
      place P : N = 1`0
      place Q : S = 1`0
      trans Up guard [n < last]
        in P : n
        out P : n + 1
      trans Side guard [s < 5]
        in Q : s
        out Q : s + 1
      trans Never guard [n < 0]
        in P : n
        out P : n
"""
NODES, ARCS = 36, 60
CONDITIONS = ("hd P <= 5", "hd P <= 4", "hd Q <= 5")
LINES = (
    "pred 0", "pred 1", "dead", "ef 2",
    "? invariant 0", "? invariant 1", "? bound 0 1 1", "? initially 3",
)  # fmt: skip
ALL, NO_ARCS, NO_COMPONENTS, NOTHING = (
    {"markings": m, "arcs": a, "components": c}
    for m, a, c in ((True, True, True), (True, False, False), (True, True, False), (False,) * 3)
)


@pytest.fixture(scope="module")
def steps(explorers: Explorers) -> Asked:
    return ask(explorers, NET, CONDITIONS, "seen")


@pytest.mark.parametrize(
    ("phase", "seen", "initially"),
    [
        ("explore", NOTHING, "unknown"),
        ("graph", NO_ARCS, "unknown"),
        ("components", NO_COMPONENTS, "unknown"),
        ("questions", ALL, "unknown"),
    ],
)
def test_the_time_ends_in_a_phase(
    steps: Asked, phase: str, seen: dict[str, bool], initially: str
) -> None:
    """What the markings alone decide is answered once all of them were seen, whatever was not done after that."""
    found, answers = steps.say(LINES, "--ends-in", phase)
    said = found.report
    assert (found.code, said["complete"], said["why"]) == (3, False, "seconds")
    assert said["seen"] == seen
    always, not_always, bound, one_day = answers
    assert one_day["answer"] == initially
    if seen["markings"]:
        assert said["nodes"] == NODES
        assert [a["answer"] for a in (always, not_always, bound)] == ["yes", "no", "yes"]
        assert bound["value"] == 1
        assert [a["why"] for a in (always, not_always, bound)] == [None] * 3
    else:
        assert {a["answer"] for a in answers} <= {"unknown"}
        assert {a["why"] for a in answers} == {"seconds"}


@pytest.mark.parametrize(
    ("phase", "seen"),
    [("graph", NO_ARCS), ("components", NO_ARCS), ("properties", NO_ARCS), ("questions", ALL)],
)
def test_no_time_is_left_in_a_phase(steps: Asked, phase: str, seen: dict[str, bool]) -> None:
    """A part of the work that does not end when its time is over takes nothing with it of what was known before."""
    whole, _ = steps.say(LINES)
    found, answers = steps.say(LINES, "--late-in", phase)
    said = found.report
    assert (found.code, said["complete"], said["why"], said["seen"]) == (3, False, "seconds", seen)
    for known in ("nodes", "arcs", "fired", "dead_count", "bounds"):
        assert said[known] == whole.report[known]
    assert [a["answer"] for a in answers] == ["yes", "no", "yes", "unknown"]
    assert [a["why"] for a in answers] == [None, None, None, "seconds"]
    assert answers[2]["value"] == 1
    assert (said["graph"] is not None) == seen["components"]


def test_no_time_is_left_for_the_bounds(steps: Asked) -> None:
    """What was counted is told before the states that were not expanded and the multi-sets are looked at."""
    whole, _ = steps.say(LINES, "--max-states", 20)
    found, _ = steps.say(LINES, "--max-states", 20, "--late-in", "bounds")
    said = found.report
    assert (found.code, said["complete"], said["why"]) == (3, False, "states")
    assert "bounds" in whole.report and "bounds" not in said
    for known in ("nodes", "arcs", "fired", "dead_count", "depth"):
        assert said[known] == whole.report[known]


def test_all_is_seen(steps: Asked) -> None:
    found, answers = steps.say(LINES)
    assert (found.code, found.report["complete"], found.report["seen"]) == (0, True, ALL)
    assert [a["answer"] for a in answers] == ["yes", "no", "yes", "yes"]
    found, _ = steps.say(LINES, "--no-graph")
    assert (found.report["complete"], found.report["seen"]) == (True, NO_ARCS)


@pytest.mark.parametrize("kind", ["hash", "bitstate"])
def test_an_approximation_is_never_complete(steps: Asked, kind: str) -> None:
    """However many markings were seen: whether others were taken for them is not known."""
    found, answers = steps.say(LINES, "--approximate", kind)
    said = found.report
    assert (found.code, said["complete"], said["why"]) == (3, False, "approximation")
    assert said["seen"] == NOTHING
    assert [a["answer"] for a in answers] == ["unknown", "no", "unknown", "unknown"]
    assert {a["why"] for a in answers if a["answer"] == "unknown"} == {"approximation"}


def exploration(net: FlatNet, explorers: Explorers, *options: object) -> Exploration:
    folder = explorers.build(net, wide(Sizes.start(net, {}), 4), "reported")
    return Exploration.of(net, explorers.said(folder, *options).report, 0.0)


def page(net: FlatNet, found: Exploration) -> str:
    return webpage(net, found, {}, datetime(2020, 1, 1, tzinfo=UTC))


def test_a_report_does_not_contradict_itself(explorers: Explorers) -> None:
    """All markings, no graph: what rests on markings is said without reserve, the rest is said to be missing."""
    net = flat(NET)
    found = exploration(net, explorers, "--ends-in", "graph")
    text = " ".join(report(net, found, None).split())
    assert "PARTIAL: the limit of time was reached. All markings were seen" in text
    assert f"Markings: complete: {NODES}." in text
    assert "Arcs: not complete." in text and "Components: not complete." in text
    assert "there may be further dead markings" not in text
    assert "Status: Full" in text
    assert "Dead Transition Instances Top'Never 1" in text
    assert "there may be further dead markings" not in page(net, found)
    assert "No dead marking" not in page(net, found)
    said = row(net, found)
    assert (said["complete"], said["seen"]) == (False, NO_ARCS)
    assert (said["dead_markings"], said["dead_transitions"]) == (1, ["Top'Never 1"])


def test_a_report_of_a_part(explorers: Explorers) -> None:
    net = flat(NET)
    for options in (("--max-states", 3), ("--approximate", "hash"), ("--approximate", "bitstate")):
        found = exploration(net, explorers, *options)
        text = " ".join(report(net, found, None).split())
        assert "Status: Full" not in text
        assert "Dead Transition Instances" not in text
        assert "Transition Instances that were not seen to occur" in text
        assert "there may be further dead markings" in text
        assert "No dead marking" not in page(net, replace(found, dead_count=0))
        assert "None was seen" in report(net, replace(found, dead_count=0), None)


def test_a_command_with_an_approximation(tmp_path: Path) -> None:
    """No answer that rests on absence, and exit code 3; what was found is found."""
    net = write(NET, tmp_path / "steps.cpn")
    asked = ("--property", "bound P <= 1")
    for kind in ("hash", "bitstate"):
        report_to = tmp_path / f"{kind}.html"
        done = pn2code(
            "verify", net, "--approximate", kind, *asked, "--report", report_to, "--json"
        )
        said = json.loads(done.stdout)
        assert (done.returncode, said["complete"], said["why"]) == (3, False, "approximation")
        assert (said["properties"][0]["answer"], said["properties"][0]["rests_on"]) == (
            "inconclusive",
            None,
        )
        assert "Complete:" not in report_to.read_text()
    done = pn2code(
        "verify",
        net,
        "--approximate",
        "hash",
        "--property",
        "never { Mark.Top'P 1 = [3] }",
        "--json",
    )
    said = json.loads(done.stdout)
    assert done.returncode == 1
    assert (said["properties"][0]["answer"], said["properties"][0]["rests_on"]) == ("no", "marking")
    assert done.stderr == ""


def test_what_properties_rest_on(tmp_path: Path) -> None:
    net = write(NET, tmp_path / "steps.cpn")
    texts = {
        "bound P <= 1": ("yes", "markings"),
        "deadlock free": ("no", "run"),
        "reachable { Mark.Top'P 1 = [5] }": ("yes", "run"),
        "ctl AG EF tokens(P) = 1": ("yes", "arcs"),
        "ltl F fires(Never)": ("no", "run"),
        "ltl F { Mark.Top'P 1 = [5] }": ("yes", "arcs"),
    }
    options = [word for text in texts for word in ("--property", text)]
    done = pn2code("verify", net, "--json", "--traces", tmp_path / "traces", *options)
    said = json.loads(done.stdout)["properties"]
    assert [(a["answer"], a["rests_on"]) for a in said] == list(texts.values())
    runs = [a["evidence"] for a in said if a["rests_on"] == "run"]
    assert len(runs) == 3 and all(run["confirmed"] for run in runs)


MANY = """
    net Many
      colset N = int;
      var n : N;
      place P : N = 1`0
      place Seen : N
      trans Up guard [n < 400]
        in P : n
        out P : n + 1
        out Seen : n
"""


def uppers(folder: Path, *options: object) -> tuple[dict[str, Any], dict[str, Any], str]:
    net = write(MANY, folder / "many.cpn")
    text = folder / "report.txt"
    done = pn2code("verify", net, "--json", "--report", text, "--most-traces", "0", *options)
    first, second = json.loads(done.stdout)["bounds"]
    return first, second, text.read_text()


@pytest.mark.parametrize("threads", [1, 2])
def test_long_multisets_are_cut(tmp_path: Path, threads: int) -> None:
    """At a size that is said, and always at the same place."""
    p, seen, text = uppers(tmp_path, "--threads", threads)
    for place, colours in ((p, 401), (seen, 400)):
        values = [line.split("`")[1] for line in place["upper_multiset"].split("++\n")]
        assert values == [str(n) for n in range(200)]
        assert (place["upper_cut"], place["lower_cut"]) == (colours, None)
        assert place["upper"] == (1 if place is p else 400)
    assert "(only 200 of 401 colours are listed; `--full` lists all)" in text
    p, seen, text = uppers(tmp_path, "--threads", threads, "--full")
    assert len(p["upper_multiset"].split("\n")) == 401
    assert (p["upper_cut"], seen["upper_cut"]) == (None, None)
    assert "are listed" not in text
