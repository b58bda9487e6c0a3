"""Which functions and tables come into the program: fields of the IR, and the dump."""

from __future__ import annotations

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from helpers.questions import net_and_elaborator, predicate
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.lowering.nets.net import lower

HEAD = """
    net Cell
      standard
      colset SMALL = int with 0..9;
      fun even n = n mod 2 = 0
      colset EVEN = subset SMALL by even;
      colset LIST = list SMALL;
      colset PAIR = product SMALL * STRING;
      globref count = 0;
      val cells = [ref 5];
      fun more n = n + 1
      fun twice n = more (more n)
      var n, m: INT;
      var s: SMALL;
      var l: LIST;
      place A : INT = 1`1
      place B : INT
"""


def net_of(*lines: str) -> ir.NetIR:
    net, d = lowered(flat(HEAD + "".join(f"      {line}\n" for line in lines)))
    assert net is not None, d.errors
    return net


def test_functions_that_are_called_directly_or_not() -> None:
    net = net_of("trans T", "  in A : n", "  out B : twice n")
    assert net.used.functions == ("more/1", "twice/1")
    assert net.used.further_functions == ()


def test_the_function_that_decides_about_a_subset() -> None:
    net = net_of("place E : EVEN", "trans T", "  in A : n", "  out E : n")
    assert "member EVEN" in net.used.functions
    assert {"EVEN"} <= set(net.used.tables)
    assert "tables " in dump(net)


def test_tables_of_places_with_those_that_they_refer_to() -> None:
    net = net_of("place P : PAIR")
    assert set(net.used.tables) == {"INT", "SMALL", "STRING", "PAIR"}
    assert "LIST" not in net.used.tables
    assert f"tables {', '.join(net.used.tables)}\n" in dump(net)


@pytest.mark.parametrize(("colset", "refers"), [("INT", 0), ("PAIR", 1), ("LIST", 1), ("SMALL", 0)])
def test_places_with_values_that_refer_into_the_arena(colset: str, refers: int) -> None:
    net = net_of(f"place P : {colset}")
    assert [p.refers for p in net.places] == [False, False, bool(refers)]
    assert ("owner 0 refers\n" in dump(net)) == bool(refers)


def test_variables_that_lead_to_cells() -> None:
    net = net_of("trans T", "  in A : n", "  out B : (count := n; n)", "  out B : n + !(hd cells)")
    assert {g.name: g.is_held for g in net.globals} == {"count": True, "cells": True}
    assert "ref count: int held\n" in dump(net)


def test_files() -> None:
    assert not net_of("trans T", "  in A : n").used.files
    net = net_of(
        "trans T", "  in A : n", '  out B : String.size (TextIO.inputAll (TextIO.openIn "f"))'
    )
    assert net.used.files
    assert "reads or writes files\n" in dump(net)


def test_what_predicates_alone_need() -> None:
    net, elaborator = net_and_elaborator(
        HEAD + "      trans T\n        in A : n\n        out B : more n\n"
    )
    d = Diagnostics()
    partition = divide(net, None, d)
    assert partition is not None
    asked = predicate(net, elaborator, "p", "twice (size A) > 2")
    compiled = lower(partition, {}, d, predicates=[asked])
    assert compiled is not None, d.errors
    assert compiled.used.functions == ("more/1",)
    assert compiled.used.further_functions == ("twice/1",)
    text = dump(compiled)
    assert "function more/1(n: int): int context\n" in text
    assert "function twice/1(n: int): int context of predicates\n" in text
