"""Transitions that only count: explorers that have tables of them see what the token game sees."""

from __future__ import annotations

import random

import pytest

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat
from helpers.random_tables import random_tables, restless_tables
from helpers.thorough import amount
from pn2code.contest.tables import Tables
from pn2code.lowering.passes import counting

pytestmark = pytest.mark.cc


def _text(tables: Tables, copies: int = 1) -> str:
    """The net in the short form, with so many copies of each transition."""
    lines = ["net Cell", "  standard"]
    lines += [f"  place P{p}" + (f" = {n}" if n else "") for p, n in enumerate(tables.initial)]
    for t, (taken, put) in enumerate(zip(tables.pre, tables.post, strict=True)):
        for copy in range(copies):
            lines.append(f"  trans T{t}_{copy}")
            lines += [f"    in P{p} : {n}`()" for p, n in taken.items()]
            lines += [f"    out P{p} : {n}`()" for p, n in put.items()]
    return "\n".join(lines)


@pytest.mark.parametrize("seed", range(amount(5, 12)))
def test_random_nets(explorers: Explorers, monkeypatch: pytest.MonkeyPatch, seed: int) -> None:
    """In counters of one bit at first, so that they overflow, and of four; with short keys or without."""
    monkeypatch.setattr(counting, "FEW", 0)
    draw = random.Random(4100 + seed)
    make = restless_tables if seed % 3 == 0 else random_tables
    for width in (1, 4):
        agrees(explorers, flat(_text(make(draw))), width=width)


def test_a_large_net(explorers: Explorers) -> None:
    """More than 40 transitions: nothing need be said for them to be tables, and their C is short."""
    net = flat(_text(random_tables(random.Random(5)), copies=41))
    assert agrees(explorers, net) in ("same", "large")
    source = (explorers.folder / "net" / "net.c").read_text()
    assert source.count("PN_COUNTING") == len(net.transitions) > counting.FEW
    assert "_enumerate(" not in source


def test_what_does_more_has_code_of_its_own(
    explorers: Explorers, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(counting, "FEW", 0)
    net = flat("""
        net Cell
          standard
          colset N = int with 0..3;
          var n: N;
          place A = 4
          place B : N = 1`2
          place C
          trans Counts
            in A : 2`()
            out C
          trans Looks guard [n > 0]
            in B : n
            in C
            out A
            out B : n - 1
          trans Waits
            inhibit B
            in C
            out A
    """)
    assert agrees(explorers, net) == "same"
    source = (explorers.folder / "net" / "net.c").read_text()
    assert source.count("PN_COUNTING") == 1


def test_errors_name_the_place(explorers: Explorers, monkeypatch: pytest.MonkeyPatch) -> None:
    """An overflow is seen by the place, which gets wider counters."""
    monkeypatch.setattr(counting, "FEW", 0)
    net = flat("""
        net Cell
          standard
          place A = 1
          place B
          trans T
            in A
            out B : 300`()
    """)
    assert agrees(explorers, net, width=1) == "same"
