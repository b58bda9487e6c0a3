"""`pn2code conform`: of several messages that one occurrence puts, a program may see some and not yet the others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.netbuilder import write
from helpers.processes import pn2code

pytestmark = pytest.mark.cc

NET = """
net cell
  standard
  fun act () = ();
  fun crush () = ();
  var n, k: INT;
  page Top
    place size : INT
    place order : INT
    place weight : INT
    place done : INT
    subst Supervisor = Sup (size -> size, order -> order, weight -> weight, done -> done)
    subst Device = Dev (size -> size, order -> order, weight -> weight, done -> done)
  page Sup
    place size port out : INT
    place order port out : INT
    place weight port in : INT
    place done port in : INT
    place Ready = 1
    place Wait
    place Finished
    trans Send
      in Ready : ()
      out size : 7
      out order : 1
      out Wait : ()
    trans Got
      in Wait : ()
      in done : k
      in weight : n
      out Finished : ()
  page Dev
    place size port in : INT
    place order port in : INT
    place weight port out : INT
    place done port out : INT
    place Idle = 1
    place Told : INT
    trans Take
      in order : n
      in size : k
      in Idle : ()
      out Told : k
    trans Work guard [n < 100] code action act ()
      in Told : n
      out weight : n
      out done : n
      out Idle : ()
    trans Reject guard [n >= 100] code action crush ()
      in Told : n
      out weight : n
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
place = "size"
file = "size.txt"
kind = "data"
[[channel]]
place = "weight"
file = "weight.txt"
kind = "data"
[[channel]]
place = "order"
file = "order.txt"
[[channel]]
place = "done"
file = "done.txt"
[primitives]
act = { command = "tool", action = "act", duration_s = 2.0 }
crush = { command = "tool", action = "crush", duration_s = 2.0 }
[devices.device]
instance = "Device"
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    folder = tmp_path / "cell"
    folder.mkdir()
    write(NET, folder / "cell.cpn")
    (folder / "cell.toml").write_text(CELL)
    assert pn2code("generate", folder, "-o", folder / "generated").returncode == 0
    return folder


def edited(cell: Path, name: str, old: str, new: str) -> str:
    """What `conform` says after an edit, which has to be a difference."""
    file = cell / "generated" / name
    text = file.read_text()
    found, count = re.subn(old, new, text)
    assert count == 1
    file.write_text(found)
    done = pn2code("conform", cell, "--generated", cell / "generated")
    assert done.returncode == 1, done.stdout + done.stderr
    return done.stdout


def test_the_programs_agree(cell: Path) -> None:
    done = pn2code("conform", cell, "--generated", cell / "generated")
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_script_that_does_something_between_two_messages_is_found_out(cell: Path) -> None:
    old = r"""    wait until filled\(order\)
    read order into n
    wait until filled\(size\)
    read size into k
"""
    new = """\
    wait until filled(size)
    read size into k
    if not filled(order) then
      tool crush for 2 s
      wait until filled(order)
    end if
    read order into n
"""
    said = edited(cell, "device.tdl", old, new)
    assert (
        "was not enabled according to the net when the script commanded ToolAction(action='crush', "
        in said
    )
    assert "size.txt is published" in said


def test_a_supervisor_that_does_not_wait_for_the_second_message_is_found_out(cell: Path) -> None:
    old = r"    if \(!m->done\.full\) \{ /\* done: k .*\n        return true;\n    \}\n"
    said = edited(cell, "net.c", old, "")
    assert "the supervisor fires 1 times, but 0 times according to the net" in said
    assert "weight.txt is published" in said
