"""The supervisor's execution scheme (docs/execution.md) in the reference token game: what one cycle does to a marking.

scheme = Scheme(partition, game)
done = scheme.cycle(marking)      # Cycle(marking, elements, stopped)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from pn2code.cell.partition import Partition
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game import Game, GameError
from pn2code.semantics.marking import BindingElement, Marking

SUPERVISOR = 0
"""Its number among the owners of a partition."""


@dataclass(frozen=True, slots=True)
class Cycle:
    """Step 2 of one cycle.

    Args:
        marking: after it; of a cycle that was stopped, before the occurrence that failed.
        elements: what occurred, in order.
        stopped: why the supervisor has to stop; "" if it need not.
    """

    marking: Marking
    elements: tuple[BindingElement, ...]
    stopped: str


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

    def cycle(self, marking: Marking) -> Cycle:
        """Fires until nothing of the supervisor is enabled: best priority, documented order, first binding."""
        done: list[BindingElement] = []
        while True:
            try:
                element = self._first(marking)
                if element is None:
                    return Cycle(marking, tuple(done), "")
                if len(done) == self._most:
                    return Cycle(marking, tuple(done), "no end of firing")
                marking, occurred = self._game.occur(marking, element)
            except GameError as error:
                return Cycle(marking, tuple(done), str(error))
            done.append(occurred)

    def others(self, marking: Marking) -> Iterator[BindingElement]:
        """What the other owners may do now; priorities count within an owner.

        Raises:
            GameError: an inscription raises an exception.
        """
        for owner in self.partition.owners[SUPERVISOR + 1 :]:
            best: int | None = None
            for t in self._of[owner.index]:
                if best is not None and t.priority > best:
                    break
                for binding in self._game.bindings(t, marking):
                    best = t.priority
                    yield BindingElement.make(t, binding)

    def _first(self, marking: Marking) -> BindingElement | None:
        for t in self._of[SUPERVISOR]:
            for binding in self._game.bindings(t, marking):
                return BindingElement.make(t, binding)
        return None
