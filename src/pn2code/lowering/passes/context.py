"""Which programs need the context: something in them may raise, allocate, or look at the time.

`with_context` writes it into the functions (`needs_context`) and transitions (`search_needs_context` and
`fire_needs_context`).
"""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import Stmt
from pn2code.ir.operations import op_needs_context


def with_context(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds."""
    definitions = {d.name: d for d in net.definitions}
    users = _users(net, definitions)
    return replace(
        net,
        functions=tuple(replace(f, needs_context=f.key in users) for f in net.functions),
        transitions=tuple(
            replace(
                t,
                search_needs_context=_uses_context(
                    _without_wanted(t.enumerate), users, definitions
                ),
                fire_needs_context=_uses_context(t.fire, users, definitions),
            )
            for t in net.transitions
        ),
    )


def _users(net: ir.NetIR, definitions: Mapping[str, ir.Definition]) -> frozenset[str]:
    """The functions that take the context: those that may raise, directly or through what they call."""
    users = {f.key for f in net.functions if f.loops or f.recursive}
    while True:
        more = {
            f.key
            for f in net.functions
            if f.key not in users and _uses_context(f.body, frozenset(users), definitions)
        }
        if not more:
            return frozenset(users)
        users |= more


def _uses_context(
    statements: tuple[Stmt, ...], callees: frozenset[str], definitions: Mapping[str, ir.Definition]
) -> bool:
    """Whether statements need the context: something may raise, allocate, or look at the time."""
    for node in ir_nodes(statements):
        match node:
            case ir.Op() if op_needs_context(node):
                return True
            case ir.FunCall(function=f) if f in callees:
                return True
            case (
                ir.UnlessBind()
                | ir.Raise()
                | ir.RaiseValue()
                | ir.SetContents()
                | ir.NewRef()
                | ir.HasPacket()
                | ir.Packet()
                | ir.ClearError()
                | ir.Ok()
                | ir.HasError()
                | ir.Now()
                | ir.PlaceTokens()
                | ir.Fill()
                | ir.While()
            ):
                return True
            case ir.ForList() | ir.ForCount():
                return True
            case ir.SetGlobal(is_reference=True):
                return True
            case ir.MakeUnion(tag=tag, type=t) if node.argument is not None:
                definition = definitions[t.name]
                assert isinstance(definition, ir.UnionDef)
                if definition.constructors[tag][2]:
                    return True
    return False


def _without_wanted(statements: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
    """The statements that may leave something in the arena: the demands clean up after themselves."""
    out: list[ir.Stmt] = []
    for s in statements:
        if isinstance(s, ir.Wanted):
            out.extend(x for x in s.takes if not isinstance(x, (ir.Take, ir.TakeAll)))
            if s.may_bind:
                out.append(ir.UnlessBind())
        elif isinstance(s, ir.ForTokens):
            out.append(ir.ForTokens(s.place, s.index, _without_wanted(s.body), s.note))
        elif isinstance(s, ir.ForValues):
            out.append(ir.ForValues(s.variable, s.table, _without_wanted(s.body), s.note))
        else:
            out.append(s)
    return tuple(out)
