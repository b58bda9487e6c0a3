"""`structure` and `contest` show a terminal that they go on."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.shown import PAIR, opened
from pn2code.base import how_far
from pn2code.cli import contest, main
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
    monkeypatch.setattr(contest, "SILENCE_S", 0.001)
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


LONG = """
net Long
  colset N = int with 0..9;
  var n : N;
  page Top
    place P0 : N = 1`0
"""


def test_what_takes_long_is_counted_with_a_rate_and_an_estimate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wherever a loop goes over all transitions of a net, or what is made of them."""
    text = LONG
    for i in range(4):
        text += f"    place P{i + 1} : N\n" if i < 3 else ""
        text += f"    trans T{i} guard [n >= 0]\n      in P{i} : n\n      out P{(i + 1) % 4} : n\n"
    net = netbuilder.write(text, tmp_path / "long.cpn")
    monkeypatch.setattr(how_far, "PERIOD_S", 0.0)
    monkeypatch.chdir(tmp_path)
    for words, wanted in (
        (
            ("generate", "-o", "made"),
            ("transitions of page Top", "translating transitions", "writing transitions"),
        ),
        (("structure",), ("what transitions move", "invariants", "siphons or traps")),
    ):
        terminal = Terminal()
        monkeypatch.setattr("sys.stderr", terminal)
        assert not main.app([words[0], str(net), *words[1:]], standalone_mode=False)
        told = terminal.getvalue()
        for what in wanted[:2]:
            assert re.search(rf"{what}: 2 of 4, [\d,.]+ a second, about [\d,]+ s left", told), what
        assert re.search(rf"{wanted[2]}: 2 (of 4|sets of places), [\d,.]+ a second", told)
