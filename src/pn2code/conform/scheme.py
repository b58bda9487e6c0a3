"""The supervisor's execution scheme (docs/execution.md) in the reference token game, owner by owner.

scheme = Scheme(partition, game)
done = scheme.cycle(marking)          # Cycle(marking, elements, stopped): what one cycle of the supervisor does
for step in scheme.steps(1, marking).steps:
    step.after(marking)               # what the first robot may do

What an owner does depends on the places that it touches, on the time, and on what references hold, so it is worked out
once for each of those, however many markings they occur in.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.partition import SUPERVISOR, Partition
from pn2code.net.flat import FlatTransition
from pn2code.semantics.evaluation.references import Held
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.graph import Nodes
from pn2code.semantics.game.marking import BindingElement, Marking, PlaceMarking, element_text
from pn2code.semantics.game.token_game import Game, GameError

MOST_STATES = 20_000
"""Up to which a program is compared in all states, unless somebody says otherwise."""


@frozen
class Changes:
    """What is different after an occurrence.

    Args:
        places: those that changed, with what they hold from then on.
        references: what these hold from then on.
    """

    places: tuple[tuple[int, PlaceMarking], ...]
    references: Held

    def of(self, marking: Marking) -> Marking:
        """The marking with them."""
        places = list(marking.places)
        for place, tokens in self.places:
            places[place] = tokens
        return replace(marking, places=tuple(places), references=self.references)


@frozen
class Cycle:
    """Step 2 of one cycle.

    Args:
        marking: after it; of a cycle that was stopped, before the occurrence that failed.
        elements: what occurred, in order.
        stopped: why the supervisor has to stop; "" if it need not.
        is_overrun: because it has put a second message into a channel.
    """

    marking: Marking
    elements: tuple[BindingElement, ...]
    stopped: str
    is_overrun: bool = False


@frozen
class Step:
    """An occurrence, in words, and what it changes."""

    text: str
    changes: Changes

    def after(self, marking: Marking) -> Marking:
        """The marking after it."""
        return self.changes.of(marking)


@frozen
class Steps:
    """What an owner may do. `raises`: something of it raises an exception, which stops the owner."""

    steps: tuple[Step, ...]
    raises: bool


class Scheme:
    """Who may do what in a cell.

    Args:
        partition: the net and its owners.
        game: a token game of that net; its own marking is not touched.
        most: firings in one cycle at most, as the program's `--max-firings`.
    """

    def __init__(self, partition: Partition, game: Game, most: int = 100_000) -> None:
        self.partition = partition
        self._game = game
        self._most = most
        order = sorted(partition.net.transitions, key=lambda t: t.priority)
        self._of: list[list[FlatTransition]] = [
            [t for t in order if partition.transition_owner[t.index] == owner.index]
            for owner in partition.owners
        ]
        self.nodes = Nodes(partition.net)
        """tells markings apart that differ in the signs of zeros"""
        self._touched = [sorted({a.place for t in own for a in t.arcs}) for own in self._of]
        self._steps: dict[tuple[object, ...], Steps] = {}
        self._cycles: dict[tuple[object, ...], tuple[Changes, Cycle]] = {}

    def touched(self, owner: int) -> list[int]:
        """The places on which what the owner does depends, besides the time and the references."""
        return self._touched[owner]

    def cycle(self, marking: Marking) -> Cycle:
        """Fires until nothing of the supervisor is enabled: best priority, documented order, first binding."""
        seen = self._seen(SUPERVISOR, marking)
        if seen not in self._cycles:
            cycle = self._played(marking)
            self._cycles[seen] = self._changes(SUPERVISOR, marking, cycle.marking), cycle
        changes, cycle = self._cycles[seen]
        return replace(cycle, marking=changes.of(marking))

    def unconsumed(self, marking: Marking) -> frozenset[int]:
        """The channels with a message to the supervisor; after a cycle it has read these."""
        return frozenset(
            i
            for i, channel in enumerate(self.partition.channels)
            if channel.reader == SUPERVISOR and marking.places[channel.place]
        )

    def is_final(self, marking: Marking) -> bool:
        """Whether the supervisor ends there."""
        return any(marking.places[p] for p in self.partition.final_places)

    def steps(self, owner: int, marking: Marking) -> Steps:
        """What an owner may do now; priorities count within an owner."""
        seen = self._seen(owner, marking)
        if seen not in self._steps:
            self._steps[seen] = self._possible(owner, marking)
        return self._steps[seen]

    def enabled(self, owner: int, marking: Marking) -> Iterator[BindingElement]:
        """The same as binding elements, in the documented order.

        Raises:
            GameError: an inscription raises an exception.
        """
        best: int | None = None
        for t in self._of[owner]:
            if best is not None and t.priority > best:
                return
            for binding in self._game.bindings(t, marking):
                best = t.priority
                yield BindingElement.make(t, binding)

    def _seen(self, owner: int, marking: Marking) -> tuple[object, ...]:
        touched = self._touched[owner]
        signs = frozenset(x for x in self.nodes.signs(marking) if x[0] in touched)
        held = (marking.places[p] for p in touched)
        return owner, marking.time, signs, marking.references, *held

    def _changes(self, owner: int, before: Marking, after: Marking) -> Changes:
        turned = {p for p, _ in self.nodes.signs(before) ^ self.nodes.signs(after)}
        places = (
            (p, after.places[p])
            for p in self._touched[owner]
            if p in turned or after.places[p] != before.places[p]
        )
        return Changes(tuple(places), after.references)

    def _played(self, marking: Marking) -> Cycle:
        done: list[BindingElement] = []
        while True:
            try:
                element = next(self.enabled(SUPERVISOR, marking), None)
                if element is None:
                    overrun = self._overrun(marking)
                    return Cycle(marking, tuple(done), overrun, bool(overrun))
                if len(done) == self._most:
                    return Cycle(marking, tuple(done), "no end of firing")
                marking, occurred = self._game.occur(marking, element)
            except GivenUpError:  # nothing is known then
                raise
            except GameError as error:
                return Cycle(marking, tuple(done), str(error))
            done.append(occurred)

    def _overrun(self, marking: Marking) -> str:
        """Says which channel of the supervisor holds more than one message; "" if none does."""
        for channel in self.partition.channels:
            tokens = len(marking.places[channel.place])
            if channel.writer == SUPERVISOR and tokens > 1:
                return f"{tokens} messages for {channel.file}"
        return ""

    def _possible(self, owner: int, marking: Marking) -> Steps:
        steps: list[Step] = []
        raises = False
        try:
            for element in self.enabled(owner, marking):
                try:
                    after, _ = self._game.occur(marking, element)
                except GivenUpError:
                    raise
                except GameError:
                    raises = True
                    continue
                text = element_text(self._game.colours, self.partition.net, element)
                steps.append(Step(text, self._changes(owner, marking, after)))
        except GivenUpError:
            raise
        except GameError:
            raises = True
        return Steps(tuple(steps), raises)
