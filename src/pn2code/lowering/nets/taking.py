"""What an input arc takes, as statements, with a note of which arc it is."""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir
from pn2code.lowering.expressions.body import Body
from pn2code.lowering.expressions.clock import accepted, clock
from pn2code.lowering.expressions.functions import Program
from pn2code.lowering.expressions.values import Env
from pn2code.lowering.nets import arc_lists
from pn2code.ml.core import terms as core
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, Term

TAKING = (ArcKind.INPUT, ArcKind.BOTH)


def limit_of(
    program: Program, body: Body, delay: core.Exp | None, env: Env, timed: bool
) -> Ir | None:
    """The latest stamp that a term of an input arc accepts."""
    if not timed:
        return None
    if delay is None:
        return ir.Now(clock(program.real_time))
    return accepted(program.real_time, body.ir(delay, env))


def take_terms(
    program: Program,
    net: FlatNet,
    body: Body,
    arc: FlatArc,
    env: Env,
    terms: list[Term] | None = None,
) -> None:
    """Emit what an arc takes (all its terms, or some)."""
    assert arc.inscription is not None
    timed = net.places[arc.place].colset.timed
    note = arc_note(net, arc)
    for term in arc.inscription.terms if terms is None else terms:
        limit = limit_of(program, body, term.delay, env, timed)
        if term.whole:
            multiset = arc_lists.multiset(body, term.value, env)
            table = program.types.plain(multiset.type)
            body.emit(ir.TakeAll(arc.place, multiset, table, limit, note))
        else:
            count = body.ir(term.coefficient, env)
            value = body.addressable(body.ir(term.value, env), "token")
            body.emit(ir.Take(arc.place, count, value, limit, note))
        note = ""


def arc_note(net: FlatNet, arc: FlatArc) -> str:
    """`Buffer: 1`n (ID1414)`."""
    place = name_on_page(net, arc)
    text = arc.inscription.value.span.source.text if arc.inscription is not None else arc.kind.value
    return f"{place}: {text.strip()} ({arc.id})"


def name_on_page(net: FlatNet, arc: FlatArc) -> str:
    """What the place of an arc is called on the page of the arc."""
    return arc.place_name or net.places[arc.place].name.rsplit(".", 1)[-1]


def parts(term: Term) -> list[core.Exp]:
    """The expressions of a term of an input arc."""
    return [term.coefficient, term.value] + ([term.delay] if term.delay is not None else [])
