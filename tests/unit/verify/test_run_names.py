"""Each property has a file of its own for its run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app
from pn2code.verify.answers.run_names import run_names


def test_names_that_are_written_alike() -> None:
    assert run_names(["a b", "A-b", "a/b", "..", "dead end"]) == {
        "a b": "a-b",
        "A-b": "A-b-2",
        "a/b": "a-b-2-2",
        "..": "property",
        "dead end": "dead-end",
    }


@pytest.mark.parametrize("name", ["controller-channels", "dead-3", "unbounded", "geometry-1"])
def test_names_of_other_runs(name: str) -> None:
    assert run_names([name]) == {name: f"property-{name}"}


GROWS = """standard
page Top
  place P = 1`()
  place Q
  trans A
    in P
    out P
    out Q
"""
NAME = "the buffer between the two machines may hold at most"


@pytest.mark.cc
def test_bounds_whose_names_begin_alike(tmp_path: Path) -> None:
    """Of a place that grows; the run of the first one was that of the second."""
    net = tmp_path / "net.cpnt"
    net.write_text(GROWS, encoding="utf-8")
    asked = [f'[[property]]\nname = "{NAME} {n}"\nholds = "bound Q <= {n}"\n' for n in (3, 7)]
    (tmp_path / "net.properties.toml").write_text("".join(asked), encoding="utf-8")
    done = CliRunner().invoke(app, ["verify", str(net), "--max-states", "2", "--json"])
    rows = json.loads(done.stdout)["properties"]
    assert [(row["answer"], row["evidence"]["steps"]) for row in rows] == [("no", 4), ("no", 8)]
    assert "property-evidence" not in done.output
