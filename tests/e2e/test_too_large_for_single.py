"""A real that is too large for how its place keeps it: the transition does not occur, in the net or in the script."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, TOML, write
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

ARM = 'model = "kr120_r2500"\nbase = { x = 0.0 }\n[storage]\nSHORT = "float32"\n'
CHANGES = (
    ("x = 100.0 * Real.fromInt n, y = 0.5, z = 0.0, rx = 0.0", "x = 1500.0, y = 0.5, z = 1000.0, rx = 180.0"),
    ("  var n, k: INT;", "  colset SHORT = real;\n  var r : SHORT;\n  var n, k: INT;"),
    ("    place Over\n", "    place Over : SHORT\n"),
    ("      out Over : ()", "      out Over : 1.0e30 * 1.0e30 * Real.fromInt k"),
    ("      in Over : ()", "      in Over : r"),
)  # fmt: skip


def test_a_run_that_stops_there_can_be_replayed(tmp_path: Path) -> None:
    net = NET
    for old, new in CHANGES:
        assert old in net
        net = net.replace(old, new)
    cell, out = write(tmp_path / "cell", net, TOML + ARM), tmp_path / "out"
    d = Diagnostics()
    found = run_cell(cell, RunOptions(out, backend="fake", looks=False, checked=False), d)
    assert found is not None, [i.message for i in d]
    assert "is too large for single precision" in found.record.reason
    told = [e["transition"] for e in found.record.events if "transition" in e]
    assert told[-1] == "Top.Robot.Accept"
    result = CliRunner().invoke(app, ["replay", str(out / "cell.trace.jsonl"), str(cell)])
    assert result.exit_code == 0, result.output
