"""Which binding elements are enabled: search for bindings, demands for tokens, the reasons why not.

Order of the bindings of a transition: the steps of its plan are taken one after the other, each trying its tokens in
the order of the place's colour set (`BindAll` and `BindRandom`: the values in order).

What is looked at, and so may raise an exception, follows the same order: after each step the guards that have all their
variables, then what arcs want by inscriptions that cannot raise one; after the last step the other places, arc by arc.
Whatever fails ends it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.readable import readable
from pn2code.ml.core.terms import Exp, Pat, Symbol
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    BindTerm,
    FlatArc,
    FlatNet,
    FlatTransition,
    Term,
)
from pn2code.net.no_match import no_match_places
from pn2code.semantics.evaluation.effects import effects_of
from pn2code.semantics.evaluation.evaluate import Evaluator, match, variables
from pn2code.semantics.evaluation.random import bindings_of
from pn2code.semantics.game.errors import GameError, NoMatchError, one_line, running
from pn2code.semantics.game.marking import (
    Binding,
    BindingElement,
    Marking,
    PlaceMarking,
    place_text,
    variable_text,
)
from pn2code.semantics.game.plan_order import PlanOrder, terms_of
from pn2code.semantics.values.data import MlException, Timed, Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet


class wanting(running):  # noqa: N801
    """As `running`, for what an input arc wants."""

    __slots__ = ("arc", "enabling", "t")

    def __init__(self, enabling: Enabling, t: FlatTransition, arc: FlatArc, doing: str) -> None:
        super().__init__(arc.origin, doing)
        self.enabling = enabling
        self.t = t
        self.arc = arc

    def __exit__(self, kind: object, raised: BaseException | None, trace: object) -> None:
        """Raise the GameError."""
        is_bind = isinstance(raised, MlException) and raised.name == "Bind"
        if is_bind and self.enabling.means_no_match(self.t, self.arc.place):
            raise NoMatchError(f"{self.doing} raised the exception `Bind`", self.origin) from None
        super().__exit__(kind, raised, trace)


@frozen
class Demand:
    """Tokens that an input arc wants.

    Args:
        place: index of the place.
        value: their colour.
        count: how many.
        early: by how much their stamps may lie after the model time (`@+` on an input arc).
    """

    place: int
    value: Value
    count: int
    early: int | float


Accept = Callable[[Symbol, Value], bool]
"""Whether a variable may have a value: narrows a search."""

Found = dict[int, Value]
"""A binding while it is searched for: `uid` of the symbol -> value."""


class Enabling:
    """Enabling of the transitions of a net.

    Attributes:
        constants: the declared values that patterns of the net name, by symbol; each search begins with them.
        left: the marking without what the binding takes that `why_disabled` has found enabled last.
    """

    def __init__(self, net: FlatNet, evaluator: Evaluator) -> None:
        self.net = net
        self.evaluator = evaluator
        self.colours = evaluator.colours
        self.left: Marking = Marking(0, ())
        self.constants: Found = {
            s.uid: evaluator.globals[s.uid]
            for t in net.transitions
            for pattern in _patterns(t)
            for s in variables(pattern)
            if s.uid in evaluator.globals
        }
        self._order = PlanOrder(effects_of(net.program))
        self._in_order: dict[int, tuple[PlaceMarking, list[Value]]] = {}
        self._no_match: dict[int, frozenset[int]] = {}

    # --- search for bindings ---------------------------------------------------------------------

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

    def _evaluate(self, exp: Any, found: Found) -> Any:
        return self.evaluator.evaluate(exp, found)

    def _advance(self, t: FlatTransition, arc: FlatArc, term: Term, found: Found) -> Any:
        if term.delay is None:
            return 0
        with wanting(self, t, arc, "the delay of an input arc"):
            return self._evaluate(term.delay, found)

    def means_no_match(self, t: FlatTransition, place: int) -> bool:
        """Whether `Bind` of what is wanted of a place means that there is no binding."""
        if t.index not in self._no_match:
            self._no_match[t.index] = no_match_places(t)
        return place in self._no_match[t.index]

    # --- demands ---------------------------------------------------------------------------------

    def _suffices(self, t: FlatTransition, marking: Marking, place: int, found: Found) -> bool:
        """Whether a place holds what the transition wants of it."""
        arcs = self._order.wanted(t).arcs[place]
        terms = [(arc, term) for arc in arcs for term in terms_of(arc)]
        try:
            demands = [d for arc, term in terms for d in self._term_demands(t, arc, term, found)]
        except NoMatchError:
            return False
        return self._holds(marking, demands)

    def _holds(self, marking: Marking, demands: list[Demand]) -> bool:
        """Whether `take` has a marking for them. Untimed tokens are counted only: a copy of a full place costs more."""
        wanted: dict[tuple[int, Value], int] = {}
        for demand in demands:
            if not isinstance(marking.places[demand.place], MultiSet):
                return isinstance(self.take(marking, demands), Marking)
            key = demand.place, demand.value
            wanted[key] = wanted.get(key, 0) + demand.count
        for (place, value), count in wanted.items():
            tokens = marking.places[place]
            assert isinstance(tokens, MultiSet)
            if tokens.counts.get(value, 0) < count:
                return False
        return True

    def _is_held(self, t: FlatTransition, marking: Marking, binding: Binding) -> bool:
        """Whether all places hold what the transition wants; one that does not ends the question."""
        wants = self._order.wanted(t)
        if wants.together:
            try:
                return self._holds(marking, self.demands(t, binding))
            except NoMatchError:
                return False
        found = {s.uid: value for s, value in binding.items()}
        return all(self._suffices(t, marking, place, found) for place in wants.arcs)

    def demands(
        self, t: FlatTransition, binding: Binding, *, only: int | None = None
    ) -> list[Demand]:
        """What the input arcs want with a binding; `only`: the arc with that index.

        Raises:
            NoMatchError: there is no such binding.
            GameError: an inscription raised an exception.
        """
        found = {s.uid: value for s, value in binding.items()}
        demands: list[Demand] = []
        for arc in t.arcs if only is None else (t.arcs[only],):
            if arc.kind in (ArcKind.INPUT, ArcKind.BOTH) and arc.inscription is not None:
                for term in arc.inscription.terms:
                    demands.extend(self._term_demands(t, arc, term, found))
        return demands

    def _term_demands(
        self, t: FlatTransition, arc: FlatArc, term: Term, found: Found
    ) -> list[Demand]:
        early = self._advance(t, arc, term, found)
        with wanting(self, t, arc, "the inscription"):
            value = self._evaluate(term.value, found)
            count = self._evaluate(term.coefficient, found)
        if term.whole:
            return [
                Demand(arc.place, item, n, early) for item, n in MultiSet.of(value).counts.items()
            ]
        return [Demand(arc.place, value, count, early)] if count > 0 else []

    def take(self, marking: Marking, demands: list[Demand]) -> Marking | Demand:
        """The marking without the demanded tokens, or the first demand that cannot be met.

        Among the tokens of a colour that are available the one with the latest stamp is taken. Demands that accept
        the fewest stamps choose first; what they accept the others accept as well.
        """
        places = list(marking.places)
        for demand in sorted(demands, key=lambda d: d.early):
            tokens = places[demand.place]
            if isinstance(tokens, MultiSet):
                left = tokens.counts.get(demand.value, 0) - demand.count
                if left < 0:
                    return demand
                counts = dict(tokens.counts)
                if left:
                    counts[demand.value] = left
                else:
                    del counts[demand.value]
                places[demand.place] = MultiSet(counts)
                continue
            for _ in range(demand.count):
                token = tokens.latest(demand.value, demand.early, marking.time)
                if token is None:
                    return demand
                tokens = tokens - [token]
            places[demand.place] = tokens
        return Marking(marking.time, tuple(places), marking.references)

    # --- enabled or not --------------------------------------------------------------------------

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


def _patterns(t: FlatTransition) -> Iterator[Pat]:
    """All patterns of a transition's inscriptions."""
    for step in t.plan:
        if isinstance(step, BindEquation):
            yield step.pattern
    for arc in t.arcs:
        for term in arc.inscription.terms if arc.inscription is not None else ():
            if term.pattern is not None:
                yield term.pattern


def available(tokens: PlaceMarking, now: float) -> list[Value] | list[Timed]:
    """The tokens of a place that are available at a time."""
    return list(tokens) if isinstance(tokens, MultiSet) else tokens.available(now)
