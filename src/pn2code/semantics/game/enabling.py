"""Which binding elements are enabled: search for bindings, demands for tokens, the reasons why not.

Order of the bindings of a transition: the steps of its plan are taken one after the other, each trying its tokens in
the order of the place's colour set (`BindAll` and `BindRandom`: the values in order).

What is looked at, and so may raise an exception, follows the same order: after each step the guards that have all their
variables, then what arcs want by inscriptions that cannot raise one; after the last step the other places, arc by arc.
Whatever fails ends it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from pn2code.base.readable import readable
from pn2code.ml.core.terms import Exp
from pn2code.net.flat import ArcKind, BindTerm, FlatArc, FlatNet, FlatTransition, Term
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.evaluation.random import bindings_of
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.binding_search import Accept, BindingSearch
from pn2code.semantics.game.demands import Demand, Found
from pn2code.semantics.game.errors import GameError, NoMatchError, one_line
from pn2code.semantics.game.marking import Binding, Marking, PlaceMarking, place_text, variable_text
from pn2code.semantics.values.data import Timed, Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet


class Enabling(BindingSearch):
    """Enabling of the transitions of a net.

    Attributes:
        left: the marking without what the binding takes that `why_disabled` has found enabled last.
    """

    def __init__(self, net: FlatNet, evaluator: Evaluator) -> None:
        super().__init__(net, evaluator)
        self.left: Marking = Marking(0, ())

    def enabled(
        self, t: FlatTransition, marking: Marking, *, accept: Accept | None = None
    ) -> Iterator[Binding]:
        """The bindings with which the transition is enabled at the marking's time; priorities do not count here.

        With `accept` only those all of whose values it accepts.
        """
        if self._inhibitors(t, marking):
            return
        try:
            for binding in self.bindings(t, marking, accept=accept, wanting=True):
                if self._is_held(t, marking, binding):
                    yield binding
        except GameError as error:
            error.transition = t
            raise

    def _inhibitors(self, t: FlatTransition, marking: Marking) -> list[FlatArc]:
        """The inhibitor arcs whose place has an available token."""
        return [a for a in t.arcs if a.kind is ArcKind.INHIBITOR and self.inhibited(a, marking)]

    def inhibited(self, arc: FlatArc, marking: Marking) -> bool:
        """Whether the place of an inhibitor arc has an available token."""
        return bool(available(marking.places[arc.place], marking.time))

    def why_disabled(self, t: FlatTransition, marking: Marking, binding: Binding) -> str | None:
        """Why a binding is not enabled at the marking's time (priorities apart); None if it is."""
        self.evaluator.now = marking.time
        self.evaluator.random.start(self.evaluator.steps, bindings_of(t.index))
        reason = self.why_guard_fails(t, binding)
        if reason is not None:
            return reason
        outputs = t.code.outputs if t.code else ()
        own_values = {s.uid: binding[s] for s in t.variables if s not in outputs}
        found: Found = {**self.constants, **own_values}
        own = {s: value for s, value in binding.items() if s not in outputs}
        try:
            demands = self.demands(t, own)
        except NoMatchError as none:
            return f"{none.origin.describe()}: {none.message}"
        missing = self.take(marking, demands)
        if isinstance(missing, Demand):
            return self.shortage(marking, missing, demands)
        self.left = missing
        for step in t.plan:
            if isinstance(step, BindTerm):
                arc = t.arcs[step.arc]
                fitting = self._match_tokens(t, arc, step.term, marking, found, False)
                if next(fitting, None) is None:
                    return f"no token in place `{self.net.places[arc.place].name}` matches"
        for arc in self._inhibitors(t, marking):
            place = self.net.places[arc.place]
            tokens = place_text(self.colours, place.colset, marking.places[arc.place])
            return f"place `{place.name}` inhibits it: it holds {one_line(tokens)}"
        return None

    def why_guard_fails(self, t: FlatTransition, binding: Binding) -> str | None:
        """Why a binding is not possible whatever tokens there are: a value is missing or illegal, a guard is false."""
        outputs = t.code.outputs if t.code else ()
        found: Found = {}
        for s in t.variables:
            if s in outputs:
                continue
            if s not in binding:
                return f"variable `{s.name}` has no value"
            found[s.uid] = binding[s]
            if s.colset is not None and not self.colours.legal(s.colset, binding[s]):
                text = variable_text(self.colours, s, binding[s])
                return f"{text} is not in the colour set `{s.colset.name}` of variable `{s.name}`"
        guard = self._first_false(t, found)
        return None if guard is None else f"the guard `{one_line(guard.span.text)}` is false"

    def false_guard(self, t: FlatTransition, binding: Binding) -> Exp | None:
        """The first guard that is false with a binding; None: there is none.

        Raises:
            GameError: it raised an exception.
        """
        return self._first_false(t, {**self.constants, **{s.uid: v for s, v in binding.items()}})

    def _first_false(self, t: FlatTransition, found: Found) -> Exp | None:
        return next((g for i, g in enumerate(t.guards) if not self._guard(t, i, found)), None)

    def shortage(self, marking: Marking, missing: Demand, demands: list[Demand]) -> str:
        """In words: the tokens that are missing."""
        place = self.net.places[missing.place]
        c = place.colset
        wanted = sum(
            d.count for d in demands if d.place == missing.place and d.value == missing.value
        )
        tokens = marking.places[missing.place]
        held = one_line(place_text(self.colours, c, tokens))
        text = f"place `{place.name}` lacks {wanted}`{readable(self.colours.text(c, missing.value))}: it holds {held}"
        if isinstance(tokens, TimedMultiSet):
            early = f" + {missing.early}" if missing.early else ""
            text += f" at time {marking.time}{early}"
        return text

    # --- time ------------------------------------------------------------------------------------

    def thresholds(self, t: FlatTransition, marking: Marking) -> set[int | float]:
        """The times after the marking's at which tokens become available to the transition."""
        later: set[int | float] = set()
        for arc in t.arcs:
            if arc.kind not in (ArcKind.INPUT, ArcKind.BOTH) or arc.inscription is None:
                continue
            tokens = marking.places[arc.place]
            if not isinstance(tokens, TimedMultiSet):
                continue
            for term in arc.inscription.terms:
                try:
                    for early in self._possible_delays(t, arc, term, marking):
                        later.update(token.stamp - early for token in tokens)
                except GameError as error:
                    error.transition = t
                    raise
        return {time for time in later if time > marking.time}

    def _possible_delays(
        self, t: FlatTransition, arc: FlatArc, term: Term, marking: Marking
    ) -> set[int | float]:
        """The values that the delay of an input term can have with the tokens that are there."""
        if term.delay is None:
            return {0}
        if not variables(term.delay) & set(t.variables):
            with suppress(NoMatchError):
                return {self._advance(t, arc, term, {})}
            return set()
        found: set[int | float] = set()
        for binding in self.bindings(t, marking, ignore_stamps=True):
            with suppress(NoMatchError):
                values = {s.uid: value for s, value in binding.items()}
                found.add(self._advance(t, arc, term, values))
        return found


def available(tokens: PlaceMarking, now: float) -> list[Value] | list[Timed]:
    """The tokens of a place that are available at a time."""
    return list(tokens) if isinstance(tokens, MultiSet) else tokens.available(now)
