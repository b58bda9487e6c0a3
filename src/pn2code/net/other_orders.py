"""A net whose conditions are asked in every order that CPN Tools might take: with transitions that only ask.

asked = asking(net)
asked.net                       # the net, with more transitions behind its own; they never occur
asked.questions[i - asked.own]  # what the transition i of it asks, and of which transition

In which order the engine asks the conditions of a transition cannot be told (`guard_order`). An exception is raised in
some order at most where it is raised as soon as the variables that its expression needs have values, whatever the
other conditions are. So for each expression that may raise one, and for each least set of arcs and guard equations that
gives its variables values (of a variable on two arcs either may come first), there is a transition that takes tokens as
these arcs do, computes the expression, and is then impossible. It has the priority of its own transition, is
inhibited as that one, and computes nothing where a place is empty from which that one takes something: CPN Tools looks
at the numbers of tokens first. So it does, where the expression needs a token, at places of which all that is wanted
is known without variables (two arcs from a place, of which one has a variable, do not count), and it binds available
tokens only, and as many of one colour as a constant coefficient demands. All this was found by experiment.

The markings are those of the net. If nothing raises an exception in any of them, nothing does in any order. If
something does, CPN Tools may stop there; it need not.

What would only ask what the transition itself asks, in the order here, is left out.

Arithmetic counts as what may raise an exception where `sizes` (`magnitudes`) allow an Overflow, and does not without
them.

In the same way it is asked whether an equation gives a variable a value outside its colour set (`outside`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Literal

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Span
from pn2code.ml.core.terms import Con, Exp, Lit, Pat, PLit, PVar, PWild, Symbol, Var
from pn2code.ml.core.terms import Sequence as Several
from pn2code.ml.core.types import BOOL, INT
from pn2code.ml.library.datatypes import TRUE
from pn2code.net.conditions import TAKING, Condition, conditions, term_of, texts_of
from pn2code.net.flat import (
    ArcInscription,
    ArcKind,
    BindAll,
    BindEquation,
    BindStep,
    BindTerm,
    FlatArc,
    FlatNet,
    FlatTransition,
    Term,
)
from pn2code.net.magnitudes import Magnitudes, RaisesIn
from pn2code.net.no_match import catches, no_match_places
from pn2code.net.outside import bind_raised, holds, is_restricted, outside
from pn2code.net.raising import Raising
from pn2code.net.terms import TermReader, binary
from pn2code.net.total import is_total
from pn2code.net.uses import NetVariables, pattern_variables

MOST_WAYS = 64
"""Sets of arcs and equations that are looked at for one expression."""
_Names = frozenset[Symbol]


Kind = Literal["order", "outside", "bind"]


@frozen
class Question:
    """What a transition asks that only asks, of another one.

    Args:
        transition: the index of that.
        raises: the expression that is computed.
        condition: the guard or the term that it is a part of.
        kind: what there is to it: `order`, the order in which conditions are asked; `outside`, whether it gives a
            variable a value outside its colour set (`net.outside`); `bind`, whether it raises `Bind` (`net.outside`).
        beside: of `order`, a condition of which it depends here whether it is computed.
    """

    transition: int
    raises: Exp
    condition: Exp
    kind: Kind
    beside: Exp | None = None


@frozen
class Asking:
    """A net and transitions that only ask.

    Args:
        net: both.
        own: how many transitions are those of the net.
        questions: what the others ask, in their order.
        left: what is not asked, since there are too many ways to do so.
    """

    net: FlatNet
    own: int
    questions: tuple[Question, ...]
    left: tuple[Question, ...]

    def question(self, transition: int) -> Question | None:
        """What a transition of `net` asks; None: it is one of the net's own."""
        return self.questions[transition - self.own] if transition >= self.own else None


@frozen
class _Source:
    """What gives variables their values: a term of an arc, a guard equation in one direction, or all values of one."""

    step: BindStep
    binds: _Names
    needs: _Names

    @property
    def term(self) -> tuple[int, int] | None:
        return (self.step.arc, self.step.term) if isinstance(self.step, BindTerm) else None

    @property
    def guard(self) -> int | None:
        return self.step.guard if isinstance(self.step, BindEquation) else None


_Way = tuple[_Source, ...]
"""Sources in an order in which each has what it needs."""


def asking(net: FlatNet, sizes: Magnitudes | None = None) -> Asking | None:
    """The net with what else could be asked; None: no other order asks more. PNML nets have one order only.

    Args:
        net: the net.
        sizes: how large its integers may become, where arithmetic that may raise an Overflow is asked, too.
    """
    if net.file.lower().endswith(".pnml"):
        return None
    uses = NetVariables(net.program.variables)
    maker = _Maker(net, sizes, uses)
    own = len(net.transitions)
    more: list[FlatTransition] = []
    questions: list[Question] = []
    left: list[Question] = []
    for t in net.transitions:
        for found, question in maker.of(t):
            if found is None:
                left.append(question)
                continue
            index = own + len(more)
            name = f"{t.name} (asked {len(more) + 1})"
            more.append(replace(found, index=index, name=name, short=name))
            questions.append(question)
    if not more and not left:
        return None
    whole = replace(net, transitions=(*net.transitions, *more))
    return Asking(whole, own, tuple(questions), tuple(left))


class _Maker:
    def __init__(self, net: FlatNet, sizes: Magnitudes | None, uses: NetVariables) -> None:
        self._net = net
        self._sizes = sizes
        self._plain = Raising(net.program)
        self._raising: RaisesIn = self._plain
        self._uses = uses
        self._reader = TermReader(net.program, uses, Diagnostics())

    def of(self, t: FlatTransition) -> Iterator[tuple[FlatTransition | None, Question]]:
        """A transition for each expression and way; None where there are too many ways."""
        if self._sizes is not None:
            self._raising = self._sizes.raising(t)
        yield from self._raising_of(t)
        yield from self._outside_of(t)

    def _raising_of(self, t: FlatTransition) -> Iterator[tuple[FlatTransition | None, Question]]:
        asked = conditions(t, self._raising, self._uses)
        if not any(c.may_raise for c in asked):
            return
        sources, no_match = list(self._sources(t)), no_match_places(t)
        for i, c in enumerate(asked):
            for e in self._parts(t, c) if c.may_raise else ():
                ways = _ways(self._needed(t, e), sources)
                if ways is None:
                    beside = next(x for x in asked if x is not c)
                    yield None, Question(t.index, e, c.text, "order", beside.text)
                    continue
                for way in ways:
                    hiding = self._hiding(t, asked, i, way)
                    is_tested = (
                        e is t.guards[c.guard]
                        if c.guard is not None
                        else c.term is not None and t.arcs[c.term[0]].place in no_match
                    )
                    may_bind = is_tested and self._plain.raise_in(e)
                    is_open = may_bind and not any(self._catches(t, s) for s in way)
                    if hiding is None and not is_open:
                        continue
                    asks = bind_raised(e) if is_open else e
                    kind: Kind = "bind" if hiding is None else "order"
                    beside_it = None if hiding is None else hiding.text
                    question = Question(t.index, e, c.text, kind, beside_it)
                    yield self._transition(t, way, asks), question

    def _catches(self, t: FlatTransition, s: _Source) -> bool:
        """Whether `Bind` only means to CPN Tools that there is no binding with what a source gives.

        It does where any token is tried, and where an equation binds; not where a token is found by a known part of it.
        """
        if s.term is None:
            return s.guard is not None
        return catches(term_of(t, *s.term).pattern)

    def _outside_of(self, t: FlatTransition) -> Iterator[tuple[FlatTransition | None, Question]]:
        sources: list[_Source] = []
        for i, pattern, value in self._equations(t):
            names = frozenset(pattern_variables(pattern)) & frozenset(t.variables)
            variables = self._restricted(t, names, value)
            needed = self._needed(t, value)
            if not variables or needed & names:
                continue
            sources = sources or list(self._sources(t))
            ways = _ways(needed, [s for s in sources if s.guard != i])
            question = Question(t.index, t.guards[i], t.guards[i], "outside")
            if ways is None:
                yield None, question
                continue
            for way in ways:
                others = self._known_beside(t, i, names.union(*(s.binds for s in way)))
                e = outside(pattern, value, variables, others)
                yield self._transition(t, way, e), question

    def _equations(self, t: FlatTransition) -> Iterator[tuple[int, Pat, Exp]]:
        """The guards that are equations, by number, in each direction in which they may bind variables."""
        for i, guard in enumerate(t.guards):
            sides = binary(guard, ("=",))
            for side, value in (sides, sides[::-1]) if sides is not None else ():
                pattern = self._reader.pattern(side)
                if pattern is not None and pattern_variables(pattern):
                    yield i, pattern, value

    def _restricted(self, t: FlatTransition, names: _Names, value: Exp) -> list[Symbol]:
        """The variables to which an equation might give a value outside their colour sets."""
        found = [s for s in names if is_restricted(s.colset) and not self._is_held(t, s, value)]
        return sorted(found, key=lambda s: s.uid)

    def _known_beside(self, t: FlatTransition, i: int, known: _Names) -> list[Exp]:
        """The guards beside the one of that number that are known, and do not raise an exception."""
        return [
            guard
            for j, guard in enumerate(t.guards)
            if j != i and self._needed(t, guard) <= known and not self._raising.raise_in(guard)
        ]

    def _is_held(self, t: FlatTransition, s: Symbol, value: Exp) -> bool:
        """Whether a value outside is nothing to CPN Tools either: a token with it is wanted, and there is none."""
        if isinstance(value, Var) and value.symbol.colset == s.colset:
            return True
        return any(
            holds(term.pattern, self._net.places[arc.place].colset, s)
            for arc in t.arcs
            if arc.kind in TAKING and arc.inscription is not None
            for term in arc.inscription.terms
        )

    def _needed(self, t: FlatTransition, *texts: Exp | None) -> _Names:
        return frozenset(self._uses.of(*texts)) & frozenset(t.variables)

    def _parts(self, t: FlatTransition, c: Condition) -> list[Exp]:
        """What is computed for a condition and may raise an exception; of an equation that may bind a side alone."""
        if c.guard is not None:
            guard = t.guards[c.guard]
            sides = binary(guard, ("=",)) or ()
            may_bind = any(pattern_variables(self._reader.pattern(side)) for side in sides)
            texts = [*sides] if may_bind else [guard]
        else:
            assert c.term is not None
            term = term_of(t, *c.term)
            texts = texts_of(term)
        return [e for e in texts if self._raising.raise_in(e)]

    def _sources(self, t: FlatTransition) -> Iterator[_Source]:
        for i, arc in enumerate(t.arcs):
            if arc.kind not in TAKING or arc.inscription is None:
                continue
            for j, term in enumerate(arc.inscription.terms):
                names = frozenset(pattern_variables(term.pattern))
                if names:
                    yield _Source(BindTerm(i, j), names, self._needed(t, term.delay) - names)
        for i, pattern, value in self._equations(t):
            names = frozenset(pattern_variables(pattern))
            yield _Source(BindEquation(i, pattern, value), names, self._needed(t, value))
        for step in t.plan:
            if isinstance(step, BindAll):
                yield _Source(step, frozenset({step.symbol}), frozenset())

    def _hiding(
        self, t: FlatTransition, asked: Sequence[Condition], which: int, way: _Way
    ) -> Condition | None:
        """What may keep the transition itself from asking this, or asks it with other values; None: nothing may."""
        terms = {s.term for s in way if s.term is not None}
        guards = {s.guard for s in way if s.guard is not None}
        names = frozenset[Symbol]().union(*(s.binds | s.needs for s in way))
        constant = self._demanded(t, way)
        met: list[tuple[int, int] | int | None] = []
        for c in asked[:which]:
            if c.term in terms or (c.guard is not None and c.guard in guards):
                met.append(c.term if c.term is not None else c.guard)
            elif c.term is not None and t.arcs[c.term[0]].place in constant:
                pass  # it is asked there, too
            elif c.binds & names or c.may_fail or c.may_raise or not self._always_matches(t, c):
                return c
        if terms.union(guards) <= set(met):
            return None
        return next((c for i, c in enumerate(asked) if i != which), None)

    def _always_matches(self, t: FlatTransition, c: Condition) -> bool:
        """Whether a token of a place always does: then it matters only that there is one. An equation does."""
        if c.term is None:
            return True
        term, place = term_of(t, *c.term), self._net.places[t.arcs[c.term[0]].place]
        pattern = term.pattern
        return (
            isinstance(pattern, PVar)
            and pattern.symbol.colset == place.colset
            and not place.colset.timed
            and _constant(term) == 1
        )

    def _transition(self, t: FlatTransition, way: _Way, e: Exp) -> FlatTransition:
        arcs = [a for a in t.arcs if a.kind is ArcKind.INHIBITOR]
        constant = self._demanded(t, way)
        arcs += [_input(a) for a in t.arcs if a.kind in TAKING and a.place in constant]
        places = constant.union(_places(t, way))
        plan: list[BindStep] = []
        tokens: list[Symbol] = []
        for place in self._filled(t):
            if place not in places:
                tokens.append(_token(self._net, place))
                plan.append(BindTerm(len(arcs), 0))
                arcs.append(self._any_token(t, place))
        for s in way:
            if s.term is None:
                plan.append(s.step)
            else:
                plan.append(BindTerm(len(arcs), 0))
                arcs.append(_taking(t, *s.term))
        true = Con(TRUE, BOOL, e.span)
        # The equations of the way keep their numbers; then the expression is computed, and matches nothing.
        last = len(t.guards)
        plan.append(BindEquation(last, PWild(e.type, e.span), e))
        plan.append(BindEquation(last + 1, PLit(1, INT, e.span), Lit(0, INT, e.span)))
        bound = frozenset[Symbol]().union(*(s.binds for s in way))
        return replace(
            t,
            variables=(*(s for s in t.variables if s in bound), *tokens),
            guards=(true,) * (last + 2),
            plan=tuple(plan),
            arcs=tuple(arcs),
            delay=None,
            code=None,
        )

    def _demanded(self, t: FlatTransition, way: _Way) -> frozenset[int]:
        """The places that are looked at before any token is taken for a way."""
        places = _places(t, way)
        return self._constant(t) - places if places else frozenset()

    def _constant(self, t: FlatTransition) -> frozenset[int]:
        """The places of which all that is wanted is known without variables, and does not raise an exception."""
        own, others = set[int](), set[int]()
        for arc in t.arcs:
            if arc.kind in TAKING and arc.inscription is not None:
                texts = [e for x in arc.inscription.terms for e in texts_of(x)]
                is_known = all(map(is_total, texts)) and not (
                    self._needed(t, *texts) or any(map(self._raising.raise_in, texts))
                )
                (own if is_known else others).add(arc.place)
        return frozenset(own - others)

    def _filled(self, t: FlatTransition) -> list[int]:
        """The places that have to hold something, whatever the variables are; stamps do not matter."""
        return list(
            dict.fromkeys(
                a.place
                for a in t.arcs
                if a.kind in TAKING
                and a.inscription is not None
                and not self._net.places[a.place].colset.timed
                and any(not x.whole and _constant(x) >= 1 for x in a.inscription.terms)
            )
        )

    def _any_token(self, t: FlatTransition, place: int) -> FlatArc:
        arc = next(a for a in t.arcs if a.place == place and a.kind in TAKING)
        assert arc.inscription is not None
        token, span = _token(self._net, place), arc.inscription.value.span
        value, pattern = Var(token, token.type, span), PVar(token, token.type, span)
        return _with_term(arc, Term(_one(span), pattern, value, None, False, arc.origin))


def _ways(needed: _Names, sources: Sequence[_Source]) -> list[_Way] | None:
    """The least sets of sources that give variables values, each in an order; None: too many."""
    found: dict[frozenset[int], _Way] = {}
    stack: list[tuple[_Names, frozenset[int]]] = [(needed, frozenset())]
    seen: set[frozenset[int]] = set()
    while stack:
        open_, chosen = stack.pop()
        if not open_:
            way = _ordered([sources[i] for i in sorted(chosen)])
            if way is not None:
                found[chosen] = way
            continue
        name = min(open_, key=lambda s: (s.name, s.uid))
        for i, source in enumerate(sources):
            with_it = chosen | {i}
            if name not in source.binds or i in chosen or with_it in seen:
                continue
            seen.add(with_it)
            if len(seen) > MOST_WAYS:
                return None
            bound = frozenset[Symbol]().union(*(sources[j].binds for j in with_it))
            stack.append(((open_ | source.needs) - bound, with_it))
    return [way for ids, way in found.items() if not any(other < ids for other in found)]


def _ordered(sources: Sequence[_Source]) -> _Way | None:
    """In an order in which each has what it needs; None: there is none."""
    known: set[Symbol] = set()
    left, way = list(sources), list[_Source]()
    while left:
        ready = next((s for s in left if s.needs <= known), None)
        if ready is None:
            return None
        left.remove(ready)
        way.append(ready)
        known |= ready.binds
    return tuple(way)


def _places(t: FlatTransition, way: _Way) -> set[int]:
    return {t.arcs[s.term[0]].place for s in way if s.term is not None}


def _token(net: FlatNet, place: int) -> Symbol:
    """A variable for any token of a place; no other one has this number."""
    colset = net.places[place].colset
    return Symbol(-1 - place, f"token{place}", colset.type, colset=colset)


def _taking(t: FlatTransition, arc: int, index: int) -> FlatArc:
    """An arc that takes one term of another one; what several want together of a place is never asked."""
    term = term_of(t, arc, index)
    value = Several((term.value,), term.value.type, term.value.span)
    coefficient = term.coefficient if _constant(term) >= 0 else _one(term.value.span)
    return _with_term(t.arcs[arc], replace(term, coefficient=coefficient, value=value))


def _with_term(arc: FlatArc, term: Term) -> FlatArc:
    assert arc.inscription is not None
    inscription = ArcInscription(
        arc.inscription.value, arc.inscription.form, (term,), arc.inscription.origin
    )
    return replace(arc, kind=ArcKind.INPUT, inscription=inscription)


def _input(arc: FlatArc) -> FlatArc:
    return replace(arc, kind=ArcKind.INPUT)


def _constant(term: Term) -> int:
    """The coefficient; -1: it has to be computed."""
    c = term.coefficient
    return c.value if isinstance(c, Lit) and isinstance(c.value, int) else -1


def _one(span: Span) -> Lit:
    return Lit(1, INT, span)
