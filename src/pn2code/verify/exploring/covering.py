"""Covering runs: a run to a marking, and a round of steps from there on that only adds tokens and can be repeated.

    run = Search(net, {}).look(stop)
    run.grows                       # ((3, 1),): each round puts one more token into place 3
    run.prefix, run.round           # binding elements

If a marking on a run contains an earlier one of that run, the steps between can be repeated for ever, and whatever they
add grows without bound (Karp and Miller, "Parallel Program Schemata", 1969; Finkel and Schnoebelen, "Well-structured
transition systems everywhere!", 2001). This needs that more tokens hinder nothing. Let G be the places that grow. A
round counts only if

* what its transitions do depends on their bindings alone: no random numbers, files, references, `step ()`, `time ()`;
* none of its transitions has an inhibitor or reset arc on a place of G (the others hold the same in each round);
* no transition of a higher priority than one of the round takes tokens from a place of G, so that what waited for
  nobody in the first round waits for nobody in later ones;
* in a timed net no transition at all takes tokens from a place of G (else the clock might stand still where it went on
  in the first round), all other places hold the same relative to the clock, and time is not real.

In a timed net a node has its time, so a round that adds nothing has no end either if time goes on in it: everything is
as it was, but later (`time_alone`). There, too, what its transitions do depends on their bindings alone, and nothing in
the net may look at the time (`time_reduction`).

A run is only given when the token game has played two more rounds, each of which added what the first one did.

The search walks at random: uniformly, and with transitions preferred in an order that changes from walk to walk. It
finds no proof that there is no such run.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.net.flat import ArcKind, FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import Effects, effects_of
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.graph import Nodes
from pn2code.semantics.game.marking import BindingElement, Marking, PlaceMarking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import MlException, MlLimit, Timed
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet
from pn2code.trace.played import written
from pn2code.unfold.purity import impure
from pn2code.verify.exploring.time_reduction import why_not_reducible

WALK = 300
"""Steps of the longest walk; the first ones are shorter, so that short runs are found first."""
WALKS = 80
"""Walks of a whole search."""
MOST_WORK = 200_000
"""Of a search that others wait for, or whose result decides theirs: transitions that are asked whether they are
enabled. It is counted in these, not in seconds, so that a busy machine finds the same."""
_CALLS = 100
"""Steps of CPN ML that take about as long as a transition does without any."""
_TOKENS = 50
"""Of a marking, that take about as long to be compared."""
_SHORTEST = 20
_BINDINGS = 20
"""Of a transition, of which one is chosen."""
_TAKING = (ArcKind.INPUT, ArcKind.BOTH)


@frozen
class Covering:
    """A run to a marking, and a round that can be repeated from there.

    Args:
        prefix: the steps to it.
        round: those that are repeated.
        grows: (index of a place, tokens that a round adds), the most first.
        holds: the tokens of each of them before the first round.
        later: how far a round brings the clock; 0 where places grow.
        file: the trace of the prefix and one round; None: it was not written.
    """

    prefix: tuple[BindingElement, ...]
    round: tuple[BindingElement, ...]
    grows: tuple[tuple[int, int], ...]
    holds: tuple[int, ...]
    later: int = 0
    file: Path | None = None

    def rounds_to(self, place: int, tokens: int) -> int | None:
        """How many rounds bring more than so many tokens into a place; None: it does not grow."""
        for (index, more), before in zip(self.grows, self.holds, strict=True):
            if index == place:
                return max(0, -((before - tokens - 1) // more))
        return None

    def places(self, net: FlatNet) -> list[str]:
        """The names of the places that grow."""
        return [net.places[index].name for index, _ in self.grows]

    def steps(self, net: FlatNet) -> str:
        """The run in words, with the transitions that are repeated."""
        turn = ", ".join(f"`{name}`" for name in named(net, self.round))
        after = len(self.prefix)
        begins = f"after {after} step{'s' * (after != 1)}" if after else "from the start"
        if not self.grows:
            return f"{begins} {turn} can be repeated for ever, every {self.later} units of time"
        adds = ", ".join(f"{n} to `{net.places[p].name}`" for p, n in self.grows)
        return f"{begins} {turn} can be repeated for ever, and each round adds {adds}"


def named(net: FlatNet, elements: Sequence[BindingElement], most: int = 8) -> list[str]:
    """The transitions of a run, some of them if it is long."""
    names = [net.transitions[e.transition].name for e in elements[:most]]
    return [*names, "..."] if len(elements) > most else names


class Search:
    """A search for a covering run.

    Args:
        net: the net.
        storage: as for `Game`.
        among: only places of these count as growing; None: all.
        time_alone: whether a round counts after which all is as before, but later.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """

    def __init__(
        self,
        net: FlatNet,
        storage: Mapping[str, str],
        among: Collection[int] | None = None,
        *,
        time_alone: bool = False,
    ) -> None:
        self._asked = 0
        self.net = net
        self.game = Game(net, storage, files=Files(None))
        self._nodes = Nodes(net)
        self._among = None if among is None else frozenset(among)
        self._time_alone = time_alone and net.timed and why_not_reducible(net) is None
        effects = effects_of(net.program)
        self._pure = frozenset(t.index for t in net.transitions if _is_pure(t, net, effects))
        self._takes = {
            t.index: frozenset(a.place for a in t.arcs if a.kind in _TAKING)
            for t in net.transitions
        }

    @property
    def work(self) -> int:
        """How often it has asked a transition whether it is enabled.

        Comparing markings, and what is evaluated for long, counts in addition.
        """
        return self._asked + self.game.evaluator.spent // _CALLS

    def look(
        self,
        is_over: Callable[[], bool] = lambda: False,
        walks: int = WALKS,
        most: float = math.inf,
    ) -> Covering | None:
        """The first covering run that a walk comes upon; None: none does.

        Args:
            is_over: asked at each step whether to give up.
            walks: how many.
            most: gives up after so much work.
        """
        if self.net.real_time or not self._pure:
            return None

        def has_enough() -> bool:
            return self.work >= most or is_over()

        choice = random.Random(1)
        for number in range(walks):
            length = min(WALK, _SHORTEST * (1 + number // 4))
            with suppress(GameError, MlException, MlLimit):  # a walk that comes upon an exception
                found = self._walk(choice, length, has_enough, is_uniform=number % 2 == 0)
                if found is not None:
                    return found
            if has_enough():
                return None
        return None

    def _walk(
        self,
        choice: random.Random,
        length: int,
        is_over: Callable[[], bool],
        *,
        is_uniform: bool,
    ) -> Covering | None:
        rank = [choice.random() for _ in self.net.transitions]
        marking = self.game.own_initial_marking
        markings, elements = [marking], list[BindingElement]()
        sizes = [_sizes(marking)]
        for _ in range(length):
            if is_over():
                return None
            now = self.game.advance_time(marking)
            self._asked += len(self.net.transitions)
            enabled = self.game.enabled_transitions(now)
            if not enabled:
                return None
            if is_uniform or choice.random() < 0.1:
                t = choice.choice(enabled)
            else:
                t = min(enabled, key=lambda t: rank[t.index])
            bindings = list(islice(self.game.bindings(t, now), _BINDINGS))
            element = BindingElement.make(t, choice.choice(bindings))
            marking, _ = self.game.occur(now, element)
            elements.append(element)
            size = _sizes(marking)
            for i in range(len(markings) - 1, -1, -1):
                if size == sizes[i]:
                    may_be = self._time_alone and marking.time > markings[i].time
                else:
                    may_be = all(a <= b for a, b in zip(sizes[i], size, strict=True))
                if may_be:
                    self._asked += 1 + sum(size) // _TOKENS
                    found = self._covering(markings[i], marking, elements, i)
                    if found is not None:
                        return found
            markings.append(marking)
            sizes.append(size)
        return None

    def _covering(
        self, before: Marking, after: Marking, elements: Sequence[BindingElement], first: int
    ) -> Covering | None:
        """The run if `after`, where `elements` end, covers `before`, which comes after `first` of them."""
        added = _added(before, after)
        turn = elements[first:]
        is_later = not added and self._time_alone and _is_later(before, after)
        if not (added or is_later) or not self._can_be_repeated(turn, added):
            return None
        if added and self._among is not None and not self._among.intersection(added):
            return None
        # Markings whose zeros have other signs are equal, but inscriptions can tell them apart.
        signs = self._nodes.signs(before)
        if self._nodes.signs(after) != signs:
            return None
        marking = after
        for _ in range(2):
            again = self._played(marking, turn)
            if again is None or _added(marking, again) != added:
                return None
            if is_later and not _is_later(marking, again):
                return None
            if self._nodes.signs(again) != signs:
                return None
            marking = again
        grows = sorted(((p, len(more)) for p, more in added.items()), key=lambda x: (-x[1], x[0]))
        holds = tuple(len(before.places[p]) for p, _ in grows)
        later = int(after.time - before.time) if is_later else 0
        return Covering(tuple(elements[:first]), tuple(turn), tuple(grows), holds, later)

    def _can_be_repeated(self, turn: Sequence[BindingElement], grows: Collection[int]) -> bool:
        """Whether more tokens in the places that grow hinder none of the steps (see above)."""
        own = [self.net.transitions[i] for i in sorted({e.transition for e in turn})]
        if any(t.index not in self._pure or _minds(t, grows) for t in own):
            return False
        last = max(t.priority for t in own)
        others = [t for t in self.net.transitions if self.net.timed or t.priority < last]
        return all(self._takes[t.index].isdisjoint(grows) for t in others)

    def _played(self, marking: Marking, turn: Sequence[BindingElement]) -> Marking | None:
        """The marking after these steps; None: one of them is not enabled."""
        self._asked += len(turn)
        for element in turn:
            marking = self.game.advance_time(marking)
            own = BindingElement(element.transition, element.values)
            if self.game.why_disabled(marking, own) is not None:
                return None
            marking, _ = self.game.occur(marking, own)
        return marking


def write(
    net: FlatNet, storage: Mapping[str, str], run: Covering, path: Path, rounds: int = 1
) -> bool:
    """Writes the prefix and so many rounds as a trace, played by the token game; False: it cannot be written.

    Raises:
        GameError: an inscription raises an exception.
        NotEnabled: a step is not enabled: then it is no covering run.
    """
    return written(net, storage, (*run.prefix, *(run.round * rounds)), path)


def kept(run: Covering, net: FlatNet, storage: Mapping[str, str], path: Path) -> Covering:
    """The run with its trace, if that can be written."""
    return replace(run, file=path if write(net, storage, run, path) else None)


# --- details --------------------------------------------------------------------------------------


def _is_pure(t: FlatTransition, net: FlatNet, effects: Effects) -> bool:
    """Whether what it does depends on its binding alone."""
    texts = (
        *t.guards,
        t.delay,
        t.code.action if t.code else None,
        *(a.inscription.value for a in t.arcs if a.inscription),
    )
    return not effects.of(*texts) and not any(impure(x, net.program) for x in texts if x)


def _minds(t: FlatTransition, grows: Collection[int]) -> bool:
    """Whether it can be hindered by more tokens in these places, or takes all of them away."""
    return any(a.place in grows and a.kind in (ArcKind.INHIBITOR, ArcKind.RESET) for a in t.arcs)


def _sizes(marking: Marking) -> tuple[int, ...]:
    return tuple(map(len, marking.places))


def _added(before: Marking, after: Marking) -> dict[int, MultiSet]:
    """By place, what the later marking has more; empty if it does not cover the earlier one.

    Of timed tokens, those that grow count without their stamps, which nobody ever looks at; all others count relative
    to the clock.
    """
    found: dict[int, MultiSet] = {}
    if before.references != after.references:
        return {}
    larger = []
    for place, (old, new) in enumerate(zip(before.places, after.places, strict=True)):
        if old is new:
            continue
        if len(old) != len(new):
            larger.append(place)  # looked at only where all others are equal: these are large
        elif not _is_same(old, new, before.time, after.time):
            return {}
    for place in larger:
        less, more = _colours(before.places[place]), _colours(after.places[place])
        if not less <= more:
            return {}
        found[place] = more - less
    return found


def _is_later(before: Marking, after: Marking) -> bool:
    """Whether all is the same relative to the clock, which has gone on."""
    return (
        after.time > before.time
        and before.references == after.references
        and all(
            _is_same(old, new, before.time, after.time)
            for old, new in zip(before.places, after.places, strict=True)
        )
    )


def _colours(tokens: PlaceMarking) -> MultiSet:
    return tokens if isinstance(tokens, MultiSet) else tokens.untimed()


def _is_same(old: PlaceMarking, new: PlaceMarking, before: float, after: float) -> bool:
    """Whether as many tokens are the same ones at two times."""
    return (isinstance(old, MultiSet) and old == new) or (
        _relative(old, before) == _relative(new, after)
    )


def _relative(tokens: PlaceMarking, now: float) -> PlaceMarking:
    """With stamps counted from now; what is available is so for ever."""
    if isinstance(tokens, MultiSet):
        return tokens
    return TimedMultiSet.of(Timed(t.value, max(t.stamp - now, 0)) for t in tokens)
