"""What hides the states of a cell is named: the transition, its binding, and the value that is in no colour set."""

from __future__ import annotations

from pathlib import Path

from helpers.small_cell import NET, TOML, write
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.graph import explore_cell
from pn2code.geometry.words import reason
from pn2code.verdict.opened import read
from pn2code.verify.exploring.limits import Limits


def test_what_raises_an_exception_is_named(tmp_path: Path) -> None:
    net = NET.replace("  var n, k: INT;", "  colset UP = int with 1..2;\n  var n, k: INT;", 1)
    net = net.replace("place Pieces : INT", "place Pieces : UP", 1)
    d = Diagnostics()
    opened = read(write(tmp_path, net, TOML), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    graph = explore_cell(partition, opened.storage, Limits(), d)
    assert graph is not None and not graph.arcs
    assert graph.why == "error"
    assert graph.raised.startswith("`Top.Supervisor.Next` with n = 2 gives the illegal colour 3")
    said = reason(graph.why, graph.raised)
    assert f"in a state of the cell: {graph.raised} (`pn2code verify`" in said
    assert reason("error") == "an inscription raises an exception in a state of the cell"
