"""What input arcs want: tokens, and whether places hold them."""

from __future__ import annotations

from typing import Any

from pn2code.base.frozen import frozen
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatTransition, Term
from pn2code.net.no_match import no_match_places
from pn2code.semantics.evaluation.effects import effects_of
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.game.errors import NoMatchError, running
from pn2code.semantics.game.marking import Binding, Marking
from pn2code.semantics.game.plan_order import PlanOrder, terms_of
from pn2code.semantics.values.data import MlException, Value
from pn2code.semantics.values.multiset import MultiSet

Found = dict[int, Value]
"""A binding while it is searched for: `uid` of the symbol -> value."""


class wanting(running):  # noqa: N801 - a context manager reads as a word
    """As `running`, for what an input arc wants."""

    __slots__ = ("arc", "demands", "t")

    def __init__(self, demands: Demands, t: FlatTransition, arc: FlatArc, doing: str) -> None:
        super().__init__(arc.origin, doing)
        self.demands = demands
        self.t = t
        self.arc = arc

    def __exit__(self, kind: object, raised: BaseException | None, trace: object) -> None:
        """Raise the GameError."""
        is_bind = isinstance(raised, MlException) and raised.name == "Bind"
        if is_bind and self.demands.means_no_match(self.t, self.arc.place):
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


class Demands:
    """What the transitions of a net want of its places."""

    def __init__(self, net: FlatNet, evaluator: Evaluator) -> None:
        self.net = net
        self.evaluator = evaluator
        self.colours = evaluator.colours
        self._order = PlanOrder(effects_of(net.program))
        self._no_match: dict[int, frozenset[int]] = {}

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
