"""Cells with more states than `check --geometry` looks at: a net that does more decides, and never wrongly."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest
from typer.testing import CliRunner

from helpers.machine_cells import machine_cell
from helpers.meeting_cell import NET, meeting_cell
from helpers.netbuilder import cpn
from helpers.thorough import amount
from helpers.two_arm_cells import two_arm_cell
from pn2code.cell.divide import divide
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.activities import Doing
from pn2code.geometry.check import cells_of
from pn2code.geometry.graph import explore_cell, explore_wider
from pn2code.geometry.legs import Planner
from pn2code.geometry.situations import Situations
from pn2code.verdict.opened import read
from pn2code.verify.exploring.limits import Limits

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

TRAY = "    place Free = 1\n"
PACKING = """    place Free = 1
    place Tray = 100
    place Packed
    trans Pack
      in Tray : ()
      out Packed : ()
"""


def packing(folder: Path, *, guarded: bool) -> Path:
    """The cell in which two arms meet, with a tray of 100 parts that go besides."""
    assert TRAY in NET
    return meeting_cell(folder, guarded=guarded, net=NET.replace(TRAY, PACKING))


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Sets how many states are looked at."""

    def set_(most: int) -> None:
        monkeypatch.setattr("pn2code.geometry.graph.MOST_STATES", most)

    return set_


def asked(cell: Path, runs: Path, *more: str) -> tuple[int, str]:
    options = ["check", "--geometry", str(cell), "--traces", str(runs), *more]
    result = CliRunner().invoke(app, options)
    return result.exit_code, result.output


def test_arms_keep_apart_however_many_states_there_are(
    tmp_path: Path, few: Callable[[int], None]
) -> None:
    few(100)
    code, said = asked(packing(tmp_path / "cell", guarded=True), tmp_path / "runs")
    assert code == 0, said
    assert "49 states of a net that does more than the cell" in said
    assert said.count("      yes  ") == 2


def test_what_is_wrong_has_a_run_of_the_cell(tmp_path: Path, few: Callable[[int], None]) -> None:
    few(100)
    cell = packing(tmp_path / "cell", guarded=False)
    code, said = asked(cell, tmp_path / "runs")
    assert code == 1 and "NO: `Top.Robot1.Visit1` and `Top.Robot2.Visit2`" in said, said
    (trace,) = (tmp_path / "runs").iterdir()
    assert CliRunner().invoke(app, ["replay", str(trace), str(cell)]).exit_code == 0


def test_what_only_the_other_net_does_is_not_known(
    tmp_path: Path, few: Callable[[int], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody has seen a run of the cell: it is not said that there is one."""
    few(100)
    monkeypatch.setattr("pn2code.geometry.check.MOST_OF_PART", 2)
    cell = packing(tmp_path / "cell", guarded=False)
    code, said = asked(cell, tmp_path / "runs")
    assert code == 3 and "NO" not in said, said
    assert "no run of the cell was found that leads there" in said
    assert not (tmp_path / "runs").exists()


def test_where_the_other_net_is_too_large_as_well(tmp_path: Path) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=True)
    code, said = asked(cell, tmp_path / "runs", "--max-states", "5")
    assert code == 3 and "or as `--max-states` says" in said, said
    assert "0 of 2 transitions" in said and "      yes  " not in said


def test_what_parts_show_is_told_where_no_other_net_helps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A part of the cell shows a collision, with its run; what it does not show is not known."""
    monkeypatch.setattr("pn2code.geometry.check.explore_wider", lambda *_: None)
    cell = packing(tmp_path / "cell", guarded=False)
    code, said = asked(cell, tmp_path / "runs", "--max-states", "130")
    assert code == 1 and "NO: `Top.Robot1.Visit1` and `Top.Robot2.Visit2`" in said, said
    assert "What is wrong was sought in parts of it, of 130 and 130 and 130 and 130 states" in said
    assert "not known  each move can be done" in said
    (trace,) = (tmp_path / "runs").iterdir()
    assert CliRunner().invoke(app, ["replay", str(trace), str(cell)]).exit_code == 0


def test_a_sensor_that_sees_is_left_to_the_cell_itself(
    tmp_path: Path, few: Callable[[int], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    few(100)
    monkeypatch.setattr(Situations, "sees", True)
    code, said = asked(packing(tmp_path / "cell", guarded=True), tmp_path / "runs")
    assert code == 3 and "a sensor sees its scene" in said, said


@pytest.mark.parametrize("seed", range(7, 7 + amount(2, 12)))
def test_the_other_net_leaves_out_nothing(tmp_path: Path, seed: int) -> None:
    """Whatever can be under way at once in a random cell, from wherever, can be so in the net that does more."""
    net, toml = machine_cell(Random(seed)) if seed % 2 else two_arm_cell(Random(seed))
    (tmp_path / "cell.cpn").write_bytes(cpn(net))
    (tmp_path / "cell.toml").write_text(toml)
    d = Diagnostics()
    opened = read(tmp_path, {}, d)
    assert opened is not None and opened.config is not None
    partition, cells = divide(opened.flat, opened.config, d), cells_of(opened.config, None, d)
    assert partition is not None and cells is not None
    ((_, arms),) = cells
    doing = Doing(Planner(arms), arms)
    graphs = (f(partition, opened.storage, Limits(), d) for f in (explore_cell, explore_wider))
    found = []
    for graph in graphs:
        assert graph is not None and not graph.why
        found.append(Situations(graph, doing, tuple(r.name for r in arms.moving)))
        found[-1].explore()
    own, wider = found
    assert {n for n, _ in own.activities} <= {n for n, _ in wider.activities}
    assert own.pairs.keys() <= wider.pairs.keys()
    assert own.beside.keys() <= wider.beside.keys()
    assert wider.why or not own.why
    assert wider.stopped or not own.stopped
