"""What a transition does when it fires, as statements."""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, Stmt
from pn2code.lowering.expressions.body import Body
from pn2code.lowering.expressions.clock import clock, in_clock, plus
from pn2code.lowering.expressions.functions import Program
from pn2code.lowering.expressions.values import Binding
from pn2code.lowering.nets.inscriptions import Putter
from pn2code.lowering.nets.taking import TAKING, arc_note, take_terms
from pn2code.net.flat import ArcKind, FlatNet, FlatTransition

_PUTTING = (ArcKind.OUTPUT, ArcKind.BOTH)


def firing(
    program: Program, net: FlatNet, t: FlatTransition, variables: tuple[ir.Variable, ...]
) -> tuple[Stmt, ...]:
    """Code segment, takes, delay, puts, resets: the order in which CPN Tools works things out."""
    body = Body(program)
    env: dict[int, Binding] = {
        s.uid: ir.Bound(i, variables[i].type, s.name) for i, s in enumerate(t.variables)
    }
    if t.code is not None:
        _code_segment(body, t, env)
    for arc in t.arcs:
        if arc.kind in TAKING:
            take_terms(program, net, body, arc, env)
    delay: Ir | None = None
    is_timed = any(net.places[a.place].colset.timed for a in t.arcs if a.kind in _PUTTING)
    if t.delay is not None and is_timed:
        body.emit(ir.Note(f"delay @+{t.delay.span.text}"))
        delay = body.atomic(in_clock(program.real_time, body.ir(t.delay, env)), "delay")
    for arc in t.arcs:
        if arc.kind in _PUTTING:
            assert arc.inscription is not None
            timed = net.places[arc.place].colset.timed
            stamp: Ir | None = None
            if timed:
                now = ir.Now(clock(program.real_time))
                stamp = now if delay is None else plus(now, delay)
            note = arc_note(net, arc)
            form = arc.inscription.form
            Putter(body, arc.place, env, stamp, delay, note).put(arc.inscription.value, form)
    for arc in t.arcs:
        if arc.kind is ArcKind.RESET:
            body.emit(ir.Reset(arc.place, arc_note(net, arc)))
    return tuple(body.statements)


def _code_segment(body: Body, t: FlatTransition, env: dict[int, Binding]) -> None:
    code = t.code
    assert code is not None
    index = {s.uid: i for i, s in enumerate(t.variables)}
    text = " ".join(code.action.span.text.split())
    body.emit(ir.Note(f"code segment: action {text}"))
    if not code.outputs:
        body.effect(code.action, env)
        return
    value = body.exp(code.action, env)
    parts = [value] if len(code.outputs) == 1 else body.components(value, len(code.outputs))
    for symbol, part in zip(code.outputs, parts, strict=True):
        body.emit(ir.Bind(index[symbol.uid], body.code(part)))
