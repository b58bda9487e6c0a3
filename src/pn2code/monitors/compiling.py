"""Breakpoints and data collectors with functions, made part of the net, so that they are compiled with it.

    found = Instrumented.of(net, program, breakpoints=True)     # None: the token game has to watch
    found.net                                                   # with a place for each such monitor
    found.places                                                # which monitor looks at which place

Each transition that such a monitor watches gets an output arc to a place of its own: a token comes there when the
predicate is true of the binding element, for a data collector the number that it observes. Output arcs are evaluated
after the code segment, so references are what they are after the occurrence, as for a monitor. Only functions are taken
that do nothing besides giving a value, and that look at no marking: those of places are what they are after the
occurrence.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.colsets import Kind as ColsetKind
from pn2code.ml.core.types import INT, REAL, UNIT, TCon, label_key, record
from pn2code.monitors.functions import Checked, MonitorProgram, constructor
from pn2code.monitors.kinds import Kind
from pn2code.net.flat import (
    ArcInscription,
    ArcKind,
    FlatArc,
    FlatNet,
    FlatPlace,
    FlatTransition,
    Form,
)
from pn2code.semantics.evaluation.effects import Effect, Effects
from pn2code.semantics.evaluation.used_symbols import variables


@frozen
class Instrumented:
    """A net with monitors in it.

    Args:
        net: places and transitions of the net keep their numbers; the new places come after them.
        places: by id of the monitor the place that gets a token when it sees something.
    """

    net: FlatNet
    places: dict[str, int]

    @staticmethod
    def of(net: FlatNet, program: MonitorProgram, *, breakpoints: bool) -> Instrumented | None:
        """With all breakpoints and data collectors that have functions; None when there is none, or one that cannot be
        compiled."""
        kinds = {Kind.DATA_COLLECTION, *([Kind.BREAKPOINT] if breakpoints else [])}
        wanted = [c for c in program.monitors if c.monitor.kind in kinds]
        if not wanted or any(not c.tokens for c in wanted):
            return None
        roots = {s for c in wanted for s in c.tokens.values()}
        declarations = tuple(_reached(program.declarations, roots))
        used = {s for dec in declarations for s in variables(dec)}
        if used & set(program.statistics):
            return None
        data = [d for d in program.declarations if isinstance(d, core.DatatypeDec)]
        datatypes = {**net.program.datatypes, **{d.name: d for d in data}}
        if len(datatypes) != len(net.program.datatypes) + len(data):
            return None  # two of one name
        whole = replace(
            net.program,
            declarations=(*net.program.declarations, *declarations),
            datatypes=datatypes,
        )
        effects = Effects(whole)
        if any(effects.of(dec) - {Effect.READ, Effect.COUNT} for dec in declarations):
            return None
        places, transitions, own = list(net.places), list(net.transitions), {}
        for c in wanted:
            at = len(places)
            own[c.monitor.id] = at
            places.append(_place(at, c, net))
            watched = {t.id for t in c.monitor.transitions}
            transitions = [
                replace(t, arcs=(*t.arcs, _arc(at, c, t))) if t.id in watched else t
                for t in transitions
            ]
        changed = replace(net, program=whole, places=tuple(places), transitions=tuple(transitions))
        return Instrumented(changed, own)


def _reached(declarations: Sequence[core.Dec], roots: set[core.Symbol]) -> Iterable[core.Dec]:
    """Those that some symbols need, in their order."""
    needed, taken = set(roots), set()
    for number in range(len(declarations) - 1, -1, -1):  # what is used stands before its use
        dec = declarations[number]
        if needed & variables(dec):
            taken.add(number)
            needed |= variables(dec)
    return (dec for number, dec in enumerate(declarations) if number in taken)


_COLOURS = {
    "unit": Colset("CPN'UNIT", ColsetKind.UNIT, UNIT, names=("()",)),
    "int": Colset("CPN'INT", ColsetKind.INT, INT),
    "real": Colset("CPN'REAL", ColsetKind.REAL, REAL),
}
"""Colour sets of the new places, where the net has none of the kind."""


def _colours(checked: Checked) -> Colset:
    return _COLOURS[checked.observed if checked.monitor.kind is Kind.DATA_COLLECTION else "unit"]


def _colset(wanted: Colset, net: FlatNet) -> Colset:
    """One without time and bounds; the net's own, if it has it."""
    same = (c for c in net.program.colsets.values() if c.kind is wanted.kind and not c.timed)
    return next((c for c in same if c.low is None and c.high is None), wanted)


def _place(index: int, checked: Checked, net: FlatNet) -> FlatPlace:
    monitor = checked.monitor
    name = f"monitor {monitor.name}"
    colset = _colset(_colours(checked), net)
    return FlatPlace(
        index, f"{name} {index}", name, "", "", 1, monitor.id, colset, None, (monitor.origin,)
    )


def _arc(place: int, checked: Checked, t: FlatTransition) -> FlatArc:
    symbol = checked.tokens[constructor(t)]
    origin = checked.monitor.origin
    span = t.guards[0].span if t.guards else _span(checked)
    names = sorted(
        (s for s in t.variables if s.colset is not None), key=lambda s: label_key(s.name)
    )
    own = record({s.name: s.type for s in names}) if names else UNIT
    values = core.RecordExp(tuple((s.name, core.Var(s, s.type, span)) for s in names), own, span)
    pair = core.RecordExp(
        (("1", core.Lit(t.instance_number, INT, span)), ("2", values)),
        record({"1": INT, "2": own}),
        span,
    )
    tokens = TCon("list", (_colours(checked).type,))
    value = core.Apply(core.Var(symbol, symbol.type, span), pair, tokens, span)
    inscription = ArcInscription(value, Form.MULTISET, (), origin)
    return FlatArc(f"{checked.monitor.id}.{t.index}", ArcKind.OUTPUT, place, inscription, origin)


def _span(checked: Checked) -> Span:
    assert checked.span is not None
    return checked.span
