"""How far `generate` looks is a number of states: a busy machine, or one with other processors, generates the same."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import pytest

from helpers import small_cell
from pn2code import pipeline
from pn2code.diagnostics import Diagnostics, render
from pn2code.verify.controller import control, proofs
from pn2code.verify.exploring import explore, explorer_process

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def test_no_clock_is_looked_at(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    popen = subprocess.Popen

    def noted(command: Any, *rest: Any, **options: Any) -> Any:
        asked.extend(map(str, command))
        return popen(command, *rest, **options)

    small_cell.write(tmp_path)
    monkeypatch.setattr(explorer_process.subprocess, "Popen", noted)
    d = Diagnostics()
    assert pipeline.generate(tmp_path, d) is not None, render.report(d)
    assert "--max-states" in asked
    assert not [option for option in asked if "seconds" in option]


def test_what_more_than_one_thread_has_cut_is_cut_again_by_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else it would be chance which states are the first ones, and what is wrong in them."""
    threads: list[int] = []
    examine = control.examine

    def noted(partition: Any, plan: Any, limits: Any, *rest: Any) -> Any:
        threads.append(limits.threads)
        return examine(partition, plan, limits, *rest)

    small_cell.write(tmp_path)
    monkeypatch.setattr(control, "examine", noted)
    monkeypatch.setattr(proofs, "cores", lambda: 2)
    pipeline.generate(tmp_path, Diagnostics())
    assert threads == [2]
    monkeypatch.setattr(proofs, "MOST_STATES", 5)
    d = Diagnostics()
    pipeline.generate(tmp_path, d)
    assert threads == [2, 2, 1]
    assert "controller-unchecked" in [i.code for i in d.items]


ENDLESS = small_cell.NET.replace(
    "  var n, k", "  fun spin n = if n >= 0 then spin n else n;\n  var n, k"
).replace("guard [n <= 3]", "guard [n <= 3 andalso spin n >= 0]")


def test_an_inscription_that_computes_for_ever_is_no_other_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small_cell.write(tmp_path, ENDLESS)
    monkeypatch.setattr(proofs, "MOST_PROCESSOR_SECONDS", 0.3)
    d = Diagnostics()
    assert pipeline.generate(tmp_path, d) is None
    assert [(i.severity.value, i.code) for i in d.items] == [("error", "controller-beyond")]
    assert "the explorer has computed for" in d.items[0].message


def test_too_little_memory_is_no_other_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small_cell.write(tmp_path)
    monkeypatch.setattr(explore, "default_memory", lambda: 1)
    d = Diagnostics()
    assert pipeline.generate(tmp_path, d) is None
    assert [i.code for i in d.items] == ["controller-beyond"]
    assert "too little memory" in d.items[0].message
