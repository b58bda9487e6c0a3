"""Where PyBullet is not installed, what needs it says so at once and how to get it, and nothing else is hindered."""

from __future__ import annotations

import importlib.util
import json
import shutil
from importlib.machinery import ModuleSpec
from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app

INSTALL = "pip install 'pn2code[cell]'"


@pytest.fixture
def cell(root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cell, and a Python without PyBullet."""
    found = importlib.util.find_spec

    def without(name: str, package: str | None = None) -> ModuleSpec | None:
        return None if name == "pybullet" else found(name, package)

    monkeypatch.setattr(importlib.util, "find_spec", without)
    monkeypatch.chdir(tmp_path)
    shutil.copytree(root / "examples" / "minimal", tmp_path / "minimal")
    return tmp_path / "minimal"


def test_the_geometry_is_not_known_instead_of_wrong(cell: Path) -> None:
    done = CliRunner().invoke(app, ["check", str(cell), "--geometry"])
    assert done.exit_code == 2
    assert INSTALL in done.stderr


@pytest.mark.parametrize("more", [[], ["--cycles", "2"]])
def test_a_run_says_it_before_anything_is_built(
    more: list[str], cell: Path, tmp_path: Path
) -> None:
    done = CliRunner().invoke(app, ["run", str(cell), "-o", "results", *more])
    assert done.exit_code == 2
    assert INSTALL in done.stderr
    assert "--backend fake" in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["minimal"]


@pytest.mark.cc
def test_a_run_without_distances_needs_none(cell: Path, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["run", str(cell), "--backend", "fake", "-o", "results"])
    assert done.exit_code == 0, done.output
    assert json.loads((tmp_path / "results" / "summary.json").read_text())["verdict"] == "finished"
