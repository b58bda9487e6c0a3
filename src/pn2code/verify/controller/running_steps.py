"""The steps that the cell as it runs has besides the transitions of its net: what each program sees and when.

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
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.cell.partition import SUPERVISOR, Channel, ChannelKind, Partition
from pn2code.ml.core import terms as core
from pn2code.net.builder import Arc, Builder
from pn2code.net.flat import ArcKind, BindEquation, FlatTransition, Form, Role
from pn2code.verify.controller.poses import Bad
from pn2code.verify.controller.refusals import refusing
from pn2code.verify.controller.staged_channels import staged
from pn2code.verify.controller.stops import machine, waits
from pn2code.verify.controller.unsure import Conditions

OWING = "has finished, but it owes an answer"
"""What the name of a step says that stops the cell."""


class Steps:
    """The net with the added places and steps, made at once; what is asked about it later is kept.

    Args:
        partition: the cell.
        moves: what its arms cannot do.
        loose: see `Running.of`.
    """

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

    def timeless(self) -> Iterator[int]:
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
