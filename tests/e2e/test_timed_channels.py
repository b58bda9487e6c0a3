"""Time stamps and messages: a channel cannot be timed, an input can."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.small_cell import NET, TOML, write
from pn2code.conform.cell import conform_cell
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate

SCALAR = ("colset CLOCKED = int timed;", "done")
RECORD = (
    "colset CLOCKED = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL timed;",
    "data",
)


def timed(declaration: str, place: str) -> str:
    """The small cell, one of its channels timed."""
    net = NET.replace("  val MOVE", f"  {declaration}\n  val MOVE", 1)
    for port in ("", " port in", " port out"):
        for own in ("INT", "POSE"):
            net = net.replace(f"place {place}{port} : {own}\n", f"place {place}{port} : CLOCKED\n")
    return net


@pytest.mark.parametrize(("declaration", "place"), [SCALAR, RECORD])
def test_a_channel_is_not_timed(declaration: str, place: str, tmp_path: Path) -> None:
    d = Diagnostics()
    assert generate(write(tmp_path, timed(declaration, place)), d) is None
    errors = [i for i in d if i.code == "channel-timed"]
    assert len(errors) == 1
    assert f"`Top.{place}` has the timed colour set `CLOCKED`" in errors[0].message
    assert "without `timed`" in (errors[0].hint or "")


@pytest.mark.cc
def test_an_input_may_be_timed(tmp_path: Path) -> None:
    net = NET.replace("  val MOVE", "  colset CLOCKED = int timed;\n  val MOVE", 1)
    net = net.replace("place Pieces : INT = 1`1", "place Pieces : CLOCKED = 1`1")
    toml = TOML + '[[input]]\nplace = "Pieces"\nfile = "pieces.txt"\n'
    cell = write(tmp_path, net, toml)
    (cell / "pieces.txt").write_text("2\n")
    found = conform_cell(cell, (d := Diagnostics()))
    assert found is not None, [str(i) for i in d]
    assert found.complete and not found.deviates
    assert found.supervisor is not None
    assert (
        found.supervisor.sent == 6
    )  # pieces 2 and 3: two places, two moves, one hole, the way home
