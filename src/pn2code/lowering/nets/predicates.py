"""Conditions on markings -> IR: functions beside the net, for hosts that explore it.

{ length (Mark.Top'Free 1) > 2 }     return total of Free > 2
{ List.all p (Mark.Top'Busy 1) }     let Busy = tokens of Busy; return all_1(cx, Busy)
"""

from __future__ import annotations

from typing import TypeVar

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.lowering.codes import OUTSIDE_MARKING, UnsupportedError
from pn2code.lowering.expressions.body import Body
from pn2code.lowering.expressions.functions import Program
from pn2code.lowering.expressions.values import Binding
from pn2code.ml.core import terms as core
from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate, marking_type

T = TypeVar("T")

_COUNTS = frozenset({"List.length", "Ms.size"})
_OUTSIDE = frozenset({"Ms.random", "Colset.ran", "Time.step"})
_OUTSIDE_PREFIXES = ("Random.", "TextIO.", "OS.", "BinIO.", "prim.do_file", "prim.do_random")


def lower_predicate(program: Program, net: FlatNet, p: Predicate) -> ir.Predicate:
    """A condition as a function of a marking.

    Raises:
        UnsupportedError: it asks for more than the marking, or for what cannot be compiled.
    """
    if program.reaches(p.exp, _is_outside):
        raise UnsupportedError(
            OUTSIDE_MARKING,
            f"property `{p.name}` looks at more than the marking",
            p.exp.span,
            hint="do without random numbers, files and `step ()`",
        )
    body = Body(program)
    env: dict[int, Binding] = {}
    lists: dict[int, ir.PlaceTokens] = {}
    for symbol, place in p.places:
        t = program.types.lower(marking_type(net.places[place]))
        local = body.local(symbol.name, t)
        tokens = ir.PlaceTokens(place, t, program.types.plain(t))
        lists[local.uid] = tokens
        body.emit(ir.Let(local, tokens))
        env[symbol.uid] = ir.Use(local)
    body.emit(ir.Return(body.ir(p.exp, env)))
    statements = _counted(tuple(body.statements), lists)
    used = {n.local.uid for n in ir_nodes(statements) if isinstance(n, ir.Use)}
    return ir.Predicate(
        p.name,
        p.text,
        tuple(
            s
            for s in statements
            if not (isinstance(s, ir.Let) and s.local.uid in lists and s.local.uid not in used)
        ),
        p.exp.span.origin,
    )


def _counted(node: T, lists: dict[int, ir.PlaceTokens]) -> T:
    """With lengths of the lists of places as numbers of tokens, so that nobody makes a list to count it."""
    match node:
        case ir.Op(name=name, arguments=(ir.Use(local=local),)) if (
            name in _COUNTS and local.uid in lists
        ):
            return ir.PlaceTotal(lists[local.uid].place)  # type: ignore[return-value]  # a node in the place of a node
        case tuple():
            # A tuple takes the place of a tuple.
            return tuple(_counted(part, lists) for part in node)  # type: ignore[return-value]
    fields = getattr(node, "__dataclass_fields__", None)
    if not fields:
        return node
    before = {name: getattr(node, name) for name in fields}
    after = {name: _counted(value, lists) for name, value in before.items()}
    changed = {name: value for name, value in after.items() if value is not before[name]}
    return replace(node, **changed) if changed else node


def _is_outside(e: core.Exp) -> bool:
    """Whether an expression, its parts not included, asks for what neither places nor references hold."""
    return isinstance(e, core.Builtin) and (
        e.name in _OUTSIDE or e.name.startswith(_OUTSIDE_PREFIXES)
    )
