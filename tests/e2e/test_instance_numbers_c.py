"""`inst ()` in compiled nets: functions that an inscription declares differ between the instances of its page."""

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
net Numbered
  standard
  colset JOB = int timed;
  colset SEEN = product INT * INT;
  var n, k: INT;
  fun number () = inst ();
  fun times x = x * number ();
  page Top
    place In : INT = 2`1 ++ 3`2
    place Out : SEEN
    subst B = Sub (In -> In, Out -> Out)
    subst A = Sub (In -> In, Out -> Out)
  page Sub
    place In port in : INT
    place Out port out : SEEN
    place Clock : JOB = 1`(inst ())
    trans Tick guard [n < 4] delay @+inst ()
      in Clock : n
      out Clock : 1`(n + number ()) @+ (times 10)
    trans Take guard [n = number ()] code input (n); output (k); action let fun own x = x * inst () in own n end;
      in In : (inst () + 1)`n
      out Out : (k, hd (List.map (fn x => x * inst ()) [100]) + let val f = fn x => x + times 1 in f 1 end)
"""
ENDS = {
    ("Top", "In", 1): "empty",
    ("Top", "Out", 1): "1`(1,102)++\n1`(4,203)",
    ("Sub", "Clock", 1): "1`4@33",
    ("Sub", "Clock", 2): "1`4@22",
}


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_each_instance_has_its_own(engine: str, tmp_path: Path) -> None:
    net = write(NET, tmp_path / "net.cpn")
    done = CliRunner().invoke(app, ["simulate", str(net), "--engine", engine, "--json"])
    assert done.exit_code == 0, done.output
    said: dict[str, Any] = json.loads(done.stdout)
    ended = {(p["page"], p["name"], p["instance"]): p["marking"] for p in said["places"]}
    assert {key: ended[key] for key in ENDS} == ENDS
