"""`generate --check`: files that nobody generated, and that `make` would take, are told."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pn2code.cli.main import app


@pytest.mark.parametrize("name", ["GNUmakefile", "runtime/more.c", "stdint.h"])
def test_what_make_would_take(name: str, root: Path, tmp_path: Path) -> None:
    net = root / "examples" / "philosophers" / "philosophers.cpn"
    folder = tmp_path / "programs"
    options = ["generate", str(net), "-o", str(folder)]
    assert CliRunner().invoke(app, options).exit_code == 0
    (folder / "notes.txt").write_text("mine", encoding="utf-8")
    assert CliRunner().invoke(app, [*options, "--check"]).exit_code == 0
    (folder / name).write_text("", encoding="utf-8")
    done = CliRunner().invoke(app, [*options, "--check"])
    assert done.exit_code == 1
    assert f"  {name} is not generated" in done.output
