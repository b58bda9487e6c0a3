"""The example cells in PyBullet: what is proved of them and seen on the `fake` backend, with shapes that may touch."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.solvers import solver_for
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

CELLS = (
    "minimal",
    "welding",
    "handover",
    "tending",
    "palletiser",
    "machining",
    "sorting",
    "shared-zone",
    "assembly",
)


@pytest.mark.cc
@pytest.mark.bullet
@pytest.mark.usefixtures("quick_build")
@pytest.mark.parametrize("name", CELLS[: amount(1, len(CELLS))])
def test_it_finishes_and_nothing_touches(name: str, root: Path, tmp_path: Path) -> None:
    solver_for(name)
    d = Diagnostics()
    options = RunOptions(tmp_path, backend="bullet", looks=False, checked=False)
    result = run_cell(root / "examples" / name, options, d)
    assert result is not None, [x.message for x in d]
    assert (result.record.verdict, result.record.reason) == ("finished", "")
    assert not [x.message for x in d if x.code != "controller-unchecked"]
