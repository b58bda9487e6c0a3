"""Whether a search for bindings raises an exception in whatever order the conditions are asked.

raises_in_every_order(game.enabling, t, game.marking)

It does if there are tokens for all arcs together with which every condition is true or raises one, and one does:
nothing ends the question before that one is asked. It may do so in other cases, too (two conditions of which each
raises one for other tokens); that is not looked for, so that "no" means "not known".
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Exp, Lit, Symbol
from pn2code.net.flat import ArcKind, BindAll, BindEquation, BindTerm, FlatTransition, Term
from pn2code.net.terms import binary
from pn2code.semantics.evaluation.matching import match
from pn2code.semantics.evaluation.random import bindings_of
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.demands import Demand, Found
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable
from pn2code.semantics.values.multiset import MultiSet

_TAKING = (ArcKind.INPUT, ArcKind.BOTH)
MOST_TRIED = 100_000
"""Partial bindings that are looked at."""


class _TooManyError(Exception):
    """There is no end of partial bindings."""


class _NoMatchError(Exception):
    """`Bind` was raised, which means that something does not match."""


class _Raised:
    """Instead of a value: there is none, an exception was raised."""


@frozen
class _State:
    """A partial binding: values, variables that have none since an exception was raised, and whether one was."""

    found: Found
    lost: frozenset[Symbol]
    raised: bool


def raises_in_every_order(enabling: Enabling, t: FlatTransition, marking: Marking) -> bool:
    """Whether an exception is raised at the marking's time, whatever is asked first; False: that is not known."""
    if any(a.kind is ArcKind.INHIBITOR and enabling.inhibited(a, marking) for a in t.arcs):
        return False
    enabling.evaluator.now = marking.time
    enabling.evaluator.random.start(enabling.evaluator.steps, bindings_of(t.index))
    try:
        return _Search(enabling, t, marking).is_raised()
    except _TooManyError:
        return False


class _Search:
    def __init__(self, enabling: Enabling, t: FlatTransition, marking: Marking) -> None:
        self._enabling = enabling
        self._t = t
        self._marking = marking
        self._own = frozenset(t.variables)
        self._left = MOST_TRIED
        equations = {s.guard for s in t.plan if isinstance(s, BindEquation)}
        self._guards = [g for i, g in enumerate(t.guards) if i not in equations]
        self._terms = [
            (arc.place, term)
            for arc in t.arcs
            if arc.kind in _TAKING and arc.inscription is not None
            for term in arc.inscription.terms
        ]

    def is_raised(self) -> bool:
        start = _State(self._enabling.constants, frozenset(), False)
        return any(map(self._is_met_with, self._bound(0, start)))

    def _is_met_with(self, state: _State) -> bool:
        try:
            return self._is_met(state)
        except _NoMatchError:
            return False

    def _bound(self, position: int, state: _State) -> Iterator[_State]:
        self._left -= 1
        if self._left < 0:
            raise _TooManyError
        if position == len(self._t.plan):
            yield state
            return
        with suppress(_NoMatchError):
            for next_ in self._step(position, state):
                yield from self._bound(position + 1, next_)

    def _step(self, position: int, state: _State) -> Iterator[_State]:
        match self._t.plan[position]:
            case BindTerm(arc, index):
                taken = self._t.arcs[arc]
                assert taken.inscription is not None
                pattern = taken.inscription.terms[index].pattern
                assert pattern is not None
                tokens = self._marking.places[taken.place]
                if variables(pattern) & state.lost:
                    return  # either may come first
                for value in tokens.counts if isinstance(tokens, MultiSet) else tokens.stamps:
                    choice = dict(state.found)
                    if match(pattern, value, choice):
                        yield from self._legal(state, choice)
            case BindEquation(_, pattern, text):
                names = variables(pattern) & self._own
                value = self._value(text, state)
                if value is None or names & state.lost:
                    return
                if isinstance(value, _Raised):
                    new = frozenset(s for s in names if s.uid not in state.found)
                    if not any(variables(x) & new for x in self._patterns()):
                        yield _State(state.found, state.lost | new, True)
                    return
                choice = dict(state.found)
                if match(pattern, value, choice):
                    yield from self._legal(state, choice)
            case BindAll(symbol):
                assert symbol.colset is not None
                for value in self._enabling.colours.all(symbol.colset):
                    yield _State({**state.found, symbol.uid: value}, state.lost, state.raised)
            case _:
                yield state

    def _patterns(self) -> Iterator[Any]:
        for _, term in self._terms:
            if term.pattern is not None:
                yield term.pattern
        yield from (g for g in self._guards if binary(g, ("=",)) is not None)  # they may bind

    def _legal(self, state: _State, choice: Found) -> Iterator[_State]:
        new = (s for s in self._own if s.uid in choice and s.uid not in state.found)
        colours = self._enabling.colours
        if all(s.colset is None or colours.legal(s.colset, choice[s.uid]) for s in new):
            yield _State(choice, state.lost, state.raised)

    def _value(self, text: Exp, state: _State) -> Any:
        """None: it needs a variable that has no value."""
        if variables(text) & state.lost:
            return None
        try:
            return self._enabling.evaluator.evaluate(text, state.found)
        except MlException as raised:
            if raised.name == "Bind":
                raise _NoMatchError from None
            return _Raised()
        except (MlLimit, MlUnavailable):
            return _Raised()

    def _is_met(self, state: _State) -> bool:
        """Whether all is true or raises an exception, and something does."""
        raised = state.raised
        for guard in self._guards:
            if variables(guard) & state.lost:
                continue
            value = self._value(guard, state)
            if isinstance(value, _Raised):
                raised = True
            elif not value:
                return False
        demands: list[Demand] = []
        least: dict[int, int] = {}
        for place, term in self._terms:
            wanted = self._demands(place, term, state)
            if wanted is None:  # CPN Tools looks at first whether there are as many tokens
                raised = True
                least[place] = least.get(place, 0) + _coefficient(term)
            else:
                demands += wanted
        left = self._enabling.take(self._marking, demands)
        return (
            raised
            and isinstance(left, Marking)
            and all(len(list(left.places[p])) >= n for p, n in least.items())
        )

    def _demands(self, place: int, term: Term, state: _State) -> Iterable[Demand] | None:
        """What a term wants; None: an exception is raised, or a variable has no value because of one."""
        early = 0 if term.delay is None else self._value(term.delay, state)
        count, value = self._value(term.coefficient, state), self._value(term.value, state)
        if any(x is None or isinstance(x, _Raised) for x in (early, count, value)):
            return None
        if term.whole:
            items = MultiSet.of(value).counts.items()
            return [Demand(place, item, n, early) for item, n in items]
        return [Demand(place, value, max(count, 1), early)]


def _coefficient(term: Term) -> int:
    c = term.coefficient
    return c.value if isinstance(c, Lit) and isinstance(c.value, int) else 1
