"""The search for bindings: the steps of a transition's plan, one after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from pn2code.ml.core.terms import Pat, Symbol
from pn2code.net.flat import (
    BindAll,
    BindEquation,
    BindRandom,
    BindTerm,
    FlatArc,
    FlatNet,
    FlatTransition,
)
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.evaluation.matching import match
from pn2code.semantics.evaluation.random import bindings_of
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.demands import Demands, Found
from pn2code.semantics.game.errors import NoMatchError, running
from pn2code.semantics.game.marking import Binding, BindingElement, Marking, PlaceMarking
from pn2code.semantics.values.data import MlException, Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet

Accept = Callable[[Symbol, Value], bool]
"""Whether a variable may have a value: narrows a search."""


class BindingSearch(Demands):
    """Searches bindings of the transitions of a net.

    Attributes:
        constants: the declared values that patterns of the net name, by symbol; each search begins with them.
    """

    def __init__(self, net: FlatNet, evaluator: Evaluator) -> None:
        super().__init__(net, evaluator)
        self.constants: Found = {
            s.uid: evaluator.globals[s.uid]
            for t in net.transitions
            for pattern in _patterns(t)
            for s in variables(pattern)
            if s.uid in evaluator.globals
        }
        self._in_order: dict[int, tuple[PlaceMarking, list[Value]]] = {}

    def bindings(
        self,
        t: FlatTransition,
        marking: Marking,
        *,
        ignore_stamps: bool = False,
        accept: Accept | None = None,
        wanting: bool = False,
    ) -> Iterator[Binding]:
        """The bindings with which the guard is true and each pattern has an available token, without repetition.

        Whether the tokens suffice for all arcs together is not known yet.

        Args:
            t: the transition.
            marking: tokens and time.
            ignore_stamps: as if all tokens were available.
            accept: only bindings all of whose values it accepts.
            wanting: leave out those for which a place lacks what is known to be wanted before the last step.

        Raises:
            GameError: an inscription raised an exception.
        """
        self.evaluator.now = marking.time
        self.evaluator.random.start(self.evaluator.steps, bindings_of(t.index))
        seen: set[BindingElement] = set()
        for found in self._search(t, marking, 0, self.constants, ignore_stamps, accept, wanting):
            binding = {s: found[s.uid] for s in t.variables if s.uid in found}
            element = BindingElement.make(t, binding)
            if element not in seen:
                seen.add(element)
                yield binding

    def _search(
        self,
        t: FlatTransition,
        marking: Marking,
        position: int,
        found: Found,
        free: bool,
        accept: Accept | None,
        wanting: bool,
    ) -> Iterator[Found]:
        """Takes the steps of the plan from `position` on."""
        if not self._guards_hold(t, position, found):
            return
        if position == len(t.plan):
            yield found
            return
        if wanting:
            for place in self._order.early(t)[position]:
                if not self._suffices(t, marking, place, found):
                    return
        match t.plan[position]:
            case BindTerm(arc, term):
                choices = self._match_tokens(t, t.arcs[arc], term, marking, found, free)
            case BindEquation(guard, pattern, value):
                choices = self._match_equation(t, guard, pattern, value, found)
            case BindAll(symbol) | BindRandom(symbol):
                choices = self._match_all(t, symbol, found)
        for choice in choices:
            new = [s for s in t.variables if s.uid in choice and s.uid not in found]
            if accept is not None and not all(accept(s, choice[s.uid]) for s in new):
                continue
            if self._are_legal(t, new, choice):
                yield from self._search(t, marking, position + 1, choice, free, accept, wanting)

    def _match_tokens(
        self,
        t: FlatTransition,
        arc: FlatArc,
        index: int,
        marking: Marking,
        found: Found,
        free: bool,
    ) -> Iterator[Found]:
        assert arc.inscription is not None
        term = arc.inscription.terms[index]
        tokens = marking.places[arc.place]
        assert term.pattern is not None
        for value in self._colours_in(arc.place, tokens):
            choice = dict(found)
            if not match(term.pattern, value, choice):
                continue
            if not free and isinstance(tokens, TimedMultiSet):
                earliest = tokens.stamps[value][0]
                try:
                    if earliest - self._advance(t, arc, term, choice) > marking.time:
                        continue
                except NoMatchError:
                    continue
            yield choice

    def matching(self, t: FlatTransition, marking: Marking, place: int) -> Iterator[Binding]:
        """What the patterns of a place's arcs give by themselves, whatever the other places hold."""
        for step in t.plan:
            if isinstance(step, BindTerm) and t.arcs[step.arc].place == place:
                arc = t.arcs[step.arc]
                start = self.constants
                for found in self._match_tokens(t, arc, step.term, marking, start, True):
                    own = {s: found[s.uid] for s in t.variables if s.uid in found}
                    if self._are_legal(t, list(own), found):
                        yield own

    def _colours_in(self, place: int, tokens: PlaceMarking) -> list[Value]:
        """The different colours that a place holds, in order; asked again and again while it holds the same."""
        before, found = self._in_order.get(place, (None, []))
        if before is not tokens:
            values = tokens.counts if isinstance(tokens, MultiSet) else tokens.stamps
            found = self.colours.sorted(self.net.places[place].colset, values)
            self._in_order[place] = tokens, found
        return found

    def _match_equation(
        self, t: FlatTransition, guard: int, pattern: Pat, value: Any, found: Found
    ) -> Iterator[Found]:
        with running(t.origin, f"the guard of `{t.name}`", "guard"):
            try:
                result = self._evaluate(value, found)
            except MlException as raised:
                if (
                    raised.name == "Bind"
                ):  # the real engine takes it for a pattern that does not match
                    return
                raise
        choice = dict(found)
        if match(pattern, result, choice):
            yield choice

    def _match_all(self, t: FlatTransition, symbol: Symbol, found: Found) -> Iterator[Found]:
        assert symbol.colset is not None
        with running(t.origin, f"the colour set of `{symbol.name}`"):
            everything = self.colours.all(symbol.colset)
        for value in everything:
            yield {**found, symbol.uid: value}

    def _are_legal(self, t: FlatTransition, new: list[Symbol], choice: Found) -> bool:
        """A variable takes no value outside its colour set (the type of which may be larger)."""
        for symbol in new:
            if symbol.colset is not None:
                with running(t.origin, f"the colour set of `{symbol.name}`"):
                    if not self.colours.legal(symbol.colset, choice[symbol.uid]):
                        return False
        return True

    def _guards_hold(self, t: FlatTransition, position: int, found: Found) -> bool:
        """The guards that have just got their last variable: tested as early as possible."""
        return all(self._guard(t, i, found) for i in self._order.guards(t)[position])

    def _guard(self, t: FlatTransition, i: int, found: Found) -> bool:
        with running(t.origin, f"the guard of `{t.name}`", "guard"):
            try:
                return bool(self._evaluate(t.guards[i], found))
            except MlException as raised:
                if raised.name == "Bind":
                    return False
                raise


def _patterns(t: FlatTransition) -> Iterator[Pat]:
    """All patterns of a transition's inscriptions."""
    for step in t.plan:
        if isinstance(step, BindEquation):
            yield step.pattern
    for arc in t.arcs:
        for term in arc.inscription.terms if arc.inscription is not None else ():
            if term.pattern is not None:
                yield term.pattern
