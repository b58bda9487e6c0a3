"""docs/cookbook.md: recipes that are cells are verified as they are printed; nets stay the same in other formats."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app
from unit.cell.test_cookbook import RECIPES, Recipe

CELLS = [r for r in RECIPES if r.is_cell]
BOTH_TIMES = "A value that several read"


def written(recipe: Recipe, folder: Path) -> Path:
    recipe.net_in(folder)
    (folder / "cell.toml").write_text(recipe.table(), encoding="utf-8")
    return folder


def test_there_are_cells() -> None:
    assert len(CELLS) >= 8


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
@pytest.mark.parametrize("recipe", CELLS, ids=lambda r: r.title)
def test_the_cell_is_verified(recipe: Recipe, tmp_path: Path) -> None:
    cell = written(recipe, tmp_path)
    ends = " or ".join(f"tokens(Supervisor'{x}) >= 1" for x in recipe.ends)
    asked = ["--property", f"deadlock free except {ends}"]
    if recipe.title == BOTH_TIMES:  # what its text names
        asked += ["--property", "never {Mark.Reader'limit 1 <> Mark.Supervisor'limit 1}"]
    done = CliRunner().invoke(
        app, ["verify", str(cell), "--json", "--threads", "1", "--most-traces", "0", *asked]
    )
    said = json.loads(done.stdout)
    answers = [a["answer"] for a in said["properties"]]
    assert answers == ["yes", "no"][: len(answers)], said["properties"]
    others = {c["check"]: c["answer"] for c in said["controller"]}
    assert set(others.values()) <= {"yes"}, others
    assert {c["answer"] for c in said["medium"]} == {"yes"}, said["medium"]


@pytest.mark.parametrize("recipe", [r for r in RECIPES if r.net], ids=lambda r: r.title)
def test_the_text_is_kept_by_way_of_cpn_tools(recipe: Recipe, tmp_path: Path) -> None:
    text = recipe.net_in(tmp_path)
    for source, target in (("cell.cpnt", "a.cpn"), ("a.cpn", "b.cpnt"), ("b.cpnt", "c.cpn")):
        done = CliRunner().invoke(
            app, ["convert", str(tmp_path / source), "-o", str(tmp_path / target)]
        )
        assert done.exit_code == 0, done.output
    assert text.read_text() and (tmp_path / "b.cpnt").read_text()
    again = CliRunner().invoke(
        app, ["convert", str(tmp_path / "c.cpn"), "-o", str(tmp_path / "d.cpnt")]
    )
    assert again.exit_code == 0
    assert (tmp_path / "d.cpnt").read_text() == (tmp_path / "b.cpnt").read_text()
