"""Whether an occurrence is a fixed number of takes and puts: `with_direct` writes it into the transitions."""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.lowering.passes.moves import is_count
from pn2code.lowering.passes.reach import Reach

_WHOLE = (ir.TakeAll, ir.PutAll)


def with_direct(net: ir.NetIR, reach: Reach) -> ir.NetIR:
    """The net, with what this pass finds; `sums` are known."""
    return replace(
        net,
        transitions=tuple(replace(t, is_direct=_is_direct(net, t, reach)) for t in net.transitions),
    )


def _is_direct(net: ir.NetIR, t: ir.Transition, reach: Reach) -> bool:
    """Whether the moves are known one by one or as `sums`; what is taken must be what was found."""
    sums = {(s.place, s.multiset) for s in t.sums}
    nodes = reach.nodes(t.fire)
    takes = [n for n in nodes if isinstance(n, ir.Take)]
    puts = [n for n in nodes if isinstance(n, ir.Put)]
    moved = {n.place for n in takes} | {n.place for n in puts}
    top = [s for s in t.fire if isinstance(s, ir.Take)]
    whole = [n for n in nodes if isinstance(n, _WHOLE)]
    return (
        not any(isinstance(n, ir.Reset) for n in nodes)
        and all((n.place, n.multiset) in sums for n in whole)
        and len(whole) == sum(isinstance(s, _WHOLE) for s in t.fire)
        and not any(net.places[place].timed for place in moved)
        and len(takes) == len(top)
        and all(is_count(n.count) for n in takes)
        and len(puts) == len([*_ways(t.fire)])
        and reach.is_pure(ir_nodes(tuple(n.value for n in top)))
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
