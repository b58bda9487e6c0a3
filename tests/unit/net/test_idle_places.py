"""Places without any arc are remarked on: of a cell by a warning, wherever they are."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers import netbuilder, register_pairs
from pn2code.diagnostics import Diagnostics, Severity
from pn2code.verdict.checking import check


@pytest.mark.parametrize("page", ["Supervisor", "Reader"])
def test_of_a_cell_it_is_a_warning(tmp_path: Path, page: str) -> None:
    cell = register_pairs.write(tmp_path / "cell", register_pairs.TOLD)
    net = cell / "cell.cpnt"
    text = net.read_text(encoding="utf-8")
    at = text.index("\n", text.index(f"\npage {page}") + 1)
    net.write_text(f"{text[:at]}\n  place Forgotten\n  place Lost{text[at:]}", encoding="utf-8")
    d = Diagnostics()
    assert check(cell, {}, d).is_fine
    (said,) = [i for i in d if i.code == "place-idle"]
    assert (said.severity, said.origin.page) == (Severity.WARNING, page)
    assert said.message.startswith("place `Forgotten` has no arc (nor has one more)")
    assert [note.message for note in said.notes] == ["`Lost`"]


NET = """
net Idle
  standard
  var n : INT;
  page Top
    place A : INT = 1`1
    place Idle : INT
    place Socket : INT
    subst S = Sub (In -> A, Unused -> Socket)
  page Sub
    place In port in : INT
    place Unused port in : INT
    trans T
      in In : n
"""


def test_of_a_net_it_is_a_note_and_said_once(tmp_path: Path) -> None:
    """A port without arcs has a warning of its own."""
    d = Diagnostics()
    net = netbuilder.write(NET, tmp_path / "net.cpn")
    assert check(net, {}, d).is_fine
    found = [(i.code, i.severity) for i in d if "idle" in i.code]
    assert found == [("port-idle", Severity.WARNING), ("place-idle", Severity.NOTE)]
    assert "`Idle` has no arc:" in d.items[-1].message
