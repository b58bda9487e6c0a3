"""Answers of commands as a report gives them: nothing that is not known becomes a yes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from pn2code.dossier.findings import NO, NOTED, OPEN, YES, read, worst
from pn2code.dossier.page import Facts, index
from pn2code.dossier.steps import GEOMETRY, Done, Step

PROPERTY = {"name": "p", "says": "", "holds": "deadlock free", "expect": True, "why": None}
NET = {"complete": True, "nodes": 3, "arcs": 2, "why": "complete"}


def chapter(tmp_path: Path, verb: str, said: dict[str, Any] | None, code: int | None = 0) -> Any:
    if said is not None:
        (tmp_path / "x.json").write_text(json.dumps(said))
    return read(Done(Step("x", verb, (), "x.json"), code, why="y"), tmp_path)


@pytest.mark.parametrize(
    ("answer", "expect", "code", "found"),
    [
        ("yes", True, 0, YES),
        ("no", True, 1, NO),
        ("no", False, 0, YES),
        ("yes", False, 1, NO),
        ("inconclusive", True, 3, OPEN),
        ("unknown", False, 3, OPEN),
    ],
)
def test_properties(answer: str, expect: bool, code: int, found: str, tmp_path: Path) -> None:
    row = {**PROPERTY, "answer": answer, "expect": expect}
    c = chapter(tmp_path, "verify", {**NET, "properties": [row]}, code)
    assert (c.answer, c.findings[0].answer) == (found, found)


def test_checks_have_the_titles_of_the_screen(tmp_path: Path) -> None:
    row = {"answer": "yes", "says": "", "value": 1}
    said = {
        **NET,
        "controller": [{**row, "check": "finite-response"}],
        "medium": [{**row, "check": "the cell with its medium"}],
    }
    about = [f.about for f in chapter(tmp_path, "verify", said).findings]
    assert about == ["Finite response (finite-response)", "The cell with its medium"]


@pytest.mark.parametrize(
    ("code", "found"), [(0, YES), (1, NO), (2, OPEN), (3, OPEN), (70, OPEN), (None, OPEN)]
)
def test_an_exit_code_is_enough_to_doubt(code: int | None, found: str, tmp_path: Path) -> None:
    assert chapter(tmp_path, "verify", {**NET, "properties": []}, code).answer == found
    assert chapter(tmp_path, "generate", None, code).answer == found
    (tmp_path / "x.json").write_text("")
    assert chapter(tmp_path, "verify", None, code).answer == found


def test_a_comparison_that_was_not_made_to_the_end_is_no_yes(tmp_path: Path) -> None:
    core = {"deviation": None, "nodes": 1, "arcs": 0, "complete": True, "walks": 0}
    robot = {"robot": "r", "deviation": None, "states": 5, "complete": False}
    said = {"files": {"files": 3}, "core": core, "supervisor": None, "robots": [robot]}
    c = chapter(tmp_path, "conform", said)
    assert [f.answer for f in c.findings] == [YES, YES, OPEN] and c.answer == OPEN
    assert (
        chapter(tmp_path, "conform", {**said, "core": {**core, "complete": False, "walks": 9}})
        .findings[1]
        .answer
        == OPEN
    )
    said["files"] = {"files": 3, "foreign": ["evil.c"]}
    assert chapter(tmp_path, "conform", said).findings[0].answer == NO


def test_a_run_with_figures_and_warnings(tmp_path: Path) -> None:
    (tmp_path / "x").mkdir()
    said = {
        "verdict": "finished",
        "reason": "",
        "final": ["Cell.Supervisor.Failed"],
        "cycle_seconds": 7.0,
        "clearances": {
            "robots": {"m": 0.0123, "t": 1.5},
            "scene.r": {"m": 0.0045, "t": 1.0, "between": ["r/link_4", "post"]},
        },
        "conditioning": {"r": {"worst": 102.1, "t": 2.0}, "s": {"worst": 8.6e18, "t": 3.0}},
        "warnings": [{"t": 2.0, "robot": "r", "text": "comes close to a singularity"}],
    }
    (tmp_path / "x/summary.json").write_text(json.dumps(said))
    c = chapter(tmp_path, "run", None)
    assert c.answer == YES
    assert [(f.answer, f.says) for f in c.findings] == [
        (YES, "finished in Cell.Supervisor.Failed"),
        (NOTED, "12.3 mm at 1.50 s"),
        (NOTED, "4.5 mm at 1.00 s, `r/link_4` and `post`"),
        (NOTED, "102.1 at 2.00 s"),
        (NOTED, "above 1,000,000 at 3.00 s"),
        (NOTED, "r comes close to a singularity"),
    ]
    failed = {**said, "failed": said["final"]}
    (tmp_path / "x/summary.json").write_text(json.dumps(failed))
    c = chapter(tmp_path, "run", None)
    assert (c.answer, c.findings[0].says) == (NO, "finished in Cell.Supervisor.Failed")
    assert c.findings[0].about == "end of the run"
    (tmp_path / "x/summary.json").write_text(json.dumps({**said, "verdict": "stopped"}))
    assert chapter(tmp_path, "run", None, 1).answer == NO


def test_worst() -> None:
    assert [worst(x) for x in ([], [YES], [YES, OPEN], [OPEN, NO, YES])] == [OPEN, YES, OPEN, NO]


MOVE = {
    "robot": "r", "transition": "Cell.R.Go", "command": "joint", "answer": "yes", "problem": "", "limit_deg": 40.0,
    "axis": 3, "condition": 5.0, "singular": False, "clearance_m": 0.09, "own_clearance_m": None,
    "nearest": ["r/tool", "table"],
}  # fmt: skip
PAIR = {
    "robots": ["r", "s"], "doing": ["r: <joint>", "s: linear"], "answer": "no", "says": "", "links": ["r/a", "s/b"],
    "distance_m": -0.0021, "run": {"trace": "geometry/touch.trace.jsonl"},
}  # fmt: skip
LAYOUT = {
    "layout": "good", "devices": [], "pairs_says": "no two arms collide",
    "moves_answer": "yes", "pairs_answer": "yes", "open": None, "states": 1234, "pairs_compared": 20,
    "distances_measured": 5000, "nearest": {"links": None, "distance_m": None, "at_least_m": 0.021},
    "moves": [MOVE], "pairs": [],
}  # fmt: skip


def geometry(tmp_path: Path, code: int, *layouts: dict[str, Any], why: str | None = None) -> Any:
    (tmp_path / "x.json").write_text(json.dumps({"layouts": layouts, "why": why}))
    return read(Done(Step("x", "check", ("--geometry",), "x.json"), code), tmp_path)


def test_moves_with_their_margins_the_worst_first(tmp_path: Path) -> None:
    near = {**MOVE, "transition": "Cell.R.Near", "clearance_m": 0.004}
    through = {**MOVE, "transition": "Cell.R.Through", "condition": None, "singular": True}
    cannot = {**MOVE, "transition": "Cell.R.Far", "answer": "no", "problem": "is out of reach"}
    layout = {**LAYOUT, "moves_answer": "no", "moves": [MOVE, near, cannot, through]}
    c = geometry(tmp_path, 1, layout)
    assert (c.answer, [f.answer for f in c.findings]) == (NO, [NO, YES])
    assert "1,234 states" in c.says and "at least 21 mm" in c.findings[1].says
    (table,) = c.tables
    assert [row[1] for row in table.rows] == [
        "Cell.R.Far",
        "Cell.R.Through",
        "Cell.R.Near",
        "Cell.R.Go",
    ]
    assert table.rows[0][3] == "no: is out of reach" and table.rows[1][5] == "singular"
    assert list(table.rows[2][4:]) == ["40.0 deg (A3)", "5.0", "4.0 mm", "-", "r/tool and table"]


def test_pairs_that_do_not_keep_apart(tmp_path: Path) -> None:
    unsure = {**PAIR, "answer": "unknown", "links": None, "says": "too close to tell", "run": None}
    c = geometry(tmp_path, 1, {**LAYOUT, "pairs_answer": "no", "pairs": [PAIR, unsure]})
    assert c.answer == NO
    rows = [list(row) for row in c.tables[1].rows]
    assert rows[0][2:] == ["no", "-2.1 mm", "r/a and s/b", "geometry/touch.trace.jsonl"]
    assert rows[1][2:] == ["not known", "-2.1 mm", "too close to tell", "-"]


def test_devices_that_move_are_no_arms(tmp_path: Path) -> None:
    said = geometry(
        tmp_path, 0, {**LAYOUT, "devices": ["mill"], "pairs_says": "no two arms or devices collide"}
    )
    assert [f.about for f in said.findings] == [
        "layout good: moves",
        "layout good: arms and devices keep apart",
    ]
    assert said.findings[1].says.startswith("No two arms or devices collide: 20 pairs of moves")
    assert said.tables[0].head[0] == "Robot or device"


def test_a_geometry_that_is_not_known(tmp_path: Path) -> None:
    assert geometry(tmp_path, 3, why="too many states").answer == OPEN
    assert geometry(tmp_path, 3, {**LAYOUT, "pairs_answer": "unknown"}).answer == OPEN
    where = {"transitions": ["A.Put", "B.Turn"], "says": "`a` creates `box.1` there", "do": "wait"}
    at = geometry(tmp_path, 3, {**LAYOUT, "pairs_answer": "unknown", "open_at": [where]})
    assert at.findings[-1].says == "`a` creates `box.1` there; wait"
    assert at.findings[-1].answer == OPEN and "A.Put and B.Turn" in at.findings[-1].about
    stopped = {**LAYOUT, "pairs_answer": "unknown", "pairs_open": "as far as runs get"}
    said = geometry(tmp_path, 1, {**stopped, "moves_answer": "no", "nearest": None})
    assert said.findings[1].answer == OPEN and "; as far as runs get" in said.findings[1].says


def test_seconds_are_told_where_they_were_measured(tmp_path: Path) -> None:
    row = {**PROPERTY, "holds": "every fires(A) is followed by fires(B) within 60 seconds"}
    timed = {**row, "answer": "yes", "value": 41.5}
    ending = {"final": ["Top.Sup.Finished"], "least_s": 10.0, "most_s": 12.5}
    cycle = {"why": None, "repeats": [], "late": [], "endings": [ending]}
    layouts = [{"layout": "close", "cycle": cycle}]
    said = {**NET, "properties": [timed], "durations": {"why": None, "layouts": layouts}}
    c = chapter(tmp_path, "verify", said)
    assert [f.says for f in c.findings] == [
        "every fires(A) is followed by fires(B) within 60 seconds: 41.5 s at most",
        "best 10 s, worst 12.5 s",
    ]
    assert (c.findings[1].about, c.answer) == ("layout close: cycle to Finished", YES)
    ending["most_s"] = None  # type: ignore[assignment]
    cycle["repeats"] = ["Top.Sup.Again"]
    c = chapter(tmp_path, "verify", said)
    assert c.findings[1].says == "best 10 s, worst no upper bound"
    none = {**NET, "properties": [], "durations": {"why": "the net is timed", "layouts": []}}
    assert chapter(tmp_path, "verify", none).answer == OPEN


@pytest.mark.parametrize(
    ("code", "claimed"), [(0, True), (1, True), (None, False)], ids=["looked at", "no", "left out"]
)
def test_moves_of_arms_are_claimed_where_they_were_looked_at(
    code: int | None, claimed: bool, tmp_path: Path
) -> None:
    """Nothing is said of arms where there are none, nor where `check` has stopped the report before it."""
    facts = Facts("cell", "today", (), (), (), (), {}, {}, ())
    check = chapter(tmp_path, "check", None)
    swept = read(Done(Step("Geometry", "check", (GEOMETRY,), "x.json"), code, why="y"), tmp_path)
    words = "and about the moves of its arms"
    assert (words in index([check, swept], facts)) is claimed
    alone = index([check], facts)
    assert words not in alone and "has made of the net of cell and about their model;" in alone
