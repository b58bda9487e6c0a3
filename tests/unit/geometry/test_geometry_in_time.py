"""What `check --geometry` has found to be wrong is told when its time is up; of all else nothing is known."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.meeting_cell import meeting_cell
from pn2code.base.deadline import CommandIsOverError
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.geometry import check, look
from pn2code.geometry.answers import Layout, Pair
from pn2code.geometry.apart import Apart
from pn2code.geometry.compare import Comparison
from pn2code.geometry.graph import CellGraph, explore_cell
from pn2code.verdict.opened import read
from pn2code.verdict.programs import partition_of
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.bullet]


@pytest.fixture(scope="module")
def graph(tmp_path_factory: pytest.TempPathFactory) -> CellGraph:
    """Of the cell below, wherever its arms stand."""
    d = Diagnostics()
    opened = read(meeting_cell(tmp_path_factory.mktemp("cell"), guarded=False), {}, d)
    assert opened is not None
    partition = partition_of(opened, opened.config, d)
    found = explore_cell(partition, opened.storage, Limits(), d, opened.initial)
    assert found is not None
    return found


@pytest.fixture
def cell(tmp_path: Path, graph: CellGraph, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(check, "explore_cell", lambda *_args, **_named: graph)
    return meeting_cell(tmp_path / "cell", guarded=False)


def changed(cell: Path, old: str, new: str) -> None:
    toml = (cell / "cell.toml").read_text()
    assert old in toml
    (cell / "cell.toml").write_text(toml.replace(old, new))


def answered(cell: Path) -> tuple[int, dict[str, Any], str]:
    """With time that is never up by itself."""
    told = ["check", "--geometry", str(cell), "-o", str(cell.parent / "runs"), "--json"]
    out = CliRunner().invoke(app, [*told, "--max-seconds", "9999", "--jobs", "1"])
    return out.exit_code, json.loads(out.stdout) if out.stdout else {}, out.stderr


def late(*_rest: object) -> None:
    raise CommandIsOverError


@pytest.mark.parametrize("when", ["sweeping pairs", "proposing"])
def test_two_arms_that_touch(when: str, cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The warning was all there was, with exit code 3, whatever had been found."""
    clear = Apart("clear", 1.0, 1.0)
    monkeypatch.setattr(Comparison, "around", lambda *_: (clear, clear))  # of no concern here
    if when == "proposing":
        monkeypatch.setattr(look.Zones, "proposals", late)
    else:
        own = look.Look._pair

        def first(self: look.Look, *given: object) -> bool:
            touches = own(self, *given)  # type: ignore[arg-type]
            if touches:
                raise CommandIsOverError
            return touches

        monkeypatch.setattr(look.Look, "_pair", first)
    code, answer, warned = answered(cell)
    assert code == 1 and "time-over" in warned and "is told; of all else nothing" in warned
    assert answer["answer"] == "no"
    (layout,) = answer["layouts"]
    assert layout["pairs_answer"] == "no"
    assert layout["moves_answer"] == ("yes" if when == "proposing" else "unknown")
    assert (layout["open"] or "").startswith("the time was up" if when != "proposing" else "")
    pair = layout["pairs"][0]
    assert pair["transitions"] == ["Top.Robot1.Visit1", "Top.Robot2.Visit2"]
    assert Path(pair["run"]["trace"]).is_file()


def test_a_move_that_cannot_be_planned(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    changed(cell, "base = { x = 0.0,", "base = { x = -9.0,")
    monkeypatch.setattr(Comparison, "around", late)
    code, answer, _ = answered(cell)
    assert code == 1
    (layout,) = answer["layouts"]
    assert layout["moves_answer"] == "no" and layout["pairs_answer"] == "unknown"
    assert [(m["transition"], m["answer"]) for m in layout["moves"]] == [
        ("Top.Robot1.Visit1", "no")
    ]
    assert layout["moves"][0]["run"]["steps"] > 0


def test_where_nothing_is_wrong_nothing_is_said(
    cell: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Comparison, "around", late)
    code, answer, warned = answered(cell)
    assert (code, answer) == (3, {}) and "what was done answers nothing" in warned
    assert not (cell.parent / "runs").exists()


def test_a_layout_that_nobody_has_looked_at(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    changed(cell, "[motion]", "[layouts.first]\n[layouts.second]\n[layouts.third]\n[motion]")
    layout = Layout(
        "first", 1, 1, (), (Pair(("a", "b"), ("A", "B"), ("", ""), "no", ""),), 1, 1, 0.0
    )

    def answer(self: check.Look) -> Layout:
        if self.layout != "first":
            raise CommandIsOverError
        return layout

    monkeypatch.setattr(check.Look, "answer", answer)
    code, found, _ = answered(cell)
    assert code == 1
    assert [(x["layout"], x["answer"]) for x in found["layouts"]] == [
        ("first", "no"), ("second", "unknown"), ("third", "unknown"),
    ]  # fmt: skip
