"""Verbs that read a net tell on a terminal how long they take, where that is long."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.base.progress_line import Line
from pn2code.cli.main import app

NET = """
net Small
  standard
  page Top
    place A : INT = 1`0
    trans Go
      in A : 0
"""


@pytest.mark.parametrize(
    "words",
    [
        ("check",),
        ("marking",),
        ("structure",),
        ("draw", "-o", "net.svg"),
        ("generate", "-o", "programs"),
    ],
    ids=lambda words: words[0],
)
def test_it_is_told_what_takes_the_time(
    words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []

    monkeypatch.setattr(Line, "turn_to", lambda _, what: told.append(what))
    monkeypatch.chdir(tmp_path)
    write(NET, tmp_path / "net.cpn")
    done = CliRunner().invoke(app, [words[0], "net.cpn", *words[1:]])
    assert done.exit_code == 0, done.output
    assert told[0] in ("reading the net", "checking the net")
    if words[0] == "generate":
        assert told[1:] == [
            "translating the net",
            "proving what the programs rely on",
            "writing the programs",
        ]
