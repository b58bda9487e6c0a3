"""Timed multi-sets on input arcs that are computed, in compiled nets: as in the token game."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.cli.main import app

pytestmark = pytest.mark.cc

NET = """
net Timed
  standard
  colset T = int timed;
  var k : INT;
  fun now n = 1`n@+0;
  page Main
    place A : T = 1`3@7+++1`4@5+++1`3@19+++1`5@8
    place B : T
    place K : INT = 1`3 ++ 1`5
    trans X
      {kind} A : {inscription}
      in K : k
      out B : 1`k@+1
"""


@pytest.mark.parametrize("kind", ["in", "both"])
@pytest.mark.parametrize(
    "inscription",
    ["if k > 3 then 1`5@+0 else 1`3@+0", "now k", "case k of 3 => (1`3++1`4)@+0 | x => 1`x@+0"],
)
def test_both_engines_do_the_same(kind: str, inscription: str, tmp_path: Path) -> None:
    net = write(NET.format(kind=kind, inscription=inscription), tmp_path / "net.cpn")
    found: list[dict[str, Any]] = []
    for engine in ("compiled", "reference"):
        done = CliRunner().invoke(app, ["simulate", str(net), "--engine", engine, "--json"])
        assert done.exit_code == 0, done.output
        said = json.loads(done.stdout)
        found.append({p["name"]: p["marking"] for p in said["places"]})
    assert found[0] == found[1]
    assert found[0]["K"] == "empty"
