"""What was found enabled last: looked for again only where something that it depends on has changed.

Most occurrences change few places, so most transitions are enabled with the same bindings as before. What a transition
is enabled with depends on the model time, the tokens of the places of its input and inhibitor arcs, and nothing
else, unless one of its texts reads references, draws random numbers, counts steps or looks at files: then
nothing is remembered.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.net.flat import ArcKind, BindEquation, FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import Effects, effects_of
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import Binding, Marking, PlaceMarking

_EXAMINED = (ArcKind.INPUT, ArcKind.BOTH, ArcKind.INHIBITOR)


class EnablingCache:
    """The bindings of each transition in the marking in which they were asked for last."""

    def __init__(self, net: FlatNet, enabling: Enabling) -> None:
        self._enabling = enabling
        effects = effects_of(net.program)
        self._places = {t.index: _examined(t, effects) for t in net.transitions}
        self._known: dict[int, tuple[int | float, list[PlaceMarking], list[Binding]]] = {}
        self._possible: dict[int, tuple[int | float, list[PlaceMarking], bool]] = {}
        readers: list[list[int]] = [[] for _ in net.places]
        for index, places in self._places.items():
            for place in places or ():
                readers[place].append(index)
        self._readers = readers
        self._always = frozenset(index for index, places in self._places.items() if places is None)
        # Of the marking that was asked for last: it, what is enabled there, and what nobody has looked at yet.
        self._seen: Marking | None = None
        self._is_enabled = [False] * len(net.transitions)
        self._open: set[int] = set(range(len(net.transitions)))

    def enabled(self, t: FlatTransition, marking: Marking) -> list[Binding]:
        """The bindings with which a transition is enabled, as `Enabling.enabled` lists them."""
        known = self._still(t, marking)
        if known is not None:
            return known
        found = list(self._enabling.enabled(t, marking))
        places = self._places[t.index]
        if places is not None:
            self._known[t.index] = marking.time, [marking.places[i] for i in places], found
        return found

    def is_enabled(self, t: FlatTransition, marking: Marking) -> bool:
        """Whether there is one; no more than that is looked for."""
        known = self._still(t, marking)
        if known is not None:
            return bool(known)
        places = self._places[t.index]
        before = self._possible.get(t.index)
        if before is not None and places is not None and _same(before, marking, places):
            return before[2]
        found = next(self._enabling.enabled(t, marking), None) is not None
        if places is not None:
            self._possible[t.index] = marking.time, [marking.places[i] for i in places], found
        return found

    def best(
        self,
        ordered: Iterable[FlatTransition],
        marking: Marking,
        raising: dict[int, GameError] | None = None,
    ) -> list[FlatTransition]:
        """Of transitions in the order of their priorities those that are enabled and have the best one.

        After a step only what its places can have changed is looked at again.

        Args:
            ordered: the transitions.
            marking: where.
            raising: gets the transitions of which an inscription raises an exception, which then count as not enabled.

        Raises:
            GameError: an inscription raises an exception, and `raising` is not given.
        """
        self._go_to(marking)
        found: list[FlatTransition] = []
        for t in ordered:
            if found and t.priority > found[0].priority:
                break
            index = t.index
            if index in self._open or index in self._always:
                try:
                    self._is_enabled[index] = self.is_enabled(t, marking)
                except GameError as error:
                    if raising is None:
                        raise
                    raising[index] = error
                    self._is_enabled[index] = (
                        False  # and it stays open: whoever asks again gets the exception
                    )
                    continue
                self._open.discard(index)
            if self._is_enabled[index]:
                found.append(t)
        return found

    def _go_to(self, marking: Marking) -> None:
        """What has to be looked at in a marking, after the one before."""
        before, self._seen = self._seen, marking
        if before is None or before.time != marking.time:
            self._open.update(range(len(self._is_enabled)))
            return
        if before.places is marking.places:
            return
        for place, (then, now) in enumerate(zip(before.places, marking.places, strict=True)):
            if then is not now:
                self._open.update(self._readers[place])

    def _still(self, t: FlatTransition, marking: Marking) -> list[Binding] | None:
        """What is known, if all it depends on is as it was."""
        known = self._known.get(t.index)
        places = self._places[t.index]
        if known is None or places is None or not _same(known, marking, places):
            return None
        return known[2]


def _same(
    known: tuple[int | float, list[PlaceMarking], object], marking: Marking, places: tuple[int, ...]
) -> bool:
    """Whether time and places are as they were."""
    time, tokens, _ = known
    if time != marking.time:
        return False
    return all(marking.places[i] is then for i, then in zip(places, tokens, strict=True))


def _examined(t: FlatTransition, effects: Effects) -> tuple[int, ...] | None:
    """The places on which it depends whether a transition is enabled; None if it does not on them alone."""
    arcs = [a for a in t.arcs if a.kind in _EXAMINED]
    texts: list[object] = [*t.guards]
    texts += [step.value for step in t.plan if isinstance(step, BindEquation)]
    for inscription in (a.inscription for a in arcs):
        if inscription is not None:
            for term in inscription.terms:
                texts += [term.value, term.coefficient, term.delay]
    for symbol in t.variables:
        if symbol.colset is not None:
            texts.extend(symbol.colset.tests())
    if effects.of(*texts):
        return None
    return tuple(sorted({a.place for a in arcs}))
