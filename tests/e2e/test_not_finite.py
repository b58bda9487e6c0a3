"""Reals that are no numbers, or infinite, as tokens: all hosts have the same markings, and traces can be replayed.

The engine of CPN Tools finds tokens by an order in which what is no number is like every number: what it does with
such a token depends on what else there is. Here it is a token like any other (docs/semantics.md).
"""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat, write
from pn2code.cli.main import app

pytestmark = pytest.mark.cc

NETS = {
    "arith": """net n
  standard
  var x, y : REAL;
  page Top
    place A : REAL = 1`(0.0/0.0) ++ 1`1.0 ++ 1`(1.0/0.0) ++ 1`(~1.0/0.0)
    place B : REAL = 1`(0.0/0.0) ++ 1`2.0
    trans T
      in A : x
      in B : y
      out A : x - x
      out B : x * y
""",
    "pair": """net n
  standard
  colset P = product INT * REAL;
  colset L = list REAL;
  colset U = union N : INT + R : REAL;
  var x, y : REAL;  var n : INT;  var l : L; var u : U;
  page Top
    place A : P = 1`(1, 0.0/0.0) ++ 1`(2, 1.0) ++ 1`(3, 0.0/0.0)
    place B : REAL = 2`(0.0/0.0) ++ 1`1.0
    place C : L = 1`[0.0/0.0] ++ 1`[1.0, 0.0/0.0]
    place D : U = 1`(R (0.0/0.0)) ++ 1`(N 3)
    place E : L
    trans T
      in A : (n, x)
      in B : x
      out E : [x]
    trans S guard [x = y]
      in A : (n, x)
      in B : y
      out E : [x, y]
    trans W
      in E : l
      in C : l
      out D : R (hd l)
    trans V guard [x <> y]
      in D : R x
      in B : y
      out D : N 4
""",
    "one": """net n
  standard
  var x, y : REAL;
  page Top
    place A : REAL = 1`(0.0/0.0)
    place B : REAL = 1`1.0
    trans T
      in A : x
      in B : y
      out A : y
      out B : ~x
    trans S
      in A : x
      in B : x
      out A : 0.0
      out B : 0.0
    trans E guard [y = x]
      in A : x
      in B : y
      out A : y
      out B : x
""",
    "timed": """net n
  standard
  colset R = real timed;
  var x, y : R;
  page Top
    place A : R = 2`(0.0/0.0) ++ 1`1.0
    place B : REAL = 1`(0.0/0.0)
    trans T
      in A : x
      both B : x
      out A : 1.0 @+ 1
    trans S
      in A : x
      in B : x
      out A : x
""",
}


@pytest.mark.parametrize("name", NETS)
def test_all_hosts_have_the_same_graph(explorers: Explorers, name: str) -> None:
    assert agrees(explorers, flat(NETS[name]), width=1) == "same"


@pytest.mark.parametrize("name", NETS)
def test_traces_are_replayed(name: str, tmp_path: Path) -> None:
    """Written by the compiled net, read by the token game."""
    net, trace = write(NETS[name], tmp_path / "n.cpn"), tmp_path / "t.jsonl"
    done = CliRunner().invoke(app, ["simulate", str(net), "--steps", "6", "--trace", str(trace)])
    assert done.exit_code == 0, done.output
    assert "nan" in trace.read_text(encoding="utf-8")
    done = CliRunner().invoke(app, ["replay", str(trace), str(net)])
    assert done.exit_code == 0, done.output


def test_the_first_in_order_is_what_is_no_number(tmp_path: Path) -> None:
    """A marking has one text, however it came about."""
    net = write(NETS["pair"], tmp_path / "n.cpn")
    done = CliRunner().invoke(app, ["marking", str(net)])
    assert "2`nan++\n     1`1.0" in done.output
