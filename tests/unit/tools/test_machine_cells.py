"""The random cells with devices of `./dev geometry --cells` are cells, and of many kinds."""

from __future__ import annotations

import tomllib
from pathlib import Path
from random import Random

import pytest

from helpers.machine_cells import machine_cell
from helpers.netbuilder import cpn
from helpers.robot_cells import nowhere
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.robot.parts import Parts
from pn2code.robot.scene import load
from pn2code.verdict.opened import read


@pytest.mark.parametrize("seed", [1, 2])
def test_a_random_cell_can_be_divided(seed: int, tmp_path: Path) -> None:
    net, toml = machine_cell(Random(seed))
    (tmp_path / "cell.cpn").write_bytes(cpn(net))
    (tmp_path / "cell.toml").write_text(toml)
    d = Diagnostics()
    opened = read(tmp_path, {}, d)
    assert opened is not None and opened.config is not None, [e.message for e in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [e.message for e in d.errors]
    assert {"arm", "feeder", "mill", "table"} < {o.name for o in partition.owners}


def test_in_some_of_them_parts_are_stacked_and_waits_are_missing() -> None:
    waits, parts = set(), set()
    for seed in range(30):
        net, toml = machine_cell(Random(seed))
        waits.add((net.count("trans Send"), net.count("place After")))
        d = Diagnostics()
        cell = load(tomllib.loads(toml), Path(), nowhere, d)
        assert cell is not None, [e.message for e in d.errors]
        on = [p.plate for p in Parts(cell).present.values()]
        parts.add((on.count("feeder/belt"), on.count("table/plate")))
    assert parts == {(1, 0), (2, 0), (1, 1), (2, 1)}
    assert {tasks for tasks, _ in waits} == {6, 10, 13} and len(waits) > 8
