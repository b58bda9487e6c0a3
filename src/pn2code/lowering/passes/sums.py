"""Multi-sets that arcs compute from a few variables with few values: worked out once for each, then kept as counters.

`others(s)` on an arc of a packed place is a function that makes a list. In C it is called once for each value of `s`;
after that the arc is a comparison, addition or subtraction of words (`place_has_sum` and the like in pn_packed.h).
`with_sums` writes them into the transitions (`sums`).
"""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import Descriptor
from pn2code.lowering.nets.packing import colours
from pn2code.lowering.passes.reach import Reach

_MOST_SUMS = 1024
_MOST_WORDS = 1 << 14
"""Of all sums of one arc."""


_WHOLE = (ir.TakeAll, ir.PutAll)
_LOOKING = (ir.Use, ir.TokenValue)


def with_sums(net: ir.NetIR, reach: Reach) -> ir.NetIR:
    """The net, with what this pass finds."""
    descriptors = {d.name: d for d in net.descriptors}
    return replace(
        net,
        transitions=tuple(
            replace(t, sums=tuple(_find(net, t, descriptors, reach).values()))
            for t in net.transitions
        ),
    )


def _find(
    net: ir.NetIR, t: ir.Transition, descriptors: Mapping[str, Descriptor], reach: Reach
) -> dict[tuple[int, ir.Ir], ir.Sum]:
    """The sums of a transition by place and multi-set."""
    found: dict[tuple[int, ir.Ir], ir.Sum] = {}
    for node in (*reach.nodes(t.enumerate), *reach.nodes(t.fire)):
        if not isinstance(node, _WHOLE) or (node.place, node.multiset) in found:
            continue
        packed = net.places[node.place].packed
        if packed is None or not _is_function_of_binding(node.multiset, reach):
            continue
        variables = _variables(t, node.multiset, descriptors)
        words = (packed.bit % 64 + packed.colours * packed.width + 63) // 64
        if variables is None:
            continue
        made = ir.Sum(node.place, node.multiset, node.table, variables, words, node.note)
        if made.count <= _MOST_SUMS and made.count * words <= _MOST_WORDS:
            found[node.place, node.multiset] = made
    return found


def _is_function_of_binding(multiset: ir.Ir, reach: Reach) -> bool:
    nodes = list(ir_nodes(multiset))
    return (
        not any(isinstance(n, _LOOKING) for n in nodes)
        and reach.is_pure(nodes)
        and not reach.reaches(nodes, _is_now)
    )


def _is_now(node: object) -> bool:
    return isinstance(node, ir.Now)


def _variables(
    t: ir.Transition, multiset: ir.Ir, descriptors: Mapping[str, Descriptor]
) -> tuple[tuple[int, str, int], ...] | None:
    """The variables that decide; None if they have too many values."""
    indices = sorted({n.index for n in ir_nodes(multiset) if isinstance(n, ir.Bound)})
    own = [t.variables[i] for i in indices]
    counts = [colours(descriptors, v.table) for v in own]
    if any(v.is_output for v in own) or 0 in counts:
        return None
    return tuple((i, v.table, n) for i, v, n in zip(indices, own, counts, strict=True))
