"""How many bytes of arena a program is proven to need: a field of the IR, and the dump."""

from __future__ import annotations

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.dump import dump
from pn2code.lowering.passes.arena import ALIGNMENT, MOVE

NET = """
    net Cell
      standard
      colset LATE = int timed;
      var n: INT;
      var late: LATE;
      place A : INT = 1`1
      place B : LATE
      place C : STRING
"""


def net_of(*lines: str) -> ir.NetIR:
    net, d = lowered(flat(NET + "".join(f"      {line}\n" for line in lines)))
    assert net is not None, d.errors
    return net


def test_the_moves_of_the_start_and_of_one_firing() -> None:
    text = NET.replace("      place C : STRING\n", "") + "      trans T\n        in A : n\n"
    net, _ = lowered(flat(text + "        out B : n\n"))
    assert net is not None
    # One is put at the start; `T` takes one and puts one: of both times as much, for the halves of the arena.
    assert net.arena == ir.Arena(2 * 3 * (MOVE + ALIGNMENT), "")
    assert f"arena {net.arena.bytes:,} bytes\n" in dump(net)


def test_what_is_not_proven() -> None:
    net = net_of("trans T", "  in A : n")
    assert net.arena.bytes is None and "lists, strings" in net.arena.why
    assert f"arena not proven: {net.arena.why}\n" in dump(net)
