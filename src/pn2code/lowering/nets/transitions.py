"""One transition as two programs: enumerate its enabled bindings, fire one of them."""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.lowering.expressions.functions import Program
from pn2code.lowering.nets.enumeration import Enumeration, Thresholds
from pn2code.lowering.nets.firing import firing
from pn2code.lowering.nets.taking import name_on_page
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet, FlatTransition


def lower_transition(
    program: Program, net: FlatNet, t: FlatTransition, owner: int
) -> ir.Transition:
    """Lower one transition instance."""
    outputs = set(t.code.outputs) if t.code else set()
    variables = tuple(
        ir.Variable(s.name, program.types.lower(s.type), _table(program, s), s in outputs)
        for s in t.variables
    )
    return ir.Transition(
        index=t.index,
        name=t.name,
        id=t.id,
        origin=t.origin,
        owner=owner,
        priority=t.priority,
        variables=variables,
        enumerate=Enumeration(program, net, t, variables).run(),
        fire=firing(program, net, t, variables),
        guard_text=", ".join(g.span.text for g in t.guards),
        thresholds=Thresholds(program, net, t, variables).run(),
        places=tuple({a.place: name_on_page(net, a) for a in reversed(t.arcs)}.items()),
    )


def _table(program: Program, symbol: Symbol) -> str:
    if symbol.colset is not None:
        return program.types.colset(symbol.colset)
    return program.types.plain(program.types.lower(symbol.type))
