"""Whether an occurrence is a fixed number of takes and puts."""

from __future__ import annotations

from collections.abc import Container, Iterable

from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.lowering.passes.moves import is_count


def is_direct(net: ir.NetIR, t: ir.Transition, sums: Container[tuple[int, ir.Ir]] = ()) -> bool:
    """Whether the occurrence is a fixed number of takes and puts of untimed places, known one by one or as `sums`."""
    takes = [n for n in ir_nodes(t.fire) if isinstance(n, ir.Take)]
    puts = [n for n in ir_nodes(t.fire) if isinstance(n, ir.Put)]
    moved = {n.place for n in takes} | {n.place for n in puts}
    top = [s for s in t.fire if isinstance(s, ir.Take)]
    whole = [n for n in ir_nodes(t.fire) if isinstance(n, ir.TakeAll | ir.PutAll)]
    return (
        not any(isinstance(n, ir.Reset) for n in ir_nodes(t.fire))
        and all((n.place, n.multiset) in sums for n in whole)
        and len(whole) == sum(isinstance(s, ir.TakeAll | ir.PutAll) for s in t.fire)
        and not any(net.places[place].timed for place in moved)
        and len(takes) == len(top)
        and all(is_count(n.count) for n in takes)
        and len(puts) == len([*_ways(t.fire)])
    )


def _ways(statements: Iterable[ir.Stmt]) -> Iterable[ir.Put]:
    """The `Put`s that stand at the top or in branches, not in loops."""
    for s in statements:
        match s:
            case ir.Put():
                yield s
            case ir.If(then=then, otherwise=otherwise):
                yield from _ways(then)
                yield from _ways(otherwise)
            case _:
                pass
