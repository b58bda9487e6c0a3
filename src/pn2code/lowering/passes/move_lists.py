"""Whether a program has lists of moves, which take memory: not all is done by functions of the places.

`with_move_lists` writes it into the net (`has_moves`), and again whenever it has become known which places are slots.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.lowering.passes.moves import is_pair


def with_move_lists(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds; `is_direct` and `is_slot` are known."""
    return replace(net, has_moves=any(map(_has_moves, _programs(net))))


def _has_moves(statements: tuple[ir.Stmt, ...]) -> bool:
    return any(isinstance(n, ir.Put | ir.Take | ir.Reset) for n in ir_nodes(statements))


def _programs(net: ir.NetIR) -> Iterator[tuple[ir.Stmt, ...]]:
    """The statements of which moves are noted in lists."""
    for p in net.places:
        yield p.initial
    timed = tuple(p.timed for p in net.places)
    for t in net.transitions:
        if not t.is_direct or any(isinstance(s, ir.TakeAll | ir.PutAll) for s in t.fire):
            yield t.fire
        for node in ir_nodes((t.enumerate, t.thresholds)):
            if isinstance(node, ir.Wanted) and not (
                is_pair(node.takes, timed) and not _has_slots(net, node.takes)
            ):
                yield node.takes


def _has_slots(net: ir.NetIR, takes: tuple[ir.Stmt, ...]) -> bool:
    return any(isinstance(s, ir.Take) and net.places[s.place].is_slot for s in takes)
