"""A value outside the colour set of its place is an error wherever it comes from, in both engines alike."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import cpn
from pn2code.cli.main import app

NET = """
    net Colours
      colset SMALL = int with 0..2;
      colset INT = int;
      colset PAIR = product SMALL * INT;
      var s: SMALL;
      var n: INT;
      place A : INT = 1`7
      place B : {colset}
      trans T {code}
        in A : n
        out B : {inscription}
"""
CODE = "code input (n); output (s); action n"
WRONG = {
    "a variable of a wider colour set": ("SMALL", "", "n"),
    "an output of a code segment": ("SMALL", CODE, "s"),
    "a part of a tuple": ("PAIR", "", "(n, 1)"),
    "a part of a tuple that is computed": ("PAIR", "", "(n - 10, 1)"),
    "a part of a tuple from a code segment": ("PAIR", CODE, "(s, n)"),
}


@pytest.mark.parametrize("engine", ["compiled", "reference"])
@pytest.mark.parametrize("inscription", ["0`n", "(n - 7)`n"])
def test_no_tokens_of_it_are_fine(inscription: str, engine: str, tmp_path: Path) -> None:
    path = tmp_path / "net.cpn"
    path.write_bytes(cpn(NET.format(colset="SMALL", code="", inscription=inscription)))
    done = CliRunner().invoke(app, ["simulate", str(path), "--engine", engine])
    assert done.exit_code == 0, done.output
    assert "1 step" in done.output


@pytest.mark.parametrize("engine", ["compiled", "reference"])
@pytest.mark.parametrize("what", WRONG)
def test_it_is_refused(what: str, engine: str, tmp_path: Path) -> None:
    colset, code, inscription = WRONG[what]
    path = tmp_path / "net.cpn"
    path.write_bytes(cpn(NET.format(colset=colset, code=code, inscription=inscription)))
    done = CliRunner().invoke(app, ["simulate", str(path), "--engine", engine])
    assert done.exit_code == 1, done.output
    value = {
        "a part of a tuple": "(7,1)", "a part of a tuple that is computed": "((~3),1)",
        "a part of a tuple from a code segment": "(7,7)",
    }.get(what, "7")  # fmt: skip
    assert f"illegal colour {value}: it is not in the colour set `{colset}`" in done.output
    assert "0 steps" in done.output
