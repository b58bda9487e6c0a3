"""Two declarations of one id: the engine of CPN Tools forgets the first when it comes to the second.

All expectations are answers of the engine.
"""

from __future__ import annotations

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.net.check import check
from pn2code.net.link import link
from pn2code.reading.cpn import read_data

NET = """
    net Ids
      colset INT = int;
      var n : INT;
      page Top
        place A : INT = 1`1
        trans T guard [GUARD]
          in A : n
"""
F1 = '<ml id="X1">fun f1 z = z + 1;</ml>'
F2 = '<ml id="X2">fun f2 z = f1 z;</ml>'
F3 = '<ml id="X1">fun f3 z = z;</ml>'
Q1 = '<ml id="X1">val q = 1;</ml>'
K1 = '<color id="X1"><id>K1</id><int/></color>'
K2 = '<color id="X1"><id>K2</id><int/></color>'
OF_K1 = '<var id="X3"><type><id>K1</id></type><id>k</id></var>'
G = '<globref id="X1"><id>g</id><ml>0</ml></globref>'
H = '<globref id="X1"><id>h</id><ml>0</ml></globref>'


def errors(declarations: str, guard: str = "n &gt; 0") -> tuple[list[str], int]:
    """The codes of the errors, and how many declarations were forgotten."""
    data = cpn(NET).replace(b"GUARD", guard.encode())
    data = data.replace(b"</globbox>", f"{declarations}</globbox>".encode())
    d = Diagnostics()
    document = read_data(data, "ids.cpn", d)
    assert document is not None
    net = link(document, d)
    assert net is not None
    check(net, d)
    return [x.code for x in d.errors], sum(x.code == "duplicate-id" for x in d.items)


@pytest.mark.parametrize(
    ("declarations", "guard"),
    [
        (F1 + F3, "f3 n &gt; 0"),
        (F1 + F1, "f1 n &gt; 0"),
        (F1 + F2 + F3, "f2 n &gt; 0"),  # a function keeps what it was declared with
        (K1 + K2, "n &gt; 0"),
        (K1 + OF_K1 + K2, "n &gt; 0"),
        (Q1 + K2, "n &gt; 0"),
    ],
)
def test_what_is_forgotten_may_stay_unused(declarations: str, guard: str) -> None:
    assert errors(declarations, guard) == ([], 1)


@pytest.mark.parametrize(
    ("declarations", "guard"),
    [
        (F1 + F3, "f1 n &gt; 0"),
        (F1 + F3 + F2, "n &gt; 0"),
        (K1 + K2 + OF_K1, "n &gt; 0"),
        (K1 + OF_K1 + K2, "n = k"),
        (G + H + '<ml id="X4">fun get () = !g;</ml>', "n &gt; 0"),
        (Q1 + '<ml id="X1">val r = 2;</ml><ml id="X5">val s = q + r;</ml>', "n &gt; 0"),
    ],
)
def test_what_is_forgotten_cannot_be_used(declarations: str, guard: str) -> None:
    found, forgotten = errors(declarations, guard)
    assert found and forgotten == 1


def test_different_ids_are_not_mentioned() -> None:
    assert errors(F1 + F2, "f2 n &gt; 0") == ([], 0)
