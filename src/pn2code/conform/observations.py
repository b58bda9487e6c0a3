"""What can come before the supervisor's eyes: the closed net is explored, and of each of its states is kept what the
supervisor can tell of it.

found = look(partition, game, scheme, clock, most=20_000)
found.others[observation]         # {Observation(...): ObservedChange("Robot1.Report {...}", 0)}: what others do to it

A supervisor sees its own places, the channels that it writes and reads, and the time. What robots do in between,
it does not see: many markings of the net are one observation, and a program that does the right thing in each does it
in each marking. Messages that one occurrence gives it come one after the other (I5 of docs/protocol.md), and it may
execute its cycle between two of them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import field, replace

from pn2code.base.frozen import frozen, record
from pn2code.cell.partition import SUPERVISOR, Channel, Partition
from pn2code.conform.clock import Clock
from pn2code.conform.scheme import Scheme
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game


@frozen
class Observation:
    """Args:
    marking: of what the supervisor sees; everything else is as at the start.
    read: channels whose message the program has made a token.
    signs: of the zeros in the marking, which an inscription can tell apart although they are equal.
    """

    marking: Marking
    read: frozenset[int]
    signs: frozenset[tuple[int, str]]


@frozen
class ObservedChange:
    """How one sight turns into another: an occurrence in words, or time that goes on by `later`."""

    text: str
    later: float = 0


@record
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


@frozen
class _State:
    """Args:
    marking: of the closed net.
    read: as in `Observation`.
    late: places of messages to the supervisor that have been put, and are not published yet.
    signs: as in `Observation`.
    """

    marking: Marking
    read: frozenset[int]
    late: frozenset[int]
    signs: frozenset[tuple[int, str]]


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
        self._incoming = [c for c in partition.channels if c.reader == SUPERVISOR]
        self._reached_by: dict[_State, tuple[_State, ObservedChange] | None] = {}

    def look(self) -> Observations:
        found = Observations()
        start = self._after_cycle(self._state(self._start, frozenset()))
        if start is None:
            return found
        self._reached_by = {start: None}
        waiting = deque([start])
        while waiting:
            state = waiting.popleft()
            own = self._sight(state)
            others = found.others.setdefault(own, {})
            for turn, after in self._following(state, found):
                if after not in self._reached_by:
                    if len(self._reached_by) >= self._most:
                        found.complete = False
                        continue
                    self._reached_by[after] = (state, turn)
                    waiting.append(after)
                if turn is not _CYCLE and (turned := self._sight(after)) != own:
                    others.setdefault(turned, turn)
        found.states = len(self._reached_by)
        # What was cut off is not gone into.
        for others in found.others.values():
            for sight in [s for s in others if s not in found.others]:
                del others[sight]
        return found

    def _state(
        self, marking: Marking, read: frozenset[int], late: frozenset[int] = frozenset()
    ) -> _State:
        return _State(marking, read, late, self._scheme.nodes.signs(marking))

    def _following(
        self, state: _State, found: Observations
    ) -> Iterator[tuple[ObservedChange, _State]]:
        """States with what leads there."""
        quiet = True
        for owner in self._partition.owners[SUPERVISOR + 1 :]:
            possible = self._scheme.steps(owner.index, state.marking)
            if possible.steps or possible.raises:
                quiet = False
            for step in possible.steps:
                if self._is_overrun(state.marking, dict(step.changes.places)):
                    found.overruns.append((*self._path_to(state), step.text))
                else:
                    marking = step.after(state.marking)
                    late = self._put_late(state, marking, owner.index)
                    yield ObservedChange(step.text), self._state(marking, state.read, late)
        for channel in self._next_published(state):
            quiet = False
            late = state.late - {channel.place}
            yield ObservedChange(f"{channel.file} is published"), replace(state, late=late)
        cycle = self._scheme.cycle(self._published(state))
        if cycle.elements or cycle.stopped:
            quiet = False
        after = self._after_cycle(state)
        if after is not None:
            yield _CYCLE, after
        if quiet:
            marking = self._game.advance_time(state.marking)
            if marking != state.marking:
                later = marking.time - state.marking.time
                after = self._state(self._clock.relative(marking), state.read, state.late)
                yield ObservedChange(f"time goes on by {later}", later), after

    def _put_late(self, state: _State, after: Marking, writer: int) -> frozenset[int]:
        """What is not published yet after an occurrence: of several messages that it puts, none is at first."""
        own = [c.place for c in self._incoming if c.writer == writer]
        put = {p for p in own if after.places[p] and not state.marking.places[p]}
        is_alone = len(put) == 1 and state.late.isdisjoint(own)
        return state.late if is_alone else state.late | put

    def _next_published(self, state: _State) -> Iterator[Channel]:
        """Of each writer the message that it publishes next: data before flags, as the channels of a partition are."""
        late = [c for c in self._incoming if c.place in state.late]
        for writer in {c.writer: None for c in late}:
            yield next(c for c in late if c.writer == writer)

    def _published(self, state: _State) -> Marking:
        """The marking without the messages that are not published yet."""
        places = list(state.marking.places)
        for p in state.late:
            places[p] = self._start.places[p]  # a channel is empty at the start
        return replace(state.marking, places=tuple(places))

    def _after_cycle(self, state: _State) -> _State | None:
        """None: the supervisor stops, or has finished."""
        cycle = self._scheme.cycle(self._published(state))
        if cycle.stopped or self._scheme.is_final(cycle.marking):
            return None
        places = list(cycle.marking.places)
        for p in state.late:
            places[p] = state.marking.places[p]
        after = replace(cycle.marking, places=tuple(places))
        return self._state(after, self._scheme.unconsumed(cycle.marking), state.late)

    def _is_overrun(self, before: Marking, changes: dict[int, object]) -> bool:
        """Whether somebody else writes a message where one is, or two at once."""
        for channel in self._partition.channels:
            tokens = changes.get(channel.place)
            if channel.writer != SUPERVISOR and tokens is not None:
                # Channels hold multi-sets, which have a length.
                held, holds = len(before.places[channel.place]), len(tokens)  # type: ignore[arg-type]
                if holds > 1 or (held and holds):
                    return True
        return False

    def _sight(self, state: _State) -> Observation:
        places = list(self._published(state).places)
        for p in self._unseen:
            places[p] = self._start.places[p]
        marking = replace(state.marking, places=tuple(places))
        return observed(self._scheme, marking, state.read)

    def _path_to(self, state: _State) -> tuple[str, ...]:
        path = []
        while (step := self._reached_by[state]) is not None:
            state, turn = step
            path.append(turn.text)
        return tuple(path[::-1])


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
