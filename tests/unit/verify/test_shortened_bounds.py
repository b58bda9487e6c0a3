"""Multi-set bounds that are cut because the time is over say how many colours there are."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.base.deadline import Deadline
from pn2code.cli.main import app

NET = """
    net N
      standard
      var n: INT;
      page Top
        place A : INT = 1`0
        trans T
          guard [n < 299]
          in A : n
          out A : n + 1
"""


@pytest.mark.parametrize("is_over", [False, True])
def test_a_full_report_after_the_time(
    is_over: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    net = write(NET, tmp_path / "n.cpn")
    if is_over:
        monkeypatch.setattr(Deadline, "is_over", lambda _: True)
    done = CliRunner().invoke(app, ["verify", str(net), "--json", "--full", "--most-traces", "0"])
    (row,) = json.loads(done.stdout)["bounds"]
    assert row["upper_multiset"].count("`") == (200 if is_over else 300)
    assert row["upper_cut"] == (300 if is_over else None)
