"""`pn2code init`: what a new cell contains, and what becomes of a folder that cannot take it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.solvers import solver_for
from pn2code.cell.load import load
from pn2code.cell_file import json_schema
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics, render
from pn2code.new_cell import writing
from pn2code.new_cell.catalogue import templates
from pn2code.robot import scene

TEMPLATES = [t.name for t in templates()]


def pn2code(*words: object) -> tuple[int, str, str]:
    done = CliRunner().invoke(app, [*map(str, words)])
    return done.exit_code, done.stdout, done.stderr


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_new_cell_has_all_of_its_files(name: str, tmp_path: Path) -> None:
    solver_for(name)
    folder = tmp_path / "cells" / "press"
    code, said, _ = pn2code("init", folder, "--template", name)
    assert code == 0
    d = Diagnostics()
    config = load(folder, d)
    assert config is not None and not d.items, render.report(d)
    files = {p.name for p in folder.iterdir()}
    named = {
        config.net_file,
        *(i.file for i in config.inputs),
        *(s.file for s in config.sensors if s.file and s.default is None),
    }
    assert named | {"cell.toml", "cell.schema.json", "README.md"} <= files
    assert scene.load(config.geometry, folder, config.locator.origin, d, partial=True) is not None
    assert (folder / "cell.toml").read_text().startswith("#:schema ./cell.schema.json\n")
    assert (folder / "cell.schema.json").read_text() == json_schema.text()
    readme = (folder / "README.md").read_text()
    assert readme.startswith("# press\n")
    # It says of each file what it is, and each program is in it.
    assert all(f"| `{name}` | " in readme for name in files - {"README.md"})
    assert all(f"`{p.name}`" in readme and p.instance in readme for p in config.programs)
    assert all(f"wrote {folder / name}\n" in said for name in files)


def test_without_a_template_it_is_the_first(tmp_path: Path) -> None:
    assert pn2code("init", tmp_path)[0] == 0
    assert "`minimal`" in (tmp_path / "README.md").read_text()


def test_the_list() -> None:
    code, said, _ = pn2code("init", "--list")
    assert code == 0
    assert [line.split()[0] for line in said.splitlines()] == TEMPLATES


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("init", "--list", "DIR"), "it makes no folder"),
        (("init",), "give the folder to make"),
        (("init", "DIR", "--template", "rivetting"), "did you mean `riveting`?"),
    ],
)
def test_wrong_usage(words: tuple[str, ...], message: str, tmp_path: Path) -> None:
    code, _, said = pn2code(*(tmp_path / "new" if w == "DIR" else w for w in words))
    assert code == 2
    assert message in " ".join(said.replace("│", "").split())
    assert [*tmp_path.iterdir()] == []


def test_a_folder_that_is_not_empty(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    code, _, said = pn2code("init", tmp_path)
    assert code == 2
    assert "the folder is not empty: `mine.txt` is in it" in said
    assert [p.name for p in tmp_path.iterdir()] == ["mine.txt"]


def test_a_file_in_its_place(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    for folder in (tmp_path / "mine", tmp_path / "mine" / "cell"):
        code, _, said = pn2code("init", folder)
        assert (code, "is not a folder" in said) == (2, True)
    assert (tmp_path / "mine").read_text() == "mine"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_must_not_be_written(tmp_path: Path) -> None:
    (tmp_path / "locked").mkdir(mode=0o500)
    code, _, said = pn2code("init", tmp_path / "locked" / "cell")
    assert (code, "permission denied" in said) == (2, True)


@pytest.mark.parametrize("is_there", [True, False])
def test_nothing_is_left_of_a_cell_that_cannot_be_written(is_there: bool, tmp_path: Path) -> None:
    folder = tmp_path / "above" / "cell"
    if is_there:
        folder.mkdir(parents=True)
    with pytest.raises(OSError):
        writing.write(folder, {"a.txt": b"a", "b" * 300: b"a name that no file system takes"})
    assert [*tmp_path.rglob("*")] == ([folder.parent, folder] if is_there else [])
