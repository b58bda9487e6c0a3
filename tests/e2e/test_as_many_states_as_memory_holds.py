"""`time` goes on beyond the states that are looked at elsewhere; `check --geometry`: see `test_check_geometry`."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app
from pn2code.geometry import graph

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def test_times_are_known_of_large_cells(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(graph, "MOST_STATES", 5)
    arguments = ["time", str(root / "examples" / "minimal")]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0, done.output
    monkeypatch.setattr(graph, "MOST_HELD", 5)
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 3
    assert "as many as there is memory for" in " ".join(done.output.split())


def test_there_are_no_fewer_and_never_more_than_that(monkeypatch: pytest.MonkeyPatch) -> None:
    for mebibytes, most in ((1, 300_000), (1_000, 512_000), (100_000, 3_000_000)):
        monkeypatch.setattr(graph, "default_memory", lambda m=mebibytes: m)
        assert graph.most_held() == most
