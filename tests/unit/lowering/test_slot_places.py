"""Which places are slots, and which occurrences are a fixed number of moves: fields of the IR, and the dump."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.lowering.passes.analysis import bounded

HEAD = """
    net Cell
      standard
      colset LATE = int timed;
      colset LIST = list INT;
      var n, m: INT;
      var l: LIST;
      var late: LATE;
      place A : INT = 1`1
      place B : INT
      place C : INT
      place L : LATE = 1`1@0
      place X : LIST = 1`[1]
"""


def net_of(*lines: str, bounds: Collection[int] = ()) -> ir.NetIR:
    net, d = lowered(flat(HEAD + "".join(f"      {line}\n" for line in lines)))
    assert net is not None, d.errors
    assert not any(p.is_slot for p in net.places), "no bound is known yet"
    places = tuple(replace(p, bound=1, capacity=1) if p.index in bounds else p for p in net.places)
    return bounded(replace(net, places=places)) if bounds else net


def slots(*lines: str, bounds: Collection[int] = (0, 1)) -> list[int]:
    return [p.index for p in net_of("trans T", *lines, bounds=bounds).places if p.is_slot]


def test_places_that_are_proven_to_hold_one_token() -> None:
    assert slots("  in A : n", "  out B : n") == [0, 1]
    assert slots("  in A : n", "  out B : n", bounds=(1,)) == [1]
    net = net_of("trans T", "  in A : n", "  out B : n", bounds=(1,))
    assert "place 1 Top.B : INT capacity 1 + 1 owner 0 slot\n" in dump(net)
    assert "place 0 Top.A : INT capacity 64 owner 0\n" in dump(net)


def test_timed_places_are_none() -> None:
    assert slots("  in L : late", bounds=(3,)) == []


def test_who_moves_several_tokens() -> None:
    assert slots("  in A : 2`n", "  out B : n") == [1]
    assert slots("  in A : n", "  out B : n", "  out B : 1`0") == [0]
    assert slots("  in A : n", "  in A : m", "  out B : n") == [1]


def test_the_moves_of_two_ways_are_not_added() -> None:
    assert slots("  in A : n", "  out B : if n > 0 then 1`1 else 1`2") == [0, 1]


def test_a_search_of_slots_alone_is_flat() -> None:
    lines = ("trans T", "  in A : n", "  in B : m")
    assert net_of(*lines, bounds=(0, 1)).transitions[0].is_flat
    assert not net_of(*lines, bounds=(0,)).transitions[0].is_flat
    assert "  enumerate plain flat\n" in dump(net_of(*lines, bounds=(0, 1)))


def test_a_search_without_loops_is_flat_whatever_the_places_are() -> None:
    assert net_of("trans T", "  in A : 1").transitions[0].is_flat


def is_direct(*lines: str) -> bool:
    return net_of("trans T", *lines).transitions[0].is_direct


def test_a_fixed_number_of_moves_is_direct() -> None:
    assert is_direct("  in A : 2`n", "  out B : n + 1", "  out C : if n > 0 then 1`1 else 2`2")
    assert "  fire direct\n" in dump(net_of("trans T", "  in A : n"))


def test_what_is_not_direct() -> None:
    assert not is_direct("  in L : late"), "timed"
    assert not is_direct("  in A : n", "  reset B"), "a reset"
    assert not is_direct("  in X : l", "  out B : l"), "a computed multi-set"
    assert not is_direct("  in B : m", "  in A : m`7"), "a computed number of tokens is taken"
    assert "  fire context\n" in dump(net_of("trans T", "  in L : late"))
