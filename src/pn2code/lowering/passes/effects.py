"""What an occurrence can change about what is enabled: for the hosts, that look again only where they must.

`with_effects` writes it into the transitions (`effects`), functions (`is_pure`) and the net (`roots`).
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.effects import Effects
from pn2code.ir.types import holds_reference
from pn2code.lowering.passes.reach import Reach, deciding, is_assignment

_EXAMINED = (
    ir.ForTokens, ir.TokenValue, ir.UnlessAvailable, ir.UnlessHeld, ir.UnlessEmpty, ir.Take, ir.TakeAll,
)  # fmt: skip
_CHANGED = (ir.Take, ir.TakeAll, ir.Put, ir.PutAll, ir.Reset)
_READ = (*_EXAMINED, ir.Reset)


def with_effects(net: ir.NetIR, reach: Reach) -> ir.NetIR:
    """The net, with what this pass finds; `staying` is known."""
    searches = [reach.nodes(t.enumerate) for t in net.transitions]
    examined = [_places(nodes, _EXAMINED) for nodes in searches]
    volatile = [not reach.is_pure(deciding(nodes)) for nodes in searches]
    roots = _roots(net, reach)
    impure = reach.impure()

    def effects(t: ir.Transition, program: tuple[object, ...]) -> Effects:
        nodes = reach.nodes(t.fire)
        changed = _changed(net, t, nodes, reach)
        read = tuple(sorted(_places(program, _READ) | _places(nodes, _READ)))
        search, fire, thresholds = (
            deciding(x) for x in (program, nodes, reach.nodes(t.thresholds))
        )
        search_writes = reach.assigns(search)
        return Effects(
            affected=tuple(
                i for i, places in enumerate(examined) if volatile[i] or places & changed
            ),
            touched=tuple(sorted(changed)),
            read=read,
            looks=reach.looks(search) or reach.looks(fire),
            looks_outside=reach.looks_outside(search) or reach.looks_outside(fire),
            assigns=bool(roots) and reach.assigns(fire),
            search_assigns=bool(roots) and (search_writes or reach.assigns(thresholds)),
            search_writes=search_writes,
            search_draws=reach.draws(search),
            fire_draws=reach.draws(fire),
            thresholds_draw=reach.draws(thresholds),
        )

    return replace(
        net,
        functions=tuple(replace(f, is_pure=f.key not in impure) for f in net.functions),
        transitions=tuple(
            replace(t, effects=effects(t, search))
            for t, search in zip(net.transitions, searches, strict=True)
        ),
        roots=roots,
    )


def _changed(
    net: ir.NetIR, t: ir.Transition, fire: tuple[object, ...], reach: Reach
) -> frozenset[int]:
    """The places whose tokens are others after the occurrence: what stays where it is does not count."""
    staying = {
        id(s)
        for position, other in t.staying
        if isinstance(take := t.fire[position], ir.Take)
        and not net.places[take.place].timed
        and reach.is_pure(ir_nodes(take.value))
        for s in (take, t.fire[other])
    }
    moves = [n for n in fire if isinstance(n, _CHANGED) and id(n) not in staying]
    return frozenset(n.place for n in moves)


def _roots(net: ir.NetIR, reach: Reach) -> tuple[str, ...]:
    """The variables that are state besides the marking, in order.

    Those that transitions assign; and if they assign any, or the contents of any cell, all through which cells are
    reached, and all of which the address is known to others.
    """
    programs = (p for t in net.transitions for p in (t.enumerate, t.fire, t.thresholds))
    nodes = reach.all_nodes(node for program in programs for node in reach.nodes(program))
    if not any(map(is_assignment, nodes)):
        return ()
    assigned = {n.name for n in nodes if isinstance(n, ir.SetGlobal) and n.is_reference}
    everywhere = (net.functions, net.globals, net.transitions)
    assigned |= {n.name for n in ir_nodes(everywhere) if isinstance(n, ir.AddressOf)}
    definitions = {d.name: d for d in net.definitions}
    return tuple(
        g.name for g in net.globals if g.name in assigned or holds_reference(definitions, g.type)
    )


def _places(nodes: Iterable[object], kinds: tuple[type, ...]) -> frozenset[int]:
    # The nodes of all `kinds` have a place.
    return frozenset(n.place for n in nodes if isinstance(n, kinds))  # type: ignore[attr-defined]
