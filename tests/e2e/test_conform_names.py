"""Names that are others in the tables of an edited net.c: what is told with them is a difference, and no failure."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from e2e.test_input_sizes import STOCK
from e2e.test_input_sizes import cell as stock
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = (
    STOCK.replace("  var k", "  colset SIDE = with left | right;\n  var k", 1)
    .replace("    place Armed\n", "    place Armed\n    place Side : SIDE = 1`left\n", 1)
    .replace(
        "      out flag : 1\n",
        "      out flag : 1\n      in Side : left\n      out Side : right\n",
        1,
    )
)


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


@pytest.mark.parametrize(
    ("old", "new"),
    [('"right" }', '"Right" }'), ('"Top.Supervisor.Side"', '"Top.Supervisor.Sides"')],
)
def test_names_of_values_and_places(old: str, new: str, tmp_path: Path) -> None:
    cell = stock(tmp_path / "cell", "1\n", NET)
    assert run("generate", cell, "-o", tmp_path / "made").exit_code == 0
    program = tmp_path / "made" / "net.c"
    text = program.read_text(encoding="utf-8")
    assert old in text
    program.write_text(text.replace(old, new), encoding="utf-8")
    done = run("conform", cell, "--generated", tmp_path / "made")
    assert done.exit_code == 1, done.output
    assert "place `Top.Supervisor.Side`" in done.output or "Sides" in done.output
