"""A robot's script in product with its page: same primitives, same arguments, same messages, on all branches.

    report = explore(partition, config, owner, program, game)

The script is interpreted step by step while all other owners do what the net lets them do, in every order. Where it
announces a transition (`mark`), that transition must be enabled with that binding; the commands since the mark before
must be the calls of primitives that the net makes there; the files that it reads, empties and writes must be the
places. Where it waits or has ended, the page must have nothing to do. What the net leaves open to a sensor is tried
with every value. Messages that one occurrence gives the script come one after the other (I5 of docs/protocol.md), and
it may go on between two of them.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterator, Mapping
from dataclasses import replace

from pn2code.base.how_far import HowFar, Say, silent
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Channel, ChannelKind, Partition
from pn2code.conform.clock import Clock
from pn2code.conform.messages import scalars
from pn2code.conform.places_as_files import DeviationError, PlacesAsFiles, Script
from pn2code.conform.same import is_nothing, is_same, listed
from pn2code.conform.scheme import MOST_STATES, Scheme
from pn2code.conform.script_state import Chosen, RobotReport, State, negative_zeros
from pn2code.net.flat import ArcKind, BindAll, BindRandom, FlatTransition
from pn2code.primitive_calls import Calls, Listener, Unknown
from pn2code.robot import commands
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.marking import BindingElement, Marking, binding_to_json, element_text
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import to_json
from pn2code.semantics.values.data import Timed
from pn2code.tdl.check import CheckedProgram
from pn2code.tdl.requests import (
    AwaitFile,
    Event,
    Execute,
    Fault,
    Finished,
    Marked,
    Request,
    Scalar,
    Sense,
)


class _Product:
    def __init__(
        self,
        partition: Partition,
        config: CellConfig,
        owner: int,
        program: CheckedProgram,
        game: Game,
        most: int,
    ) -> None:
        self._partition = partition
        self._net = partition.net
        self._owner = owner
        self._game = game
        self._most = most
        self._name = partition.owners[owner].name
        self._channels = {
            channel.name: channel.place
            for channel in partition.channels
            if owner in (channel.writer, channel.reader)
        }
        self._incoming = [c for c in partition.channels if c.reader == owner]
        self._late: frozenset[str] = frozenset()
        data = {c.name for c in partition.channels if c.kind is ChannelKind.DATA}
        self._files = PlacesAsFiles(frozenset(data & self._channels.keys()))
        self._listener = Listener(game, config.primitives)
        self._sensors = {s.variable: s.name for s in config.sensors}
        self._called = Calls()
        self._names = {t.name: t for t in self._net.transitions}
        self._scheme = Scheme(partition, game)
        self._clock = Clock(partition.net)
        self._interpreter = Script(program, self._files, self._heard)
        self._marking = self._start = game.marking
        self._done: list[commands.Command] = []
        self._owed = 0.0
        self._chosen = Chosen()
        self._heard_of: list[tuple[str, Scalar]] = []
        self._marked: set[str] = set()
        self._marks = 0
        self._commands = 0

    def run(self, say: Say) -> RobotReport:
        more = HowFar(say, f"comparing {self._name}.tdl", noun="states")
        first = self._timeless(State(self._game.marking, self._interpreter.save(), None))
        parent: dict[State, tuple[State, str] | None] = {first: None}
        waiting = deque([first])
        deviation: str | None = None
        given_up = ""
        at = first
        try:
            while waiting and len(parent) <= self._most:
                at = waiting.popleft()
                more()
                for text, following in self._following(at):
                    after = self._timeless(following)
                    if after not in parent:
                        parent[after] = (at, text)
                        waiting.append(after)
        except DeviationError as found:
            deviation = str(found)
        except GivenUpError as limit:
            given_up = str(limit)
        owners = self._partition.transition_owner
        own = (t for t in self._net.transitions if owners[t.index] == self._owner)
        return RobotReport(
            self._name,
            len(parent),
            self._marks,
            len(self._marked),
            owners.count(self._owner),
            self._commands,
            not waiting and deviation is None and not given_up,
            deviation,
            tuple(self._path(parent, at)) if deviation else (),
            given_up,
            tuple(t.name for t in own if t.name not in self._marked),
        )

    def _path(self, parent: dict[State, tuple[State, str] | None], at: State) -> list[str]:
        path = []
        while (step := parent[at]) is not None:
            at, text = step
            path.append(text)
        return path[::-1]

    # --- what can happen ---------------------------------------------------------------------------

    def _following(self, state: State) -> Iterator[tuple[str, State]]:
        quiet = True
        for owner in self._partition.owners:
            if owner.index == self._owner:
                continue
            possible = self._scheme.steps(owner.index, state.marking)
            if (
                possible.steps or possible.raises
            ):  # an owner that raises stops, and the cell with it
                quiet = False
            for step in possible.steps:
                marking = step.after(state.marking)
                late = self._put_late(state, marking, owner.index)
                yield step.text, replace(state, marking=marking, late=late)
        for channel in self._next_published(state):
            quiet = False
            yield f"{channel.file} is published", replace(state, late=state.late - {channel.name})
        self._late = state.late
        for text, after in self._resumed(state):
            quiet = False
            yield text, after
        if quiet and self._net.timed:
            later = self._later(state)
            if later is not None:
                yield f"time goes on by {later.marking.time - state.marking.time}", later

    def _put_late(self, state: State, after: Marking, writer: int) -> frozenset[str]:
        """What is not published yet after an occurrence: of several messages that it puts, none is at first."""
        own = [c for c in self._incoming if c.writer == writer]
        put = {c.name for c in own if after.places[c.place] and not state.marking.places[c.place]}
        is_alone = len(put) == 1 and state.late.isdisjoint(c.name for c in own)
        return state.late if is_alone else state.late | put

    def _next_published(self, state: State) -> Iterator[Channel]:
        """Of each writer the message that it publishes next: data before flags, as the channels of a partition are."""
        late = [c for c in self._incoming if c.name in state.late]
        for writer in {c.writer: None for c in late}:
            yield next(c for c in late if c.writer == writer)

    def _later(self, state: State) -> State | None:
        """Time goes on to where something can happen."""
        now = state.marking.time
        times = [
            t for t in (self._game.advance_time(state.marking).time, state.until) if t is not None
        ]
        ahead = [t for t in times if t > now]
        if not ahead:
            return None
        time = min(ahead)
        return replace(
            state, marking=replace(state.marking, time=time if self._net.real_time else int(time))
        )

    def _timeless(self, state: State) -> State:
        """The same state with times from its own on, where only those count."""
        if self._clock.is_relative:
            until = None if state.until is None else max(state.until - state.marking.time, 0)
            state = replace(state, marking=self._clock.relative(state.marking), until=until)
        signs = self._scheme.nodes.signs(state.marking), negative_zeros(state.saved)
        return replace(state, signs=signs)

    def _resumed(self, state: State) -> Iterator[tuple[str, State]]:
        """The script goes on, if it can."""
        match state.request:
            case Finished():
                self._nothing_to_do(state, "the script has ended")
            case Fault(message=message, line=line):
                self._chosen = state.chosen
                if not any(map(self._must_stop, self._looked_at(state.marking))):
                    why = f"the script stops in line {line} ({message})"
                    self._nothing_to_do(state, why)
                    self._nothing_to_wait_for(state, why)
            case AwaitFile(names=names, line=line):
                view = self._view(state.marking)
                if any(name in view for name in names):
                    yield self._go(state, None)
                else:
                    awaited = ", ".join(names)
                    self._nothing_to_do(state, f"the script waits for {awaited} in line {line}")
            case Execute(command=commands.Wait()) if state.until is not None:
                if state.marking.time >= state.until:
                    yield self._go(state, None)
            case Execute(command=commands.Measure(nominal=nominal)):
                yield self._go(state, nominal)
            case Sense(sensor=sensor, line=line):
                said = self._said(state, sensor)
                if not said:
                    raise DeviationError(
                        f"line {line} asks sensor `{sensor}`, although the net leaves nothing open to it there"
                    )
                for value in said:
                    yield self._go(state, value)
            case _:
                yield self._go(state, None)

    def _must_stop(self, marking: Marking) -> bool:
        """Whether the first transition that is possible raises an exception, or the question which one it is."""
        first: int | None = None
        try:
            for element in self._scheme.enabled(self._owner, marking):
                if first not in (None, element.transition):
                    break
                first = element.transition
                self._game.occur(marking, element)
        except GivenUpError:
            raise
        except GameError:
            return True
        return False

    def _nothing_to_do(self, state: State, why: str) -> None:
        try:
            element = next(self._scheme.enabled(self._owner, self._published(state.marking)), None)
        except GivenUpError:
            raise
        except GameError as error:
            if isinstance(state.request, AwaitFile):  # it is not asked before the message is there
                return
            raise DeviationError(f"{why}, where the net raises an exception: {error}") from None
        if element is not None:
            text = element_text(self._game.colours, self._net, element)
            raise DeviationError(f"{why}, but according to the net {text} is enabled")
        # A command belongs to a transition, which is announced after it.
        if state.done:
            raise DeviationError(
                f"{why}, but has commanded {listed(state.done)}, which the net does not call"
            )

    def _nothing_to_wait_for(self, state: State, why: str) -> None:
        """A script that stops where it is to wait stops the cell, even if the message never comes.

        It waits where whatever could come next takes the same messages, and not all of them are there.
        """
        names = {c.place: c.name for c in self._incoming}
        marked = [bool(tokens) for tokens in state.marking.places]
        taken = set()
        for t, owner in zip(self._net.transitions, self._partition.transition_owner, strict=True):
            places = [a.place for a in t.arcs if a.kind in (ArcKind.INPUT, ArcKind.BOTH)]
            if owner == self._owner and all(marked[p] or p in names for p in places):
                taken.add(frozenset(names[p] for p in places if p in names))
        missing = frozenset().union(*taken) - self._view(state.marking).keys()
        if len(taken) == 1 and missing:
            raise DeviationError(f"{why}, where its page waits for {', '.join(sorted(missing))}")

    def _said(self, state: State, sensor: str) -> list[Scalar]:
        """Every value that the net leaves open to the sensor here: those of its variable in what is enabled."""
        found: dict[Scalar, None] = {}
        self._chosen = state.chosen
        for marking in self._looked_at(state.marking):
            for element in self._scheme.enabled(self._owner, marking):
                for symbol, value in element.values:
                    if self._sensors.get(symbol.name) != sensor:
                        continue
                    assert symbol.colset is not None, "a net variable has a colour set"
                    data = to_json(symbol.colset, value)
                    if isinstance(data, int | float | bool | str):
                        found[data] = None
        return list(found)

    # --- the script --------------------------------------------------------------------------------

    def _go(self, state: State, result: commands.Pose | Scalar | None) -> tuple[str, State]:
        """Runs it to its next request. What is wrong raises `DeviationError`."""
        self._interpreter.restore(state.saved)
        self._marking = state.marking
        self._done = list(state.done)
        self._owed = state.owed
        self._chosen = state.chosen
        self._heard_of = list(state.said)
        if isinstance(state.request, Sense) and isinstance(result, int | float | bool | str):
            self._heard_of.append((state.request.sensor, result))
        self._files.view = self._view(state.marking)
        self._files.announced = dict(self._files.view)
        self._files.looked = set(state.looked)
        before = self._interpreter.line
        with self._listener.noting(self._called):
            request = self._interpreter.resume(result)
        self._compare_files()
        is_delay = self._owed > 0.0
        until = self._waited(request)
        if isinstance(request, Execute) and until is None:
            self._done.append(request.command)
        if isinstance(request, Execute | Sense) and not is_delay:
            view = frozenset(self._files.view)
            self._chosen = self._chosen.with_view(view, is_certain=until is None)
        after = State(
            self._marking,
            self._interpreter.save(),
            request,
            tuple(self._done),
            tuple(self._heard_of),
            until,
            self._owed,
            frozenset(self._files.looked),
            late=self._late,
            chosen=self._chosen,
        )
        return f"{self._name}: the script goes on after line {before}", after

    def _waited(self, request: Request) -> float | None:
        """When a wait ends that a delay of the net asks for; None: this is no such wait."""
        wait = request.command if isinstance(request, Execute) else None
        if isinstance(wait, commands.Wait) and (self._owed or not wait.duration):
            left = self._owed - wait.duration
            if left < 0 and not is_nothing(left, self._owed):
                raise DeviationError(
                    f"line {self._interpreter.line} waits {wait.duration:g} s; "
                    f"according to the net {self._owed:g} s are left"
                )
            self._owed = 0.0 if is_nothing(left, self._owed) else left
            return self._marking.time + wait.duration
        self._must_not_owe(f"the script goes on in line {self._interpreter.line}")
        return None

    def _must_not_owe(self, where: str) -> None:
        if self._owed:
            raise DeviationError(f"{where} without waiting {self._owed:g} s, the delay of the net")

    def _delay(self, before: Marking, after: Marking) -> float:
        """How long it is until the program's new tokens are available."""
        stamps = [
            token.stamp
            for p, owner in enumerate(self._partition.place_owner)
            if owner == self._owner and before.places[p] != after.places[p]
            for token in (Counter(after.places[p]) - Counter(before.places[p])).elements()
            if isinstance(token, Timed)
        ]
        return max((float(s - after.time) for s in stamps if s > after.time), default=0.0)

    def _heard(self, event: Event) -> None:
        if not isinstance(event, Marked):
            return
        t = self._names.get(event.transition)
        where = f"line {event.line} announces `{event.transition}`"
        self._must_not_owe(where)
        if t is None or self._partition.transition_owner[t.index] != self._owner:
            raise DeviationError(f"{where}, which is no transition of {self._name}")
        for marking, occurred in self._occurrences(t, where):
            if is_same(binding_to_json(occurred), event.binding):
                self._compare_commands(where, tuple(self._called))
                self._compare_sensors(where, t, event.binding)
                self._chosen = Chosen()
                self._owed = self._delay(self._marking, marking)
                self._marking = marking
                self._files.announced = self._view(marking)
                self._marks += 1
                self._marked.add(t.name)
                return
        raise DeviationError(f"{where} with {event.binding}, which {self._why_not(t, event)}")

    def _why_not(self, t: FlatTransition, event: Marked) -> str:
        """Why a transition must not be announced: the script may have chosen it before its messages were there."""
        now = self._scheme.enabled(self._owner, self._published(self._marking))
        if any(e.transition == t.index and is_same(binding_to_json(e), event.binding) for e in now):
            did = f"commanded {listed(tuple(self._done))}" if self._done else "asked its sensors"
            return f"was not enabled according to the net when the script {did}"
        return "is not enabled according to the net"

    def _occurrences(
        self, t: FlatTransition, where: str
    ) -> Iterator[tuple[Marking, BindingElement]]:
        """The ways in which a transition can occur, each with what it leads to; the calls of the last are noted."""
        try:
            for marking in self._looked_at(self._marking):
                for element in self._scheme.enabled(self._owner, marking):
                    if element.transition == t.index:
                        self._called.clear()
                        yield self._game.occur(self._marking, element)
        except GivenUpError:
            raise
        except GameError as error:
            raise DeviationError(f"{where}, where the net raises an exception: {error}") from None

    def _compare_sensors(
        self, where: str, t: FlatTransition, binding: Mapping[str, object]
    ) -> None:
        """What the net leaves open is decided by a sensor, not by the script."""
        said = dict(self._heard_of)
        self._heard_of.clear()
        for step in t.plan:
            if not isinstance(step, BindAll | BindRandom):
                continue
            name = step.symbol.name
            sensor = self._sensors.get(name)
            if sensor is not None and sensor not in said:
                raise DeviationError(
                    f"{where} with {name} = {binding[name]}, but has not asked the sensor `{sensor}`"
                )
            if sensor is not None and said[sensor] != binding[name]:
                raise DeviationError(
                    f"{where} with {name} = {binding[name]}, but the sensor `{sensor}` has said {said[sensor]}"
                )

    def _compare_commands(self, where: str, called: tuple[commands.Command | Unknown, ...]) -> None:
        done = tuple(self._done)
        self._done.clear()
        self._commands += len(done)
        # A wait for no time is like that of a delay of zero, and like none.
        called = tuple(c for c in called if c != commands.Wait(0.0))
        if done != called:
            raise DeviationError(
                f"{where}: the script has commanded {listed(done)}, the net calls {listed(called)}"
            )

    def _published(self, marking: Marking) -> Marking:
        """The marking without the messages that are not published yet."""
        if not self._late:
            return marking
        places = list(marking.places)
        for name in self._late:
            place = self._channels[name]
            places[place] = self._start.places[place]  # a channel is empty at the start
        return replace(marking, places=tuple(places))

    def _looked_at(self, marking: Marking) -> Iterator[Marking]:
        """The marking as the script may have seen it when it chose."""
        published = self._published(marking)
        if not self._chosen.is_over:
            yield published
        for held in self._chosen.held:
            places = list(published.places)
            for channel in self._incoming:
                if channel.name not in held:
                    places[channel.place] = self._start.places[channel.place]
            yield replace(published, places=tuple(places))

    def _view(self, marking: Marking) -> dict[str, tuple[Scalar, ...]]:
        found = {}
        for name, place in self._channels.items():
            tokens = list(marking.places[place])
            if tokens and name not in self._late:
                found[name] = scalars(self._net.places[place].colset, tokens[0])
        return found

    def _compare_files(self) -> None:
        expected = self._view(self._marking)
        if not is_same(self._files.view, expected):
            raise DeviationError(
                f"after line {self._interpreter.line} the files hold {self._files.view}, "
                f"but {expected} according to the net"
            )


def explore(
    partition: Partition,
    config: CellConfig,
    owner: int,
    program: CheckedProgram,
    game: Game,
    *,
    most: int = MOST_STATES,
    say: Say = silent,
) -> RobotReport:
    """Compares a script with its page in every state that can be reached.

    Args:
        partition: the net and its owners.
        config: the cell: which functions of the net are primitives.
        owner: of the page.
        program: the script, checked.
        game: a token game at the marking from which the cell starts.
        most: states.
        say: hears in words how far it is.
    """
    return _Product(partition, config, owner, program, game, most).run(say)
