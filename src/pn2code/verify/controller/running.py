"""The cell as it runs, as a net: what each program sees and when, around the transitions of the closed net.

    running = Running.of(partition)          # or NotModelledError
    running.net                              # places and transitions of the net keep their numbers; steps are added
    running.lines(first=True)                # for the explorer: owners, priorities, choices

The places of the net mean what they mean in the net: a channel holds its token from the moment it is put until it is
taken. Added are flags of which others know nothing:

    supervisor   idle --sees c--> looks at the next file -- ... --> calm --fires--> calm --publishes c--> calm --> idle
                 (or, with a token in a final place: over)
    channel      `seen`: the supervisor has read the message; `out`: it has been published

* A transition of the supervisor needs *calm*, and takes only messages that have been *seen*. A round of looks goes from
  file to file, flags first; a look that finds nothing leaves no trace, so a round begins with the first file that holds
  something: those before it were looked at earlier, and may have been filled since.
* A robot takes only messages that are *out*. What it writes is there at once, as nothing tells that from writing a
  little later, unless one reader gets two messages of one kind (`NotModelledError`). Only where a transition writes to
  several readers, or somebody acts on data without the flag that is written after them, its messages are *out* one
  after the other: who has the first one may act before the next is written.
* A script that looks at a register (`registers`) asks for its message before anything else when it has come to a state.
  So it does anything else there only after a step *passes*, which finds no message. One that comes after this step may
  be seen or not. Where it waits, something that it does later has woken it, whose message is there when it asks.
* When the supervisor has finished, a robot ends where it notices that (docs/protocol.md, I9): as likely before its next
  message as after it. One step ends them all, since any of them may have been slow until then.
* Where a script stops, the cell stops: nothing happens after the step that says so. What others do until they hear of
  it comes before this step, which may come late: the supervisor ends its cycle, and looks at the robots between two.
* Emptying a file is no step: whoever writes a second message without having heard that the first one was taken may do
  so before it is taken, too; then the place holds two.
* Time: a step of the clock may come whenever something is waited for, whether or not something else is enabled: the
  supervisor comes late, a move takes longer than its page says. Only within the supervisor's firing no time goes by.
  Each step of the clock may wake the supervisor.

So each run of the cell is a run of this net, and each run of this net, without the added steps, is an occurrence
sequence of the closed net in which priorities count among the transitions of an owner.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.whole_file import whole_file
from pn2code.cell.partition import SUPERVISOR, Channel, ChannelKind, Partition
from pn2code.ml.core import terms as core
from pn2code.net.builder import Arc, Builder
from pn2code.net.flat import ArcKind, BindEquation, FlatNet, FlatTransition, Form, Role
from pn2code.net.predicate import Predicate
from pn2code.robot_scripts.machine import Machine, Step
from pn2code.trace.parties import EVIDENCE, VERIFY
from pn2code.verify.controller.moments import Moments
from pn2code.verify.controller.not_modelled import NotModelledError, check_modelled
from pn2code.verify.controller.poses import Bad
from pn2code.verify.controller.refusals import refusing
from pn2code.verify.controller.rival_transitions import meek
from pn2code.verify.controller.silence import Ready, Silence
from pn2code.verify.controller.staged_channels import staged
from pn2code.verify.controller.stops import NoProgramError, machine, waits
from pn2code.verify.controller.unanswered import unanswered
from pn2code.verify.controller.unsure import Conditions
from pn2code.verify.exploring.elements import colours

OWING = "has finished, but it owes an answer"
"""A step that stops the cell."""
_WORDS = 200
"""Of a line."""


@frozen
class Running:
    """The net, and what is needed to ask about it.

    Args:
        net: with the added places and steps; those of the cell's net come first.
        partition: the cell.
        over: the place of the supervisor's end.
        stopped: that of robots whose scripts have stopped; the cell stops then.
        steps: by added transition, in order: whose step it is (the clock has the number after the last owner's).
        clock: which of them are steps of the clock; `probes`: which never occur, and only hold others back.
        moments: which steps may happen in one moment.
        meek: transitions that hold no other one of their robot back: their messages may not have come yet.
    """

    net: FlatNet
    partition: Partition
    over: int
    stopped: int
    steps: tuple[int, ...]
    clock: tuple[int, ...]
    probes: tuple[int, ...]
    meek: tuple[int, ...]
    moments: Moments
    names: frozenset[str]
    """of the transitions of the cell's net"""
    resting: int
    """the place of a supervisor that rests"""
    firing: int
    """that of one that has read, and fires"""
    owing: Mapping[int, int]
    """by robot or device that gets flags: the place that is marked while it owes an answer"""
    ending: int | None = None
    """the step that ends the robots after the supervisor; None: there is none"""
    silences: tuple[Silence, ...] = ()
    unsure: int | None = None
    """the place that is marked where a condition of a script that waits has raised an exception; None: none can"""

    @staticmethod
    def of(
        partition: Partition,
        predicates: Sequence[Predicate] = (),
        moves: Sequence[Bad] = (),
        *,
        loose: bool = False,
    ) -> Running:
        """That of a cell; `predicates` are asked of it, and `moves` are what its arms cannot do.

        Args:
            loose: a net that does more, in which programs depend less on each other (docs/reductions.md): a script that
                stops stops nobody else, whenever it comes to that, and robots go on after the supervisor's end. Where
                no script stops, nothing else is different.

        Raises:
            NoPatternError: what such a move depends on cannot be compared.
            NotModelledError: not everything that its programs do can be said so.
        """
        check_modelled(partition, predicates)
        try:
            return _Composer(partition, moves, loose=loose).made()
        except NoProgramError as problem:
            raise NotModelledError(str(problem)) from None
        except ValueError as problem:
            raise NotModelledError(
                f"the net does not show when a script waits: {problem}"
            ) from None

    def steps_that_come(self) -> Iterator[int]:
        """The steps of programs that are taken sooner or later: not those of the clock, or that stop the cell."""
        count = len(self.partition.net.transitions)
        others = {*self.clock, *self.probes}
        ends = {p for p in (self.stopped, self.unsure) if p is not None}
        for t in self.net.transitions[count:]:
            if t.index not in others and not any(
                a.place in ends and a.kind is ArcKind.OUTPUT for a in t.arcs
            ):
                yield t.index

    def lines(
        self, *, first: bool, names: Sequence[str] | None = None, at_once: bool = False
    ) -> list[str]:
        """How the programs choose.

        Args:
            first: whether of the supervisor's binding elements only the first in the documented order occurs.
            at_once: everything may happen in one moment, whatever it is; so a longest run is one of all steps.
            names: where transitions of the net were made several (`properties.split`): of each, that of the whole one.
        """
        whole = [t.name for t in self.net.transitions]
        parts: dict[str, list[int]] = {}
        for i, name in enumerate(names or whole):
            parts.setdefault(name, []).append(i)

        def now(old: Iterable[int]) -> Iterator[int]:
            return (i for k in old for i in parts[whole[k]])

        owners = self.owners()
        count = len(self.partition.net.transitions)
        lines: list[str] = []
        for owner in sorted(set(owners)):
            lines += chunks(f"owner {owner}", now(i for i, o in enumerate(owners) if o == owner))
        lines.append("priorities own")
        for owner in range(len(self.partition.owners)):
            own = [i for i, o in enumerate(self.partition.transition_owner) if o == owner]
            if owner != SUPERVISOR:
                lines += chunks(f"choose {owner + 1}", now(own))
            elif first:
                lines += chunks("first 1", now(own))
        lines += [" ".join(["kin", *map(str, own)]) for own in parts.values() if len(own) > 1]
        lines += chunks("meek", now(self.meek))
        for number, steps in enumerate(self.moments.sets()):
            those = range(len(owners)) if at_once else steps.transitions
            lines += chunks(f"instant {number}", now(those))
        lines += chunks("silent", now(range(count, count + len(self.steps))))
        lines += chunks("clock", now(self.clock))
        lines += chunks("probe", now(self.probes))
        return lines

    def owners(self) -> tuple[int, ...]:
        """By transition: whose it is."""
        return (*self.partition.transition_owner, *self.steps)

    def project(self, trace: Path, loop: int | None = None) -> tuple[int, int | None]:
        """Makes a run of this net one of the cell's net, in place; gives its length and where its cycle begins.

        Raises:
            OSError: it cannot be read or written.
        """
        kept: list[str] = []
        steps = seen = 0
        begins = None
        text = trace.read_text(encoding="utf-8", errors="surrogateescape")
        for line in text.rstrip("\n").split("\n"):  # other ends of lines may stand in tokens
            row: dict[str, Any] = json.loads(line)
            if "transition" in row:
                if loop is not None and seen == loop:
                    begins = steps
                seen += 1
                if row["transition"] not in self.names:
                    continue
                steps += 1
                row["step"] = steps
            elif not kept:
                row["by"] = VERIFY
            elif row.get("event") == "end":
                row["why"] = EVIDENCE
            kept.append(json.dumps(row, ensure_ascii=False) + "\n")
        if loop is not None and begins is None:
            begins = steps
        with whole_file(trace) as beside:
            beside.write_text("".join(kept), encoding="utf-8", errors="surrogateescape")
        return steps, begins


def chunks(head: str, numbers: Iterable[int]) -> Iterator[str]:
    """Lines for the explorer, each with some of the numbers."""
    words = [str(n) for n in numbers]
    for i in range(0, len(words), _WORDS):
        yield " ".join([head, *words[i : i + _WORDS]])


# --- the net -------------------------------------------------------------------------------------


class _Composer:
    def __init__(self, partition: Partition, moves: Sequence[Bad], *, loose: bool) -> None:
        self.partition = partition
        self.is_loose = loose
        self.b = b = Builder(refusing(partition, moves))
        self.step_owner: list[int] = []
        self.clock: list[int] = []
        self.probes: list[int] = []
        self.stops: list[int] = []
        # Priorities count among the steps of an owner: firing comes before publishing, that before resting.
        self.after = max([t.priority for t in partition.net.transitions] or [1000]) + 1
        looked = [c for c in partition.channels if c.reader == SUPERVISOR]
        looked.sort(key=lambda c: c.kind is not ChannelKind.FLAG)
        self.looked = looked
        self.seen = {c.place: b.place(f"cell.{c.name}.seen", b.unit) for c in looked}
        written = [c for c in partition.channels if c.writer == SUPERVISOR]
        self.staged = list(staged(partition))
        self.out = {
            c.place: b.place(f"cell.{c.name}.out", b.unit) for c in (*written, *self.staged)
        }
        self.written = written
        self.idle = b.place("cell.supervisor.idle", b.unit)
        self.calm = b.place("cell.supervisor.calm", b.unit)
        self.over = b.place("cell.supervisor.over", b.unit)
        self.news = b.place("cell.supervisor.news", b.unit)
        self.stopped = b.place("cell.stopped", b.unit)
        self.unsure: int | None = None
        truth = {c.name: c for c, _ in partition.net.program.datatypes["bool"].constructors}
        self.conditions = Conditions(truth["true"], truth["false"])
        self.going: int | None = None
        self.ending: int | None = None
        if partition.final_places and len(partition.owners) > 1 and not loose:
            self.going = b.place("cell.robots.go on", b.unit)
            b.begin(self.going, b.dot)
        self.machines = {i: machine(partition, i) for i in range(1, len(partition.owners))}
        self.passed = dict(self._passed())
        self.owes = dict(self._owing())
        self.late = [c for c in looked if self._may_be_late(c)]
        self.reads = b.place("cell.supervisor.reads", b.unit) if self.late else self.calm
        self.looks = [
            b.place(f"cell.supervisor.looks at {c.file}", b.unit)
            for c in looked
            if c not in self.late
        ]
        b.begin(self.looks[0] if self.looks else self.reads, b.dot)
        for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True):
            self._transition(t, owner)
        self._publishing()
        self._writing()
        self._reading()
        for owner in range(1, len(partition.owners)):
            self._passing(owner)
            self._stopping(owner)
        if partition.net.timed:
            self._time()

    def made(self) -> Running:
        """The whole."""
        return Running(
            net=self.b.net(),
            partition=self.partition,
            over=self.over,
            stopped=self.stopped,
            steps=tuple(self.step_owner),
            clock=tuple(self.clock),
            probes=tuple(self.probes),
            meek=tuple(meek(self.partition)),
            moments=Moments.of(self.partition, [*self.machines.values()], self._timeless()),
            names=frozenset(t.name for t in self.partition.net.transitions),
            resting=self.idle,
            firing=self.calm,
            owing=self.owes,
            ending=self.ending,
            silences=tuple(self._silences()),
            unsure=self.unsure,
        )

    def _timeless(self) -> Iterator[int]:
        """The added steps, without those of the clock."""
        first = len(self.partition.net.transitions)
        steps = range(first, first + len(self.step_owner))
        return (i for i in steps if i not in self.clock)

    def _step(
        self,
        owner: int,
        name: str,
        priority: int,
        *arcs: Arc,
        guards: Sequence[core.Exp] = (),
    ) -> int:
        if not self.is_loose or any(a.place == self.stopped for a in arcs):
            arcs = (*arcs, self.b.absent(self.stopped))
        self.b.transition(f"cell.{name}", arcs, priority=priority, guards=guards)
        self.step_owner.append(owner)
        number = len(self.partition.net.transitions) + len(self.step_owner) - 1
        if any(a.place == self.stopped and a.kind is ArcKind.OUTPUT for a in arcs):
            self.stops.append(number)
        return number

    def _on(self, place: int) -> Arc:
        return self.b.put(place, self.b.dot)

    def _off(self, place: int) -> Arc:
        return self.b.take(place, self.b.dot)

    def _has(self, place: int) -> Arc:
        return self.b.test(place, self.b.dot)

    def _goes_on(self) -> list[Arc]:
        """More arcs of what a robot does: it may have ended with the supervisor."""
        return [] if self.going is None else [self._has(self.going)]

    def _any(self, place: int) -> Arc:
        """Tests that the place holds a token."""
        return self.b.test(place, self.b.var("v", self.b.places[place].colset))

    def _transition(self, t: FlatTransition, owner: int) -> None:
        flags = [self.seen, self.out] if owner == SUPERVISOR else [self.out]
        taken = [a.place for a in t.arcs if a.kind is ArcKind.INPUT]
        arcs = [self._off(own[place]) for place in taken for own in flags if place in own]
        arcs += [self._has(self.calm)] if owner == SUPERVISOR else self._goes_on()
        if not self.is_loose:
            arcs.append(self.b.absent(self.stopped))
        arcs += self._after_looks(t, owner)
        self.b.add_arcs(t.index, arcs, {})

    def _passed(self) -> Iterator[tuple[int, int]]:
        """By transition that looks at a register: a place that is marked once its script has found no message.

        Where something takes a control token before its time, the script has asked before that as well: there nothing
        is said.
        """
        for owner, program in self.machines.items():
            for control in program.control:
                steps = program.steps_from(control)
                if any(_takes_early(s.transition, control) for s in steps):
                    continue
                for t in (s.transition for s in steps if s.transition.role is Role.LOOK):
                    name = f"{self.partition.owners[owner].name}.{t.short}"
                    yield t.index, self.b.place(f"cell.{name}.passed", self.b.unit)

    def _looks_from(self, owner: int, control: int) -> list[tuple[FlatTransition, int]]:
        """The transitions that look at registers in a state, each with the place that says that it has no message."""
        steps = self.machines[owner].steps_from(control)
        return [
            (s.transition, self.passed[s.transition.index])
            for s in steps
            if s.transition.index in self.passed
        ]

    def _after_looks(self, t: FlatTransition, owner: int) -> Iterator[Arc]:
        """More arcs of a transition: its script has looked before it does anything else, and looks anew after it."""
        if owner not in self.machines or not self.passed:
            return
        for control in self.machines[owner].control:
            if any(s.transition.index == t.index for s in self.machines[owner].steps_from(control)):
                for look, passed in self._looks_from(owner, control):
                    is_later = (t.priority, t.index) > (look.priority, look.index)
                    yield self._off(passed) if is_later else self.b.empties(passed)

    def _passing(self, owner: int) -> None:
        """A script that has come to a state in which it looks at a register finds no message there.

        Where it waits it has been woken by a message of something that it does later in order, and asks for that of the
        register when this one is there.
        """
        for control in self.machines[owner].control:
            for look, passed in self._looks_from(owner, control):
                (message,) = (p for p in self._taken(look) if p in self.out)
                arcs = [self._any(control), self._is_missing(message), self.b.absent(passed)]
                name = f"{self.partition.owners[owner].name} passes {look.short}"
                arcs += [self._on(passed), *self._goes_on()]
                for woken in self._wakers(owner, control, look):
                    there = [x for p in woken for x in (self._any(p), *self._is_there(p))]
                    self._step(owner, name, look.priority, *arcs, *there)

    def _wakers(self, owner: int, control: int, look: FlatTransition) -> list[tuple[int, ...]]:
        """The messages of which those of one row are there when a script does something else than to look.

        One row without a message where something else needs none: whether a script waits its own data decide then.
        """
        program = self.machines[owner]
        rows = {
            tuple(sorted(p for p, *_ in s.takes if p in program.channels))
            for s in program.steps_from(control)
            if (s.transition.priority, s.transition.index) > (look.priority, look.index)
        }
        return [()] if () in rows else sorted(rows)

    @staticmethod
    def _taken(t: FlatTransition) -> list[int]:
        return [a.place for a in t.arcs if a.kind is ArcKind.INPUT]

    def _owing(self) -> Iterator[tuple[int, int]]:
        """By robot that gets flags: a place that is marked while it owes an answer (I8 of docs/protocol.md)."""
        for owner in self.machines:
            if any(c.reader == owner and c.kind is ChannelKind.FLAG for c in self.written):
                name = self.partition.owners[owner].name
                yield owner, self.b.place(f"cell.{name}.owes", self.b.unit)

    def _silences(self) -> Iterator[Silence]:
        """Of each robot that may wait for others while it owes an answer."""
        for owner, owes in self.owes.items():
            program = self.machines[owner]
            states = []
            for place in program.control:
                ready = self._ready(program, program.steps_from(place))
                if ready:
                    states.append((place, ready))
            mine = [c.place for c in self.looked if c.writer == owner]
            if states:
                answers = tuple((place, self.seen[place]) for place in mine)
                who = self.partition.owners[owner].phrase
                awaited = tuple(self._of_others(owner))
                steps = (*self._before_waiting(owner), *self.clock)
                never = unanswered(program)
                yield Silence(who, owes, tuple(states), answers, steps, never, awaited)

    def _ready(self, program: Machine, steps: Sequence[Step]) -> tuple[Ready, ...]:
        """When a script goes on that has come to where these are possible; empty: it waits for no message there."""
        needed = [[p for p, *_ in s.takes if p in program.channels] for s in steps]
        is_free = [self._is_free(s) for s in steps]
        if not any(needed) or any(f and not n for f, n in zip(is_free, needed, strict=True)):
            return ()
        are_equal = len(set(map(frozenset, needed))) == 1
        found = []
        for s, messages, free in zip(steps, needed, is_free, strict=True):
            there = tuple((p, *self._shown(p)) for p in messages)
            if are_equal or free:
                found.append(Ready(there))
            else:
                own = tuple(p for p, *_ in s.takes if p not in program.channels)
                found.append(Ready(there, s.transition.index, own))
        return tuple(found)

    def _is_free(self, step: Step) -> bool:
        """Whether it can occur with whatever tokens there are."""
        bound: set[int] = set()
        for place, term, *_ in step.takes:
            colset = self.b.places[place].colset
            if colours(colset) == 1:
                continue
            match term.value:
                case core.Var(symbol=core.Symbol(uid=uid, colset=own)) if (
                    uid not in bound and own is not None and own.resolved == colset.resolved
                ):
                    bound.add(uid)
                case _:
                    return False
        return not step.transition.guards

    def _before_waiting(self, owner: int) -> Iterator[int]:
        """The steps of a program, but for its probes and those with which it stops."""
        first = len(self.partition.net.transitions)
        others = {*self.probes, *self.stops}
        for number, whose in enumerate(self.step_owner, first):
            if whose == owner and number not in others:
                yield number

    def _of_others(self, reader: int) -> Iterator[str]:
        """The messages that a program gets from others than the supervisor, in words."""
        for c in self.partition.channels:
            if c.reader == reader and c.writer != SUPERVISOR:
                who = self.partition.owners[c.writer].phrase
                yield f"`{self.partition.net.places[c.place].short}` of {who}"

    def _shown(self, place: int) -> tuple[int, ...]:
        return (self.out[place],) if place in self.out else ()

    def _asked(self, c: Channel) -> list[list[Arc]]:
        """More arcs of the step that publishes a message: whoever gets a flag owes an answer."""
        owes = self.owes.get(c.reader)
        if owes is None or c.kind is not ChannelKind.FLAG:
            return [[]]
        return [[self.b.absent(owes), self._on(owes)], [self._has(owes)]]

    def _answered(self, c: Channel) -> list[list[Arc]]:
        """The same of the step that sees a message: any is an answer."""
        owes = self.owes.get(c.writer)
        return [[]] if owes is None else [[self._off(owes)], [self.b.absent(owes)]]

    def _publishing(self) -> None:
        """What has been put is published in its order; then the supervisor rests, or has finished."""
        at = self.after
        for c in self.written:  # data come before flags
            out = self.out[c.place]
            arcs = [self._has(self.calm), self._any(c.place), self.b.absent(out), self._on(out)]
            for more in self._asked(c):
                self._step(SUPERVISOR, f"publishes {c.file}", at, *arcs, *more)
            at += 1
        for place in self.partition.final_places:
            arcs = [self._off(self.calm), self._any(place), self._on(self.over)]
            self._step(SUPERVISOR, "is over", at, *arcs)
        self._step(SUPERVISOR, "rests", at + 1, self._off(self.calm), self._on(self.idle))
        if self.going is not None:
            arcs = [self._has(self.over), self._off(self.going)]
            self.ending = self._step(SUPERVISOR, "ends the robots", at + 1, *arcs)

    def _writing(self) -> None:
        """What is written in an order that shows goes out in this order, before its robot does anything else."""
        first = min([t.priority for t in self.partition.net.transitions] or [0])
        for i, c in enumerate(reversed(self.staged), 1):
            out = self.out[c.place]
            arcs = [self._any(c.place), self.b.absent(out), self._on(out)]
            name = self.partition.owners[c.writer].name
            self._step(c.writer, f"{name} publishes {c.file}", first - i, *arcs)

    def _reading(self) -> None:
        looked = [c for c in self.looked if c not in self.late]
        for c in self.looked:
            seen = self.seen[c.place]
            found = [self._any(c.place), self.b.absent(seen), self._on(seen)]
            found += self._is_there(c.place)
            after = self._after(c)
            for more in self._answered(c):
                into = [self._off(self.idle), self._on(after), *more]
                self._step(SUPERVISOR, f"sees {c.file}", self.after, *found, *into)
                into = [self._has(self.reads), *more]
                if c in looked:
                    into = [self._off(self.looks[looked.index(c)]), self._on(after), *more]
                self._step(SUPERVISOR, f"sees {c.file} as well", self.after, *found, *into)
            if c in looked:
                at = self._off(self.looks[looked.index(c)])
                self._step(SUPERVISOR, f"passes {c.file}", self.after + 1, at, self._on(after))
        if self.late:
            into = [self._off(self.reads), self._on(self.calm)]
            self._step(SUPERVISOR, "has looked", self.after, *into)

    def _after(self, c: Channel) -> int:
        """Where the supervisor is when it has looked at a file."""
        order = self.looked.index(c)
        after = (p for p, o in zip(self.looks, self._in_order(), strict=True) if o > order)
        return next(after, self.reads)

    def _in_order(self) -> list[int]:
        """The numbers of the files that it looks at one after the other."""
        return [i for i, c in enumerate(self.looked) if c not in self.late]

    def _may_be_late(self, c: Channel) -> bool:
        """Whether a message may as well be passed over: its writer could have written it just after the look.

        Who has no other message could, since nobody has seen anything that it has done after that.
        """
        others = (o for o in self.partition.channels if c.writer in (o.writer, o.reader))
        return self.is_loose and all(o is c or o.writer == SUPERVISOR for o in others)

    def _stopping(self, owner: int) -> None:
        """A robot whose script finds no transition that fits, and none that waits, stops; or ends owing an answer."""
        program = self.machines[owner]
        name = self.partition.owners[owner].name
        for step in program.steps:
            t = step.transition
            for arcs, guards in waits(
                self.partition, program, step, self._is_there, self._is_missing, self._token
            ):
                binding = {x.guard for x in t.plan if isinstance(x, BindEquation)}
                bound = [t.guards[i] for i in binding]
                asked = [g for g in guards if g not in bound]
                kept = [g for g in guards if g in bound]
                held = [*kept, *self.conditions.held(asked)]
                made = self._step(owner, f"{name} waits", self.after, *arcs, guards=held)
                self.probes.append(made)
                self._doubt(owner, f"{name} may raise", arcs, kept, asked)
        for place in program.control:
            if program.steps_from(place):
                short = self.partition.net.places[place].short
                arcs = [self._any(place), self._on(self.stopped), *self._goes_on()]
                for here in self._between():
                    self._step(owner, f"{name} stops at {short}", self.after + 1, *arcs, *here)
            elif owner in self.owes:
                arcs = [self._any(place), self._has(self.owes[owner]), self._on(self.stopped)]
                arcs += [] if self.is_loose else [self._has(self.idle)]
                self._step(owner, f"{name} {OWING}", self.after + 3, *arcs)
        can_end = not all(map(program.steps_from, program.control))
        for c in self.looked if owner in self.owes and can_end else ():
            if c.writer == owner:  # what is on its way may be the answer
                arcs = [self._any(c.place), self.b.absent(self.seen[c.place])]
                made = self._step(owner, f"{name} has answered", self.after + 2, *arcs)
                self.probes.append(made)

    def _between(self) -> list[list[Arc]]:
        """More arcs of the step with which the cell stops: the supervisor is between two cycles, or has finished."""
        return [[]] if self.is_loose else [[self._has(p)] for p in (self.idle, self.over)]

    def _doubt(
        self,
        owner: int,
        name: str,
        arcs: Sequence[Arc],
        kept: Sequence[core.Exp],
        asked: Sequence[core.Exp],
    ) -> None:
        """A step that marks, before anything else of its owner, that a probe's condition raises an exception."""
        guards = self.conditions.unsure(asked)
        if guards is None:
            return
        if self.unsure is None:
            self.unsure = self.b.place("cell.unsure", self.b.unit)
        first = min([t.priority for t in self.partition.net.transitions] or [0])
        # A probe's arcs only take, as it never occurs: this one gives everything back.
        tests = [
            Arc(ArcKind.BOTH, a.place, a.value, a.form) if a.kind is ArcKind.INPUT else a
            for a in arcs
        ]
        here = [*tests, self.b.absent(self.unsure), self._on(self.unsure)]
        self._step(owner, name, first - len(self.staged) - 1, *here, guards=[*kept, *guards])

    def _is_there(self, place: int) -> list[Arc]:
        return [self._has(self.out[place])] if place in self.out else []

    def _token(self, place: int, name: str) -> core.Exp:
        return self.b.var(name, self.b.places[place].colset)

    def _is_missing(self, place: int) -> Arc:
        return self.b.absent(self.out.get(place, place))

    def _time(self) -> None:
        """The clock, whose steps the explorer takes one unit later; each of them may wake the supervisor."""
        self._step(
            SUPERVISOR,
            "wakes",
            self.after,
            self._off(self.idle),
            self._off(self.news),
            self._on(self.calm),
        )
        clock = len(self.partition.owners)
        quiet = self.b.absent(self.calm)
        for name, news in (
            ("waits", [self.b.absent(self.news), self._on(self.news)]),
            ("waits on", [self._has(self.news)]),
        ):
            self.clock.append(self._step(clock, f"clock.{name}", self.after, quiet, *news))


def _takes_early(t: FlatTransition, place: int) -> bool:
    """Whether a transition takes a token of the place before its time."""
    return any(
        a.place == place
        and a.inscription is not None
        and a.inscription.form in (Form.TIMED_TOKEN, Form.TIMED_MULTISET)
        for a in t.arcs
        if a.kind is not ArcKind.OUTPUT
    )
