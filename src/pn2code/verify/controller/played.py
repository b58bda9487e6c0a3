"""A run of the cell as it runs, played by the token game: each program does what comes first in its order.

problem = why_not(running, {}, trace, holds)     # None: the programs can do so, and `holds` is true of its end

It shares nothing with the explorer but the net of `running` and the words of docs/execution.md, so it is asked about
runs that no graph stands behind: those that a swarm has found. In a net with time it is only looked whether each step
has its tokens, since programs see the clock at different moments.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from itertools import islice
from pathlib import Path

from pn2code.cell.partition import SUPERVISOR
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game.marking import Binding, BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.trace.played import game_of
from pn2code.trace.script import Trace
from pn2code.verify.controller.running import Running

MOST_FOLLOWING = 300
"""Markings that are looked at after a run that shows that none of some kind follows."""
MOST_STEPS = 3_000
"""Longer runs take the token game too long."""


class Played:
    """The programs of a cell in one marking after the other.

    Args:
        running: the cell as it runs.
        game: of its net.
    """

    def __init__(self, running: Running, game: Game) -> None:
        self._running = running
        self.game = game
        self._owners = running.owners()
        self._count = len(running.partition.net.transitions)

    @property
    def marking(self) -> Marking:
        """Where the run has come to."""
        return self.game.marking

    @cached_property
    def _own(self) -> Mapping[int, list[FlatTransition]]:
        """By owner what it can do, in its order."""
        own: dict[int, list[FlatTransition]] = {}
        for t in self._running.net.transitions:
            own.setdefault(self._owners[t.index], []).append(t)
        for ts in own.values():
            ts.sort(key=lambda t: (t.priority, t.index))
        return own

    def first(self, t: FlatTransition) -> Binding | None:
        """The first binding with which it has its tokens."""
        return next(self.game.bindings(t, self.game.marking), None)

    def held_back(self, t: FlatTransition) -> FlatTransition | None:
        """What its program does instead; None: nothing."""
        is_step = t.index >= self._count
        meek = self._running.meek
        for u in self._own[self._owners[t.index]]:
            if u is t:
                break
            if u.index in self._running.clock or (u.index in meek and not is_step):
                continue
            are_of_net = u.index < self._count and t.index < self._count
            if (u.priority < t.priority or are_of_net) and self.first(u) is not None:
                return u
        return None

    def why_not(self, t: FlatTransition, binding: Binding) -> str | None:
        """Why its program does not do so now; None: it may."""
        element = BindingElement.make(t, binding)
        why = self.game.why_disabled(self.game.marking, element, priorities=False)
        if why is not None:
            return f"`{t.name}` is not enabled: {why}"
        if self._running.net.timed:
            return None
        if t.index in self._running.probes:
            return f"`{t.name}` never occurs"
        instead = self.held_back(t)
        if instead is not None:
            return f"`{instead.name}` comes before `{t.name}`"
        is_first = t.index < self._count and self._owners[t.index] == SUPERVISOR
        if is_first and BindingElement.make(t, self.first(t) or {}) != element:
            return f"another binding of `{t.name}` comes first"
        return None

    def is_dead(self) -> bool:
        """Whether no program can do anything. (With time it is taken to be so.)"""
        never = {*self._running.probes, *self._running.clock}
        return self._running.net.timed or not any(
            self.first(t) is not None and self.held_back(t) is None
            for t in self._running.net.transitions
            if t.index not in never
        )

    def may_reach(self, place: int) -> bool:
        """Whether a marking with a token in a place follows, as far as `MOST_FOLLOWING` markings tell."""
        here = self.game.marking
        seen, todo = {here}, [here]
        try:
            while todo and len(seen) <= MOST_FOLLOWING:
                marking = todo.pop()
                if len(marking.places[place]) > 0:
                    return True
                for after in self._after(marking):
                    if after not in seen:
                        seen.add(after)
                        todo.append(after)
            return False
        finally:
            self.game.marking = here

    def _after(self, marking: Marking) -> Iterator[Marking]:
        """What programs make of a marking; nothing with time."""
        for t in () if self._running.net.timed else self._running.net.transitions:
            self.game.marking = marking
            for binding in tuple(self.game.bindings(t, marking)):
                if self.why_not(t, binding) is None:
                    self.game.fire(BindingElement.make(t, binding), checked=False)
                    yield self.game.marking
                    self.game.marking = marking


def why_not(
    running: Running,
    storage: Mapping[str, str],
    trace: Path,
    holds: Callable[[Played], bool] | None = None,
) -> str | None:
    """Why the programs cannot do what a run says, or why that does not show what it should; None: they can.

    Args:
        running: the cell as it runs.
        storage: as for `Game`.
        trace: a run of its net, with the steps of programs.
        holds: what the run should come to; None: it is looked at elsewhere.

    Raises:
        TraceRefusedError, GameError, OSError, MlException, MlLimit: it cannot be played.
    """
    opened = Trace.open(trace, running.net, is_shown=True)
    game = game_of(opened, running.net, storage)
    played = Played(running, game)
    for step in islice(opened.steps(), MOST_STEPS):
        if step.time is not None and step.time > game.marking.time:
            game.set_time(step.time)
        problem = played.why_not(step.transition, step.bound)
        if problem is not None:
            return f"line {step.line}: {problem}"
        game.fire(BindingElement.make(step.transition, step.bound), checked=False)
    return None if holds is None or holds(played) else "its end does not show it"
