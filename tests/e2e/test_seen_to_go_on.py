"""`structure` and `contest` show a terminal that they go on."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.shown import PAIR, opened
from pn2code.base import ticking
from pn2code.cli import contest
from pn2code.structure import analyse
from pn2code.structure.analysis import STAGES


class Terminal(io.StringIO):
    """What a terminal is told."""

    def isatty(self) -> bool:
        return True


class Asked:
    """Stands for the questions of a contest."""

    examination = "ReachabilityFireability"

    class deadline:  # noqa: N801
        left = 42.0

    unknown: dict[str, str] | None = {"one": "", "two": ""}


def test_structure_says_what_it_computes(tmp_path: Path) -> None:
    _, flat = opened(netbuilder.write(PAIR, tmp_path / "net.cpn"))
    said: list[str] = []
    analyse(flat, stage=said.append)
    assert said == [f"{name} ({k} of {len(STAGES)})" for k, name in enumerate(STAGES, start=1)]


def test_a_contest_says_how_many_answers_there_are(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr(ticking.Ticking.__init__, "__defaults__", (0.001,))
    asking: Any = Asked()

    def lines() -> Iterator[str]:
        yield "FORMULA one TRUE"
        del asking.unknown["one"]
        while "1 answered" not in terminal.getvalue():
            pass
        yield "FORMULA two FALSE"

    contest._print(lines(), asking)
    assert capsys.readouterr().out == "FORMULA one TRUE\nFORMULA two FALSE\n"
    told = terminal.getvalue()
    assert "ReachabilityFireability: 0 s   1 answered, 60/min   1 open   42 s left at most" in told
    assert told.endswith("\r\x1b[K")
