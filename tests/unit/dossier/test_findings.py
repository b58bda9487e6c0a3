"""Answers of commands as a report gives them: nothing that is not known becomes a yes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from pn2code.dossier.findings import NO, NOTED, OPEN, YES, read, worst
from pn2code.dossier.steps import Done, Step

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
        "clearances": {"robots": {"m": 0.0123, "t": 1.5}},
        "conditioning": {"r": {"worst": 102.1, "t": 2.0}},
        "warnings": [{"t": 2.0, "robot": "r", "text": "comes close to a singularity"}],
    }
    (tmp_path / "x/summary.json").write_text(json.dumps(said))
    c = chapter(tmp_path, "run", None)
    assert c.answer == YES
    assert [(f.answer, f.says) for f in c.findings] == [
        (YES, "finished in Cell.Supervisor.Failed"),
        (NOTED, "12.3 mm at 1.50 s"),
        (NOTED, "102.1 at 2.00 s"),
        (NOTED, "r comes close to a singularity"),
    ]
    (tmp_path / "x/summary.json").write_text(json.dumps({**said, "verdict": "stopped"}))
    assert chapter(tmp_path, "run", None, 1).answer == NO


def test_worst() -> None:
    assert [worst(x) for x in ([], [YES], [YES, OPEN], [OPEN, NO, YES])] == [OPEN, YES, OPEN, NO]
