"""Which transitions only count, and what they count."""

from __future__ import annotations

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.lowering.nets.packing import Packing
from pn2code.lowering.passes import counting

NET = """
    net Cell
      standard
      colset PARTS = int with 0..3;
      colset LIST = list PARTS;
      var n: PARTS;
      place A = 3
      place B
      place C : PARTS = 1`1
      place L {others}
      trans Moves
        in A : 2`()
        in B
        out B : 3`()
        out C : 1`0
      trans Weighs
        in A : 2`()
        in B
        out B : 3`()
      trans Makes
        out A
      trans Binds
        in C : n
        out A
      trans Guarded guard [1 > 2]
        in A
      trans Doubts
        in A
        out A : if length (List.tabulate (2, fn i => i)) > 1 then empty else 1`()
      trans Twice
        in A
        in A
        out B
      trans Nothing
"""


def _net(others: str = ": PARTS", *, few: int = 0, successors: bool = True) -> ir.NetIR:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(counting, "FEW", few)
        net, d = lowered(
            flat(NET.replace("{others}", others)), packing=Packing({}, successors=successors)
        )
    assert net is not None, [(e.code, e.message) for e in d.errors]
    return net


def _counts(net: ir.NetIR) -> dict[str, list[tuple[str, int, int, int]]]:
    names = [p.name.removeprefix("Top.") for p in net.places]
    return {
        t.name.removeprefix("Top."): [(names[c.place], c.needs, c.takes, c.puts) for c in t.counts]
        for t in net.transitions
        if t.counts is not None
    }


def test_what_only_counts() -> None:
    net = _net()
    assert {p.name for p in net.places if p.is_only_counted} == {"Top.L"}
    assert _counts(net) == {
        "Weighs": [("A", 2, 2, 0), ("B", 1, 1, 3)],
        "Makes": [("A", 0, 0, 1)],
        "Nothing": [],
    }


def test_only_in_large_nets_of_packed_places_in_explorers() -> None:
    assert _counts(_net(few=8)) == {}
    assert _counts(_net(": LIST")) == {}
    assert _counts(_net(successors=False)) == {}


def test_it_is_in_the_dump() -> None:
    text = dump(_net(), "Top.Weighs")
    assert text.endswith(
        "  counts\n    Top.A needs 2 takes 2 puts 0\n    Top.B needs 1 takes 1 puts 3\n"
    )
