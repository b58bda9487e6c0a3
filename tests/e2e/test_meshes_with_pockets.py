"""An arm reaches into a trough: a collision with its convex hull, free with its pieces, in runs and in the check."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from e2e.test_check_geometry import looked
from helpers.carrying_cell import NET, TOML, write
from helpers.processes import pn2code
from helpers.thorough import amount
from pn2code.robot import convex_pieces
from unit.robot.test_convex_pieces import trough

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

TABLE = '{ name = "table", size = [0.4, 0.4, 0.5], pose = { x = 1.5, y = -0.6, z = 0.25 } }'
MESH = (
    '{{ name = "table", kind = "mesh", file = "trough.obj", hulls = {}, '
    "pose = {{ x = 1.5, y = -0.6, z = -0.002 }} }}"
)


@pytest.mark.parametrize("hulls", [1, 4])
def test_reaching_into_a_trough(
    hulls: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(convex_pieces, "_TRIES", amount(3, 8))
    assert TOML.count(TABLE) == 1
    one = NET.replace("val parts = 2;", "val parts = 1;")
    cell = write(tmp_path / "cell", net=one, toml=TOML.replace(TABLE, MESH.format(hulls)))
    trough(cell, top=0.7)
    found = looked(cell, tmp_path / "looked")
    ran = pn2code(
        "run", cell, "--backend", "bullet", "--no-pictures", "--no-replay", "-o", tmp_path / "out"
    )
    answers = {m.answer for m in found.moves}
    if hulls == 1:
        assert "no" in answers and ran.returncode != 0
        assert any("table" in m.problem for m in found.moves)
    else:
        assert answers == {"yes"}, [m.problem for m in found.moves]
        summary = json.loads(next((tmp_path / "out").rglob("summary.json")).read_text())
        assert ran.returncode == 0, (ran.stdout, summary)
