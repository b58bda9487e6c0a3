"""The supervisor program in product with the net: in every reachable state, for every message that may arrive, what it
writes and the marking that it comes to are those of the net.

    report = explore(partition, game, probe, Limits())

A state is a marking of the closed net, with what the program has read so far. From each state the other owners do what
the net lets them do (their messages are published as real ones are), or the supervisor goes round its cycle: the
program itself, and beside it the scheme in the token game. Files are read as a robot reads them: with session, number
and checksum. States are visited depth first, since the program's state is a process that waits to be continued.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from pn2code.cell.partition import ChannelKind, Partition
from pn2code.channels.message import EMPTY, ChannelSpec, Message, compose, parse, specs_of
from pn2code.conform.messages import scalars
from pn2code.conform.probe import SESSION, Answer, Probe
from pn2code.conform.scheme import SUPERVISOR, Scheme
from pn2code.semantics.game import Game, GameError
from pn2code.semantics.marking import (
    BindingElement,
    Marking,
    element_text,
    place_from_json,
    place_text,
)

MOST_DEPTH = 4000
"""Saved states, each of which is a process."""


@dataclass(frozen=True, slots=True)
class Limits:
    """How far. `seconds`: None means no limit."""

    states: int = 20_000
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Deviation:
    """Where the program does something else than the net.

    Args:
        what: in words: the file or place, what was expected, what came.
        way: what happened before, from the start.
    """

    what: str
    way: tuple[str, ...]


@dataclass(slots=True)
class Report:
    """What was compared.

    Args:
        states: markings with what was read of them.
        cycles: of the program, each compared.
        firings: of the supervisor in these.
        transitions: indices of those that occurred in these, of the `all_transitions` that are the supervisor's.
        received, sent: messages to and from the supervisor.
        stops: cycles in which it had to stop, and did.
        complete: every state that can be reached was seen; otherwise `why` says what ended it.
        deviation: None: there is none.
    """

    states: int = 0
    cycles: int = 0
    firings: int = 0
    transitions: set[int] = field(default_factory=set)
    all_transitions: int = 0
    received: int = 0
    sent: int = 0
    stops: int = 0
    complete: bool = True
    why: str = ""
    deviation: Deviation | None = None
    overruns: list[tuple[str, ...]] = field(default_factory=list)
    """Ways to messages that came while the one before had not been taken: a flaw of the net, not of the program."""


@dataclass(frozen=True, slots=True)
class _State:
    """Args:
    marking: of the closed net.
    read: channels whose message the program has made a token.
    sent: for each channel the number of messages so far, in the order of the partition.
    """

    marking: Marking
    read: frozenset[int]
    sent: tuple[int, ...]

    @property
    def key(self) -> tuple[Marking, frozenset[int]]:
        """Numbers of messages are not told apart: what is done does not depend on them, and they never end."""
        return self.marking, self.read


class _DeviationError(Exception):
    """The program does something else; the text says what."""


@dataclass(frozen=True, slots=True)
class _Move:
    """Something that can happen.

    Args:
        text: in words.
        after: the state that it leads to; None: the supervisor's cycle, whose state the program has to tell.
        files: what other parties publish.
        seconds: what the clock shows from then on, None: as before.
    """

    text: str
    after: _State | None = None
    files: tuple[tuple[str, str], ...] = ()
    seconds: float | None = None


class _Product:
    def __init__(self, partition: Partition, game: Game, probe: Probe, limits: Limits) -> None:
        self._partition = partition
        self._net = partition.net
        self._game = game
        self._probe = probe
        self._limits = limits
        self._scheme = Scheme(partition, game)
        self._specs: tuple[ChannelSpec, ...] = specs_of(partition)
        self._own = [
            p
            for p in self._net.places
            if partition.place_owner[p.index] == SUPERVISOR
            and all(c.place != p.index for c in partition.channels)
        ]
        self.report = Report(all_transitions=partition.transition_owner.count(SUPERVISOR))
        self._ends = time.monotonic() + (limits.seconds or 0.0)
        self._way: list[str] = []
        self._is_first = True  # before its first cycle the program makes the files

    def run(self) -> Report:
        try:
            self._run()
        except _DeviationError as deviation:
            self.report.deviation = Deviation(str(deviation), tuple(self._way))
            self.report.complete = False
            self.report.why = "deviation"
        return self.report

    def _run(self) -> None:
        start = _State(self._game.marking, frozenset(), (0,) * len(self._partition.channels))
        first = self._compared(start, self._probe.first)
        if first is None:
            return
        self._is_first = False
        seen = {first.key}
        stack = [(first, self._moves(first))]
        while stack and not self._is_over(len(seen)):
            state, moves = stack[-1]
            move = next(moves, None)
            if move is None:
                stack.pop()
                if stack:
                    self._probe.pop()
                    self._way.pop()
            elif move.after is None or move.after.key not in seen:
                after = self._made(state, move)
                if after is None or after.key in seen or len(stack) >= MOST_DEPTH:
                    if after is not None and after.key not in seen:
                        self._stop(f"a way is longer than {MOST_DEPTH} moves")
                    self._back(len(stack))
                else:
                    seen.add(after.key)
                    stack.append((after, self._moves(after)))

    def _made(self, state: _State, move: _Move) -> _State | None:
        """Makes a move in the program; the state after it, None where the way ends."""
        self._way.append(move.text)
        self._probe.push(move.files, move.seconds)
        return move.after or self._compared(state, self._probe.go())

    def _back(self, depth: int) -> None:
        """Takes back the last move; a program that has ended in it is back already."""
        self._way.pop()
        if self._probe.depth == depth:
            self._probe.pop()

    def _is_over(self, states: int) -> bool:
        self.report.states = states
        if states >= self._limits.states:
            self._stop(f"more than {self._limits.states} states")
            return True
        if self._limits.seconds is not None and time.monotonic() > self._ends:
            self._stop(f"more than {self._limits.seconds:g} s")
            return True
        return False

    def _stop(self, why: str) -> None:
        self.report.complete = False
        self.report.why = why

    # --- moves -----------------------------------------------------------------------------------

    def _moves(self, state: _State) -> Iterator[_Move]:
        """What can happen in a state; a way ends where the net raises an exception."""
        quiet = True
        cycle = self._scheme.cycle(state.marking)
        incoming = frozenset(self._incoming(state.marking))
        try:
            for element in self._scheme.others(state.marking):
                quiet = False
                move = self._other(state, element)
                if move is not None:
                    yield move
        except GameError:
            quiet = False
        if cycle.elements or cycle.stopped:
            quiet = False
        if not quiet or incoming != state.read:
            yield _Move("the supervisor's cycle")
        if quiet and self._net.timed:
            later = self._game.settle(state.marking)
            if later != state.marking:
                after = replace(state, marking=later)
                yield _Move(f"time {later.time}", after, seconds=float(later.time))

    def _other(self, state: _State, element: BindingElement) -> _Move | None:
        """Another owner's occurrence; its messages are published, what it has taken is emptied."""
        text = element_text(self._game.colours, self._net, element)
        try:
            marking, _ = self._game.occur(state.marking, element)
        except GameError:
            return None
        sent = list(state.sent)
        files: list[tuple[str, str]] = []
        for i, channel in enumerate(self._partition.channels):
            before = list(state.marking.places[channel.place])
            after = list(marking.places[channel.place])
            if before == after:
                continue
            if channel.writer == SUPERVISOR:
                files.append((channel.file, EMPTY))
                continue
            if before or len(after) > 1:
                self.report.overruns.append((*self._way, text))
                return None
            sent[i] += 1
            values = scalars(self._net.places[channel.place].colset, after[0])
            content = compose(self._specs[i], values, seq=sent[i], session=SESSION)
            if content is None:
                raise _DeviationError(f"the token {values} cannot be written to {channel.file}")
            files.append((channel.file, content))
            self.report.received += 1
        return _Move(text, _State(marking, state.read, tuple(sent)), tuple(files))

    # --- comparison ------------------------------------------------------------------------------

    def _incoming(self, marking: Marking) -> Iterator[int]:
        for i, channel in enumerate(self._partition.channels):
            if channel.reader == SUPERVISOR and len(list(marking.places[channel.place])) > 0:
                yield i

    def _compared(self, state: _State, answer: Answer) -> _State | None:
        """The state after a cycle of which the program has said what it did; None where it ends."""
        self.report.cycles += 1
        expected = self._scheme.cycle(state.marking)
        self.report.firings += len(expected.elements)
        self.report.transitions.update(e.transition for e in expected.elements)
        stopped = expected.stopped or self._overrun(expected.marking)
        if stopped:
            if answer.ended != "stopped":
                raise _DeviationError(f"the supervisor has to stop ({stopped}), but it goes on")
            self.report.stops += 1
            return None
        if answer.ended == "stopped":
            raise _DeviationError(f"the supervisor stops: {answer.reason}; the net goes on")
        if answer.fired != len(expected.elements):
            raise _DeviationError(
                f"the supervisor fires {answer.fired} times, by the net {len(expected.elements)} times"
            )
        self._compare_places(expected.marking, answer.marking)
        sent = self._compare_files(state, expected.marking, answer.files)
        if not self._is_first:
            self._compare_order(state.marking, expected.marking, answer.published)
            self._compare_reading(answer.read)
        is_final = any(
            len(list(expected.marking.places[p])) > 0 for p in self._partition.final_places
        )
        if is_final != (answer.ended == "finished"):
            raise _DeviationError(
                "the supervisor ends, but no final place holds a token"
                if answer.ended
                else "a final place holds a token, but the supervisor goes on"
            )
        if answer.ended:
            return None
        return _State(expected.marking, frozenset(self._incoming(expected.marking)), sent)

    def _overrun(self, marking: Marking) -> str:
        for channel in self._partition.channels:
            tokens = len(list(marking.places[channel.place]))
            if channel.writer == SUPERVISOR and tokens > 1:
                self.report.overruns.append(tuple(self._way))
                return f"{tokens} messages for {channel.file}"
        return ""

    def _compare_places(self, expected: Marking, told: Mapping[str, object]) -> None:
        for p in self._own:
            found = place_from_json(p.colset, told[p.name])
            if found != expected.places[p.index]:
                is_, should = (
                    place_text(self._game.colours, p.colset, x)
                    for x in (found, expected.places[p.index])
                )
                raise _DeviationError(f"place `{p.name}` holds {is_}, by the net {should}")

    def _compare_order(self, before: Marking, after: Marking, published: tuple[str, ...]) -> None:
        """What was consumed is emptied first (I4), then data are published, then flags (I5)."""
        emptied, written = [], []
        for channel in self._partition.channels:
            held, holds = (len(list(m.places[channel.place])) for m in (before, after))
            if channel.reader == SUPERVISOR and held > holds:
                emptied.append(channel.file)
            elif channel.writer == SUPERVISOR and holds > held:
                written.append(channel.file)
        # The channels of a partition are in this order: data before flags.
        if published != (expected := (*emptied, *written)):
            raise _DeviationError(
                f"files are replaced in the order {', '.join(published) or 'none'}; by docs/protocol.md "
                f"{', '.join(expected) or 'none'}"
            )

    def _compare_reading(self, read: tuple[str, ...]) -> None:
        """Flags are read before data (I5)."""
        incoming = [c for c in self._partition.channels if c.reader == SUPERVISOR]
        expected = [c.file for c in incoming if c.kind is ChannelKind.FLAG]
        expected += [c.file for c in incoming if c.kind is ChannelKind.DATA]
        found = [name for name in read if name in expected]
        if found != expected:
            raise _DeviationError(
                f"files are read in the order {', '.join(found) or 'none'}; by docs/protocol.md "
                f"{', '.join(expected) or 'none'}"
            )

    def _compare_files(
        self, state: _State, expected: Marking, files: Mapping[str, str]
    ) -> tuple[int, ...]:
        """Each file holds the token of its place; gives the numbers of messages."""
        sent = list(state.sent)
        for i, channel in enumerate(self._partition.channels):
            tokens = list(expected.places[channel.place])
            text = files.get(channel.file)
            if text is None:
                raise _DeviationError(f"the file {channel.file} is missing")
            if not tokens:
                if text != EMPTY:
                    raise _DeviationError(f"{channel.file} holds {text!r}, by the net nothing")
                continue
            is_new = channel.writer == SUPERVISOR and not list(state.marking.places[channel.place])
            if is_new:
                sent[i] += 1
                self.report.sent += 1
            colset = self._net.places[channel.place].colset
            values = scalars(colset, tokens[0])
            found = parse(self._specs[i], text, session=SESSION, consumed=sent[i] - 1)
            if not isinstance(found, Message):
                said = "nothing" if found is None else found.text
                raise _DeviationError(f"{channel.file}: {said}; by the net {values}")
            if found.scalars != values or found.seq != sent[i]:
                raise _DeviationError(
                    f"{channel.file} holds {found.scalars}, number {found.seq}; by the net {values}, "
                    f"number {sent[i]}"
                )
        return tuple(sent)


def explore(partition: Partition, game: Game, probe: Probe, limits: Limits | None = None) -> Report:
    """Compares the program with the net in every state that can be reached.

    Args:
        partition: the net and its owners.
        game: a token game at the marking from which the program started.
        probe: the program, after its first cycle.
        limits: how far.

    Raises:
        ProbeError: the program does not answer.
    """
    return _Product(partition, game, probe, limits or Limits()).run()
