"""Flat nets made by a program: places, transitions and arcs without a file behind them.

b = Builder(net)                                   # or Builder.empty("protocol")
calm = b.place("medium.supervisor.calm", b.unit, b.dot)
b.transition("medium.supervisor.rest", [b.take(calm, b.dot), b.put(calm, b.dot)], priority=3)
made = b.net()
"""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.base.frozen import frozen, replace
from pn2code.base.unused_name import unused_name
from pn2code.diagnostics import Diagnostics, Origin, SourceText, Span
from pn2code.ml.core import types
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Apply, Builtin, Con, Exp, If, Lit, RecordExp, Symbol, Var
from pn2code.ml.elaborate import Elaborator
from pn2code.ml.library.datatypes import DATATYPES
from pn2code.net.binding import Parts, Planner
from pn2code.net.flat import (
    ArcInscription,
    ArcKind,
    FlatArc,
    FlatNet,
    FlatPlace,
    FlatTransition,
    Form,
    PlaceInstance,
    Term,
)
from pn2code.net.terms import TermReader
from pn2code.net.uses import NetVariables

PAGE = "Medium"
"""The page that the new places and transitions are on."""


@frozen
class Arc:
    """An arc to be: `value` is None for inhibitor and reset arcs."""

    kind: ArcKind
    place: int
    value: Exp | None = None
    form: Form = Form.TOKEN


@frozen
class _Wanted:
    name: str
    arcs: tuple[Arc, ...]
    guards: tuple[Exp, ...]
    priority: int


class Builder:
    """Adds to a net. Transitions that are there can be given more arcs (`add_arcs`)."""

    def __init__(self, base: FlatNet) -> None:
        self._base = base
        self.places: list[FlatPlace] = list(base.places)
        self.old: list[FlatTransition] = list(base.transitions)
        self._place_names = {p.name for p in base.places}
        self._names = {t.name for t in base.transitions}
        self._wanted: dict[str, _Wanted] = {}
        self._origin = Origin(base.file, page=PAGE)
        self._colsets = dict(base.program.colsets)
        self._variables = dict(base.program.variables)
        self._uid = max([1 << 20, *(s.uid for s in self._variables.values())])
        self._made: dict[tuple[str, str], Symbol] = {}
        self.unit = self._colset(Colset("MEDIUM", Kind.UNIT, types.UNIT))
        self.int = self._colset(Colset("NUMBER", Kind.INT, types.INT))
        self.dot: Exp = RecordExp((), types.UNIT, self._span("()"))

    @staticmethod
    def empty(name: str, file: str) -> Builder:
        """Of a net with nothing in it."""
        program = Elaborator(Diagnostics()).program()
        return Builder(FlatNet(name, file, "", program, (), (), False, False))

    # --- colour sets, variables, expressions -----------------------------------------------------

    def _colset(self, c: Colset) -> Colset:
        name = unused_name(c.name, self._colsets)
        made = replace(c, name=name, origin=self._origin)
        self._colsets[name] = made
        return made

    def product(self, name: str, *parts: Colset) -> Colset:
        """A new colour set of tuples."""
        t = types.tuple_of(*(p.type for p in parts))
        return self._colset(Colset(name, Kind.PRODUCT, t, components=parts))

    def var(self, name: str, colset: Colset) -> Exp:
        """A variable of a colour set; the same for the same name and colour set."""
        symbol = self._made.get((name, colset.name))
        if symbol is None:
            self._uid += 1
            shown = unused_name(name, self._variables)
            symbol = Symbol(self._uid, shown, colset.type, colset=colset)
            self._made[name, colset.name] = symbol
            self._variables[shown] = symbol
        return Var(symbol, symbol.type, self._span(symbol.name))

    def truth_values(self, name: str) -> Colset:
        """A new colour set of truth values."""
        return self._colset(Colset(name, Kind.BOOL, types.BOOL, names=("false", "true")))

    def truth(self, value: bool) -> Exp:
        """`true` or `false`."""
        name = "true" if value else "false"
        constructor = next(c for c, _ in DATATYPES["bool"].constructors if c.name == name)
        return Con(constructor, types.BOOL, self._span(name))

    def number(self, n: int) -> Exp:
        """A constant."""
        return Lit(n, types.INT, self._span(str(n)))

    def pair(self, *parts: Exp) -> Exp:
        """A tuple."""
        fields = tuple((str(i), p) for i, p in enumerate(parts, 1))
        text = ", ".join(p.span.text for p in parts)
        return RecordExp(fields, types.tuple_of(*(p.type for p in parts)), self._span(f"({text})"))

    def less(self, a: Exp, b: Exp) -> Exp:
        """`a < b`."""
        return self._operator("<", a, b, types.BOOL)

    def plus(self, a: Exp, b: Exp) -> Exp:
        """`a + b`."""
        return self._operator("+", a, b, types.INT)

    def choice(self, condition: Exp, then: Exp, otherwise: Exp) -> Exp:
        """`if condition then .. else ..`."""
        text = f"if {condition.span.text} then {then.span.text} else {otherwise.span.text}"
        return If(condition, then, otherwise, then.type, self._span(text))

    def _operator(self, sign: str, a: Exp, b: Exp, result: types.Type) -> Exp:
        pair = types.tuple_of(types.INT, types.INT)
        span = self._span(f"{a.span.text} {sign} {b.span.text}")
        function = Builtin(f"Int.{sign}", types.TFun(pair, result), span)
        return Apply(function, RecordExp((("1", a), ("2", b)), pair, span), result, span)

    def _span(self, text: str) -> Span:
        return Span(SourceText(text, self._origin), 0, len(text))

    # --- places and transitions ------------------------------------------------------------------

    def place(self, name: str, colset: Colset, initial: Exp | None = None) -> int:
        """A new place, with one token or none; its index. Its name is made unique."""
        index = len(self.places)
        name = unused_name(name, self._place_names, "{} ({})")
        self._place_names.add(name)
        self.places.append(
            FlatPlace(
                index=index,
                name=name,
                short=name,
                page=PAGE,
                instance=PAGE,
                instance_number=1,
                id=f"medium-place-{index}",
                colset=colset,
                initial=None if initial is None else (initial, Form.TOKEN),
                origins=(replace(self._origin, element=f"place `{name}`"),),
            )
        )
        return index

    def begin(self, place: int, value: Exp) -> None:
        """Gives a place a token at the beginning."""
        self.places[place] = replace(self.places[place], initial=(value, Form.TOKEN))

    def forget_initial(self, place: int) -> tuple[Exp, Form] | None:
        """A place begins empty; what its initial marking was."""
        found = self.places[place].initial
        self.places[place] = replace(self.places[place], initial=None)
        return found

    @staticmethod
    def take(place: int, value: Exp) -> Arc:
        """An input arc."""
        return Arc(ArcKind.INPUT, place, value)

    @staticmethod
    def put(place: int, value: Exp, form: Form = Form.TOKEN) -> Arc:
        """An output arc."""
        return Arc(ArcKind.OUTPUT, place, value, form)

    @staticmethod
    def test(place: int, value: Exp) -> Arc:
        """Takes and puts back."""
        return Arc(ArcKind.BOTH, place, value)

    @staticmethod
    def absent(place: int) -> Arc:
        """An inhibitor arc."""
        return Arc(ArcKind.INHIBITOR, place)

    @staticmethod
    def empties(place: int) -> Arc:
        """A reset arc."""
        return Arc(ArcKind.RESET, place)

    def transition(
        self, name: str, arcs: Sequence[Arc], *, priority: int, guards: Sequence[Exp] = ()
    ) -> str:
        """A new transition; its name, which is made unique."""
        shown = unused_name(name, self._names, "{} ({})")
        self._names.add(shown)
        self._wanted[shown] = _Wanted(shown, tuple(arcs), tuple(guards), priority)
        return shown

    def net(self) -> FlatNet:
        """The net as it is now.

        Raises:
            ValueError: nothing binds a variable of a new transition.
        """
        program = replace(self._base.program, colsets=self._colsets, variables=self._variables)
        variables = NetVariables(program.variables)
        d = Diagnostics()
        terms = TermReader(program, variables, d)
        planner = Planner(variables, terms, frozenset(), d)
        transitions = list(self.old)
        for wanted in self._wanted.values():
            index = len(transitions)
            arcs = tuple(
                self._arc(terms, wanted.name, f"{index}.{i}", arc)
                for i, arc in enumerate(wanted.arcs)
            )
            name = wanted.name
            origin = replace(self._origin, element=f"transition `{name}`")
            taken = [(a.kind, a.inscription) for a in arcs]
            parts = Parts(name, origin, taken, wanted.guards, None, None, None)
            planned = planner.plan(parts)
            if planned is None:
                raise ValueError("; ".join(i.message for i in d.sorted()))
            transitions.append(
                FlatTransition(
                    index=index,
                    name=name,
                    short=name,
                    page=PAGE,
                    instance=PAGE,
                    instance_number=1,
                    id=f"medium-transition-{index}",
                    variables=planned[0],
                    guards=wanted.guards,
                    plan=planned[1],
                    arcs=arcs,
                    delay=None,
                    code=None,
                    priority=wanted.priority,
                    origin=origin,
                    caption=name,
                )
            )
        instances = [
            PlaceInstance(p.id, p.short, p.page, p.instance, 1, p.index, p.short)
            for p in self.places[len(self._base.places) :]
        ]
        return replace(
            self._base,
            program=program,
            places=tuple(self.places),
            transitions=tuple(transitions),
            place_instances=(*self._base.place_instances, *instances),
        )

    def add_arcs(self, transition: int, arcs: Sequence[Arc], redirect: dict[int, int]) -> None:
        """Gives a transition of the net more arcs; `redirect`: other places for its input arcs."""
        t = self.old[transition]
        moved = tuple(
            replace(a, place=redirect.get(a.place, a.place)) if a.kind is ArcKind.INPUT else a
            for a in t.arcs
        )
        added = []
        for i, arc in enumerate(arcs):
            # A test or a plain token: binds nothing, so the plan stays.
            added.append(self._arc(None, t.name, f"medium-{transition}.{i}", arc))
        self.old[transition] = replace(t, arcs=(*moved, *added))

    def _arc(self, terms: TermReader | None, name: str, at: str, arc: Arc) -> FlatArc:
        origin = replace(self._origin, element=f"arc of `{name}`")
        inscription = None
        if arc.value is not None:
            found: tuple[Term, ...] | None = ()
            if arc.kind is not ArcKind.OUTPUT:
                one = Lit(1, types.INT, self._span("1"))
                found = (
                    (Term(one, None, arc.value, None, arc.form is Form.MULTISET, origin),)
                    if terms is None
                    else terms.terms(arc.value, arc.form)
                )
            inscription = ArcInscription(arc.value, arc.form, found or (), origin)
        return FlatArc(f"medium-arc-{at}", arc.kind, arc.place, inscription, origin)
