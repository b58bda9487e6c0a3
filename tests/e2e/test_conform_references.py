"""`pn2code conform` of a cell whose supervisor counts in a reference: what it holds is a part of each state."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from helpers.netbuilder import write
from helpers.processes import pn2code

pytestmark = pytest.mark.cc

NET = """
net cell
  standard
  globref count = 0;
  fun act () = ();
  var n, k: INT;
  page Top
    place order : INT
    place done : INT
    subst Supervisor = Sup (order -> order, done -> done)
    subst Device = Dev (order -> order, done -> done)
  page Sup
    place order port out : INT
    place done port in : INT
    place Ready = 1
    place Wait
    place Finished
    trans Send guard [!count < 3] code output (n); action (count := !count + 1; !count)
      in Ready : ()
      out order : n
      out Wait : ()
    trans Got
      in Wait : ()
      in done : k
      out Ready : ()
    trans End guard [!count >= 3]
      in Ready : ()
      out Finished : ()
  page Dev
    place order port in : INT
    place done port out : INT
    place Idle = 1
    place Told : INT
    trans Take
      in order : n
      in Idle : ()
      out Told : n
    trans Work code action act ()
      in Told : n
      out done : n
      out Idle : ()
"""
CELL = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "order"
file = "order.txt"
[[channel]]
place = "done"
file = "done.txt"
[primitives]
act = { command = "tool", action = "act", duration_s = 2.0 }
[devices.device]
instance = "Device"
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    folder = tmp_path / "cell"
    folder.mkdir()
    write(NET, folder / "cell.cpn")
    (folder / "cell.toml").write_text(CELL)
    return folder


def test_states_with_other_references_are_other_states(cell: Path) -> None:
    done = pn2code("conform", cell, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads(done.stdout)
    assert found["supervisor"]["firings"] == 3 + 3 + 1
    assert (found["supervisor"]["received"], found["supervisor"]["sent"]) == (3, 3)
    assert found["robots"][0]["commands"] == 3


def test_a_supervisor_that_sends_something_else_later_is_found_out(
    cell: Path, tmp_path: Path
) -> None:
    out = tmp_path / "generated"
    assert pn2code("generate", cell, "-o", out).returncode == 0
    text = (out / "net.c").read_text()
    edited = text.replace("    b->n = count_2;\n", "    b->n = 1;\n")
    assert edited != text
    (out / "net.c").write_text(edited)
    done = pn2code("conform", cell, "--generated", out)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "order.txt holds (1,), number 2; according to the net (2,), number 2" in done.stdout
