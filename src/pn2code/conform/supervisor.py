"""The supervisor program beside the net: in every reachable state, for every message that may arrive, what it writes
and the marking that it comes to are those of the net.

    report = explore(partition, game, probe)

First the closed net is explored for what the supervisor may come to see (`observations.py`). Then the program is led
through all of that. From each sight either the others' messages are published as real ones are, or the supervisor goes
round its cycle: the program itself, and beside it the scheme in the token game. Files are read as a robot reads them:
with session, number and checksum. Sights are visited depth first: the program's state is a process that waits.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.base.how_far import HowFar, Say, silent
from pn2code.cell.partition import SUPERVISOR, ChannelKind, Partition
from pn2code.channels.message import EMPTY, ChannelSpec, Message, compose, parse, specs_of
from pn2code.conform.clock import Clock
from pn2code.conform.messages import scalars
from pn2code.conform.observations import Observation, ObservedChange, look, observed
from pn2code.conform.probe import SESSION, Answer, Probe
from pn2code.conform.scheme import MOST_STATES, Scheme
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.marking import Marking, place_from_json, place_text
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colour_json import JsonError

MOST_DEPTH = 4000
"""Saved states at a time, each of which is a process."""


@frozen
class Deviation:
    """Where the program does something else than the net.

    Args:
        what: in words: the file or place, what was expected, what came.
        way: what happened before, from the start.
    """

    what: str
    way: tuple[str, ...]


@record
class Report:
    """What was compared.

    Args:
        states: of the closed net: markings, with what the program has read of them.
        sights: what the supervisor can tell apart of these; it was led through each of them.
        cycles: of the program, each compared.
        firings: of the supervisor in these.
        transitions: indices of those that occurred in these, of the `all_transitions` that are the supervisor's.
        idle: names of the others, in order of the net.
        received, sent: messages to and from the supervisor.
        stops: cycles in which it had to stop, and did.
        complete: every state that can be reached was seen; otherwise `why` says what ended it.
        deviation: None: there is none.
    """

    states: int = 0
    sights: int = 0
    cycles: int = 0
    firings: int = 0
    transitions: set[int] = field(default_factory=set)
    all_transitions: int = 0
    idle: tuple[str, ...] = ()
    received: int = 0
    sent: int = 0
    stops: int = 0
    complete: bool = True
    why: str = ""
    deviation: Deviation | None = None
    overruns: list[tuple[str, ...]] = field(default_factory=list)
    """Ways to messages that came while the one before had not been taken: a flaw of the net, not of the program."""


class _DeviationError(Exception):
    """The program does something else; the text says what."""


@frozen
class _State:
    """What the program is in. What it does depends on the sight alone.

    Args:
        sight: what it sees.
        time: its clock.
        sent: the number of messages so far in each channel, in the order of the partition.
    """

    sight: Observation
    time: float
    sent: tuple[int, ...]


@frozen
class _Move:
    """Something that can happen. `sight`: what it leads to; None: it is the supervisor's cycle."""

    turn: ObservedChange
    sight: Observation | None


_CYCLE = _Move(ObservedChange("the supervisor's cycle"), None)


class _Product:
    def __init__(self, partition: Partition, game: Game, probe: Probe, most: int, say: Say) -> None:
        self._more = HowFar(say, "comparing the supervisor", noun="states")
        self._partition = partition
        self._net = partition.net
        self._game = game
        self._probe = probe
        self._scheme = Scheme(partition, game)
        self._clock = Clock(partition.net)
        self._sights = look(partition, game, self._scheme, self._clock, most)
        self._specs: tuple[ChannelSpec, ...] = specs_of(partition)
        self._own = [
            p
            for p in self._net.places
            if partition.place_owner[p.index] == SUPERVISOR
            and all(c.place != p.index for c in partition.channels)
        ]
        self.report = Report(
            states=self._sights.states,
            all_transitions=partition.transition_owner.count(SUPERVISOR),
            complete=self._sights.complete,
            why="" if self._sights.complete else f"more than {most} states",
            overruns=self._sights.overruns,
        )
        self._is_first = True  # before its first cycle the program makes the files
        self._path: list[_Move] = []
        self._seen: set[Observation] = set()
        self._late: list[tuple[_Move, ...]] = []  # ways to sights that are too deep to go on from

    def run(self) -> Report:
        net, owners = self._partition.net, self._partition.transition_owner
        try:
            self._run()
        except _DeviationError as deviation:
            self.report.deviation = Deviation(str(deviation), self._path_text())
            self.report.complete = False
            self.report.why = "deviation"
        except GivenUpError as limit:
            self.report.complete = False
            self.report.why = str(limit)
        self.report.sights = len(self._seen)
        own = (t for t in net.transitions if owners[t.index] == SUPERVISOR)
        self.report.idle = tuple(t.name for t in own if t.index not in self.report.transitions)
        return self.report

    def _run(self) -> None:
        none_sent = (0,) * len(self._partition.channels)
        initial = self._game.marking
        sight = observed(self._scheme, self._clock.relative(initial), frozenset())
        start = _State(sight, initial.time, none_sent)
        first = self._compared(start, self._probe.first)
        if first is None:
            return
        self._is_first = False
        self._seen.add(first.sight)
        self._visit(first)
        while self._late:
            moves = self._late.pop()
            self._probe.push()
            self._visit(self._led(first, moves))
            self._probe.pop()
            self._path.clear()

    def _led(self, state: _State, moves: tuple[_Move, ...]) -> _State:
        """Leads the program along a way on which it has been before, and saves nothing."""
        for move in moves:
            self._path.append(move)
            after = self._made(state, move)
            assert after is not None, "the way went on"
            state = after
        return state

    def _visit(self, start: _State) -> None:
        """All that can be reached from the state that the program is in; in the end it is in that again."""
        stack = [(start, self._moves(start))]
        while stack:
            state, moves = stack[-1]
            move = next(moves, None)
            if move is None:
                stack.pop()
                if stack:
                    self._probe.pop()
                    self._path.pop()
            elif move.sight not in self._seen:
                depth = self._probe.depth
                self._path.append(move)
                self._probe.push()
                after = self._made(state, move)
                if after is not None and after.sight not in self._seen:
                    self._seen.add(after.sight)
                    self._more()
                    if len(stack) < MOST_DEPTH:
                        stack.append((after, self._moves(after)))
                        continue
                    self._late.append(tuple(self._path))
                self._path.pop()
                if self._probe.depth > depth:  # a program that has ended is back already
                    self._probe.pop()

    def _moves(self, state: _State) -> Iterator[_Move]:
        yield _CYCLE
        for sight, turn in self._sights.others.get(state.sight, {}).items():
            yield _Move(turn, sight)

    def _made(self, state: _State, move: _Move) -> _State | None:
        """Makes a move in the program; the state after it, None where the way ends."""
        if move.sight is None:
            return self._compared(state, self._probe.go())
        files, sent = self._published(state, move.sight.marking)
        time = state.time + move.turn.later
        self._probe.write(files, float(time) if time != state.time else None)
        return _State(move.sight, time, sent)

    def _published(
        self, state: _State, after: Marking
    ) -> tuple[list[tuple[str, str]], tuple[int, ...]]:
        """What the others have done to the files: messages that they have written, and those that they have taken."""
        files: list[tuple[str, str]] = []
        sent = list(state.sent)
        for i, channel in enumerate(self._partition.channels):
            tokens = list(after.places[channel.place])
            if tokens == list(state.sight.marking.places[channel.place]):
                continue
            if channel.writer == SUPERVISOR:
                files.append((channel.file, EMPTY))
                continue
            sent[i] += 1
            values = scalars(self._net.places[channel.place].colset, tokens[0])
            content = compose(self._specs[i], values, seq=sent[i], session=SESSION)
            if content is None:
                raise _DeviationError(f"the token {values} cannot be written to {channel.file}")
            files.append((channel.file, content))
            self.report.received += 1
        return files, tuple(sent)

    def _path_text(self) -> tuple[str, ...]:
        return tuple(move.turn.text for move in self._path)

    # --- comparison ------------------------------------------------------------------------------

    def _compared(self, state: _State, answer: Answer) -> _State | None:
        """The state after a cycle of which the program has said what it did; None where it ends."""
        before = state.sight.marking
        expected = self._scheme.cycle(before)
        self.report.cycles += 1
        self.report.firings += len(expected.elements)
        self.report.transitions.update(e.transition for e in expected.elements)
        if expected.is_overrun:
            self.report.overruns.append(self._path_text())
        if expected.stopped:
            if answer.ended != "stopped":
                raise _DeviationError(
                    f"the supervisor has to stop ({expected.stopped}), but it goes on"
                )
            self.report.stops += 1
            return None
        if answer.ended == "stopped":
            raise _DeviationError(f"the supervisor stops: {answer.reason}; the net goes on")
        if answer.fired != len(expected.elements):
            raise _DeviationError(
                f"the supervisor fires {answer.fired} times, but {len(expected.elements)} times according to the net"
            )
        self._compare_places(state.time, expected.marking, answer.marking)
        sent = self._compare_files(state, expected.marking, answer.files)
        if not self._is_first:
            self._compare_order(before, expected.marking, answer.published)
            self._compare_reading(answer.read)
        is_final = self._scheme.is_final(expected.marking)
        if is_final != (answer.ended == "finished"):
            raise _DeviationError(
                "the supervisor ends, but no final place holds a token"
                if answer.ended
                else "a final place holds a token, but the supervisor goes on"
            )
        if answer.ended:
            return None
        read = self._scheme.unconsumed(expected.marking)
        sight = observed(self._scheme, self._clock.relative(expected.marking), read)
        return _State(sight, state.time, sent)

    def _compare_places(self, now: float, expected: Marking, told: Mapping[str, object]) -> None:
        for p in self._own:
            try:
                found = self._clock.tokens(place_from_json(p.colset, told.get(p.name)), now)
            except JsonError as error:  # its tables of names are others, too
                raise _DeviationError(f"place `{p.name}` in the program: {error}") from None
            wanted = self._clock.tokens(expected.places[p.index], expected.time)
            if found != wanted:
                is_, should = (place_text(self._game.colours, p.colset, x) for x in (found, wanted))
                raise _DeviationError(
                    f"place `{p.name}` holds {is_}, but {should} according to the net"
                )

    def _compare_order(self, before: Marking, after: Marking, published: tuple[str, ...]) -> None:
        """What was consumed is emptied first (I4), then data are published, then flags (I5)."""
        emptied, written = [], []
        for channel in self._partition.channels:
            held, holds = (len(m.places[channel.place]) for m in (before, after))
            if channel.reader == SUPERVISOR and held > holds:
                emptied.append(channel.file)
            elif channel.writer == SUPERVISOR and holds > held:
                written.append(channel.file)
        # The channels of a partition are in this order: data before flags.
        if published != (expected := (*emptied, *written)):
            raise _DeviationError(
                f"files are replaced in the order {', '.join(published) or 'none'}; according to docs/protocol.md "
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
                f"files are read in the order {', '.join(found) or 'none'}; according to docs/protocol.md "
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
                    raise _DeviationError(
                        f"{channel.file} holds {text!r}, but nothing according to the net"
                    )
                continue
            is_new = channel.writer == SUPERVISOR and not state.sight.marking.places[channel.place]
            if is_new:
                sent[i] += 1
                self.report.sent += 1
            colset = self._net.places[channel.place].colset
            values = scalars(colset, tokens[0])
            found = parse(self._specs[i], text, session=SESSION, consumed=sent[i] - 1)
            if not isinstance(found, Message):
                said = "nothing" if found is None else found.text
                raise _DeviationError(f"{channel.file}: {said}; according to the net {values}")
            if found.scalars != values or found.seq != sent[i]:
                raise _DeviationError(
                    f"{channel.file} holds {found.scalars}, number {found.seq}; according to the net {values}, "
                    f"number {sent[i]}"
                )
        return tuple(sent)


def explore(
    partition: Partition, game: Game, probe: Probe, most: int = MOST_STATES, say: Say = silent
) -> Report:
    """Compares the program with the net in every state that can be reached.

    Args:
        partition: the net and its owners.
        game: a token game at the marking from which the program started.
        probe: the program, after its first cycle.
        most: states at most.
        say: hears in words how far it is.

    Raises:
        ProbeError: the program does not answer.
    """
    try:
        return _Product(partition, game, probe, most, say).run()
    except GivenUpError as limit:  # before the program was asked anything
        return Report(complete=False, why=str(limit))
