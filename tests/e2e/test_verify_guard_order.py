"""`verify` of a net in which an exception is raised here, and in CPN Tools perhaps not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.cli.main import app

pytestmark = pytest.mark.cc

NET = """
    net N
      standard
      colset L = list INT;
      var l : L;
      var n : INT;
      page Top
        place P : L = 1`[]
        place A : INT = 1`1
        trans T
          guard [hd l > 0, n > 1]
          in P : l
          in A : n
"""


def test_an_exception_that_may_not_be_one_there(tmp_path: Path) -> None:
    net = write(NET, tmp_path / "n.cpn")
    done = CliRunner().invoke(app, ["verify", str(net), "--json", "-o", str(tmp_path / "runs")])
    row = json.loads(done.stdout)
    assert row["error"] is not None and row["error"]["binding"] is None
    (said,) = row["guard_order"]
    assert (said["raises"], said["where"]) == ("hd l > 0", "here")
    assert "CPN Tools may look at `n" in done.stderr and "raise nothing" in done.stderr
