"""What can come before the supervisor's eyes: the closed net is explored, and of each of its states is kept what the
supervisor can tell of it.

found = look(partition, game, scheme, clock, most=20_000)
found.others[sight]              # {Sight(...): Turn("Robot1.Report {...}", 0)}: what others do to it

A supervisor sees its own places, the channels that it writes and reads, and the time. What robots do in between,
it does not see: many markings of the net are one sight, and a program that does the right thing in each sight does it
in each marking.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from pn2code.cell.partition import Partition
from pn2code.conform.clock import Clock
from pn2code.conform.scheme import SUPERVISOR, Scheme
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game


@dataclass(frozen=True, slots=True)
class Observation:
    """Args:
    marking: of what the supervisor sees; everything else is as at the start.
    read: channels whose message the program has made a token.
    signs: of the zeros in the marking, which an inscription can tell apart although they are equal.
    """

    marking: Marking
    read: frozenset[int]
    signs: frozenset[tuple[int, str]]


@dataclass(frozen=True, slots=True)
class ObservedChange:
    """How one sight turns into another: an occurrence in words, or time that goes on by `later`."""

    text: str
    later: float = 0


@dataclass(slots=True)
class Observations:
    """Args:
    others: for each sight, those that it turns into without the supervisor, and by what.
    states: markings of the closed net with what has been read.
    complete: these are all; without any, the first cycle stops the cell or ends it.
    overruns: ways to messages that come while the one before has not been taken.
    """

    others: dict[Observation, dict[Observation, ObservedChange]] = field(default_factory=dict)
    states: int = 0
    complete: bool = True
    overruns: list[tuple[str, ...]] = field(default_factory=list)


_CYCLE = ObservedChange("the supervisor's cycle")


class _Closed:
    def __init__(
        self, partition: Partition, game: Game, scheme: Scheme, clock: Clock, most: int
    ) -> None:
        self._partition = partition
        self._game = game
        self._scheme = scheme
        self._clock = clock
        self._start = clock.relative(game.marking)
        self._most = most
        seen = {*scheme.touched(SUPERVISOR), *partition.final_places}
        channels = {c.place for c in partition.channels if SUPERVISOR in (c.writer, c.reader)}
        self._unseen = [p.index for p in partition.net.places if p.index not in seen | channels]
        self._way: dict[Observation, tuple[Observation, ObservedChange] | None] = {}

    def look(self) -> Observations:
        found = Observations()
        start = self._after_cycle(self._start)
        if start is None:
            return found
        self._way = {start: None}
        waiting = deque([start])
        while waiting:
            state = waiting.popleft()
            own = self._sight(state)
            others = found.others.setdefault(own, {})
            for turn, after in self._following(state, found):
                if after not in self._way:
                    if len(self._way) >= self._most:
                        found.complete = False
                        continue
                    self._way[after] = (state, turn)
                    waiting.append(after)
                if turn is not _CYCLE and (turned := self._sight(after)) != own:
                    others.setdefault(turned, turn)
        found.states = len(self._way)
        # What was cut off is not gone into.
        for others in found.others.values():
            for sight in [s for s in others if s not in found.others]:
                del others[sight]
        return found

    def _following(
        self, state: Observation, found: Observations
    ) -> Iterator[tuple[ObservedChange, Observation]]:
        """States with what leads there."""
        quiet = True
        for owner in self._partition.owners[SUPERVISOR + 1 :]:
            possible = self._scheme.steps(owner.index, state.marking)
            if possible.steps or possible.raises:
                quiet = False
            for step in possible.steps:
                if self._is_overrun(state.marking, dict(step.changes)):
                    found.overruns.append((*self._way_to(state), step.text))
                else:
                    after_step = step.after(state.marking)
                    yield ObservedChange(step.text), observed(self._scheme, after_step, state.read)
        cycle = self._scheme.cycle(state.marking)
        if cycle.elements or cycle.stopped:
            quiet = False
        after = self._after_cycle(state.marking)
        if after is not None:
            yield _CYCLE, after
        if quiet:
            marking = self._game.advance_time(state.marking)
            if marking != state.marking:
                later = marking.time - state.marking.time
                after = observed(self._scheme, self._clock.relative(marking), state.read)
                yield ObservedChange(f"time goes on by {later}", later), after

    def _after_cycle(self, marking: Marking) -> Observation | None:
        """None: the supervisor stops, or has finished."""
        cycle = self._scheme.cycle(marking)
        if cycle.stopped or self._scheme.is_final(cycle.marking):
            return None
        read = self._scheme.unconsumed(cycle.marking)
        return observed(self._scheme, cycle.marking, read)

    def _is_overrun(self, before: Marking, changes: dict[int, object]) -> bool:
        """Whether somebody else writes a message where one is, or two at once."""
        for channel in self._partition.channels:
            tokens = changes.get(channel.place)
            if channel.writer != SUPERVISOR and tokens is not None:
                held, holds = len(before.places[channel.place]), len(tokens)  # type: ignore[arg-type]
                if holds > 1 or (held and holds):
                    return True
        return False

    def _sight(self, state: Observation) -> Observation:
        places = list(state.marking.places)
        for p in self._unseen:
            places[p] = self._start.places[p]
        marking = replace(state.marking, places=tuple(places))
        return observed(self._scheme, marking, state.read)

    def _way_to(self, state: Observation) -> tuple[str, ...]:
        way = []
        while (step := self._way[state]) is not None:
            state, turn = step
            way.append(turn.text)
        return tuple(way[::-1])


def observed(scheme: Scheme, marking: Marking, read: frozenset[int]) -> Observation:
    """A marking with what has been read of it."""
    return Observation(marking, read, scheme.nodes.signs(marking))


def look(partition: Partition, game: Game, scheme: Scheme, clock: Clock, most: int) -> Observations:
    """Explores the closed net as the cell runs it: the supervisor in cycles, the others step by step.

    Args:
        partition: the net and its owners.
        game: a token game at the marking from which the cell starts.
        scheme: of the two.
        clock: of the net.
        most: states at most.
    """
    return _Closed(partition, game, scheme, clock, most).look()
