"""A cell's net with its medium: between writer and reader of each channel the stages that a message goes through.

In: a `Partition` and the `Rules` that the sides keep. Out: a `MediumNet`, an ordinary flat net that the explorer takes.

    writer's memory          `.f.side.tmp`         file `f`                 reader's memory
    c  --begin--> c.tmp (half, whole) --rename--> c.file(v, session, seq, used) --look--> c.read --net--> consumed
                                                  c.zero  <--rename-- `.f.reader.tmp` (half, whole) <-----+

Each side is one sequential program: calm (its transitions fire until none is enabled) -> empty what was consumed ->
write data -> write flags -> calm -> look at the incoming files, one after the other -> calm. What a side does in its
memory nobody else sees, so it happens at once (by priorities); everything that touches a file, a lock or a status is a
step of its own, and the steps of all sides interleave freely. A side may crash before each such step.

What must not be is a *fault*: a token that ends the run with a verdict. Ghosts, which no program sees: whether the
message in a file has been consumed (`used`), and whether the weather is fair, that is, no side has crashed yet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from pn2code.cell.partition import Channel, ChannelKind, Partition
from pn2code.frozen import frozen
from pn2code.medium.builder import Arc, Builder
from pn2code.medium.faults import Fault
from pn2code.medium.rules import Emptying, Rules
from pn2code.ml.core import Exp
from pn2code.net.flat import FlatNet, Form

ABSENT, RUNNING, FINISHED, STOPPED = range(4)
"""What a status file says; ABSENT: nothing that can be understood."""


@frozen
class Crashes:
    """How often a side may crash, and how many sessions there may be.

    Args:
        supervisor, robots: crashes at most; `robots`: of each.
        sessions: how often the supervisor is started at most; None: as often as crashes may make it necessary.
        lives: whether starts, stops, locks and statuses are modelled; else all sides run from the beginning.
    """

    supervisor: int = 0
    robots: int = 0
    sessions: int | None = None
    lives: bool = True

    @property
    def all_sessions(self) -> int:
        """How often the supervisor is started at most."""
        return self.sessions or 1 + self.supervisor + (1 if self.robots else 0)


@frozen
class Files:
    """The places of a channel: `made` in the writer's memory, `read` in the reader's, the others in the directory.

    Args:
        channel: which.
        made, tmp: the token to be published; on its way.
        file, zero, half: what the file holds: a message (value, session, seq, used), `0`, or a torn message.
        read, pending, consumed: taken; not emptied; to be emptied.
        next_out, next_in: the number that the next message gets, or must have (1, 2, 3, 2, 3, ...).
    """

    channel: Channel
    made: int
    tmp: int
    file: int
    zero: int
    half: int
    read: int
    pending: int
    consumed: int
    next_out: int
    next_in: int


@frozen
class Side:
    """The places of an owner: `session` is the one it has joined or begun (for the supervisor: the last one)."""

    name: str
    calm: int
    session: int
    status: int
    locked: int
    alive: int
    off: int
    stopping: int


@frozen
class MediumNet:
    """The net, and what is needed to understand its runs.

    Args:
        verdict: the place of the verdict; `ending`: the transition that ends a run with one.
        ends: transitions that are enabled where all have come to an end.
        says: what each transition of the medium does, in words.
        files, sides: the places of channels and owners.
    """

    net: FlatNet
    partition: Partition
    verdict: int
    ending: int
    ends: tuple[int, ...]
    says: Mapping[str, str]
    files: tuple[Files, ...]
    sides: tuple[Side, ...]


Extra = Callable[["Composer"], None]
"""Adds transitions when the composition is done."""


def compose(
    partition: Partition, rules: Rules, crashes: Crashes, extra: Extra | None = None
) -> MediumNet:
    """The net of a cell with its medium."""
    composer = Composer(partition, rules, crashes)
    if extra is not None:
        extra(composer)
    return composer.finish()


def modelled(partition: Partition) -> tuple[Channel, ...]:
    """The channels between the supervisor and others: the protocol has no others."""
    return tuple(c for c in partition.channels if 0 in (c.writer, c.reader))


@dataclass(slots=True)
class _Program:
    """What an owner holds while its process lives."""

    memory: list[int] = field(default_factory=list)
    """places that are lost with the process"""
    initial: list[tuple[int, Exp, Form]] = field(default_factory=list)
    """what is in them at first"""


class Composer:
    """Makes the net, part by part; public are the helpers for `Extra`."""

    def __init__(self, partition: Partition, rules: Rules, crashes: Crashes) -> None:
        self.partition = partition
        self.rules = rules
        self.crashes = crashes
        self.b = b = Builder(partition.net)
        priorities = [t.priority for t in partition.net.transitions] or [1000]
        self.urgent = min(priorities) - 1
        self.ghost = max(priorities) + 1
        self.local = max(priorities) + 2
        self.slow = max(priorities) + 3
        # Nobody sees a temporary file, so it matters only to crashes when it is begun. Whether its place is empty is
        # found out at the earliest: what is empty stays so until its one writer writes.
        self.unseen = self.slow if crashes.lives else self.local
        self.says: dict[str, str] = {}
        self.fault_place = b.place("medium.fault", b.int)
        self.verdict = b.place("medium.verdict", b.int)
        self.fair = b.place("medium.fair weather", b.unit, b.dot)
        self.status_colset = b.product("STATUS", b.int, b.int)
        self.programs = [_Program() for _ in partition.owners]
        self.begun: list[int] = []
        self.sides = [self._side(o) for o in range(len(partition.owners))]
        self.done = b.place("medium.supervisor.done", b.unit)
        self.files = [self._files(c) for c in modelled(partition)]
        self.budgets = [
            b.place(
                f"medium.{side.name}.crashes left",
                b.int,
                b.number(crashes.robots if o else crashes.supervisor),
            )
            for o, side in enumerate(self.sides)
        ]
        self._own_places()
        self._net_transitions()
        for o in range(len(self.sides)):
            self._publishing(o)
            self._reading(o)
            if crashes.lives:
                self._stopping(o)
        if crashes.lives:
            self._supervisor()
            for o in range(1, len(self.sides)):
                self._robot(o)
            for o in range(len(self.sides)):
                self._crashing(o)  # last: all places of its memory are there now
        self._rest()

    # --- helpers ---------------------------------------------------------------------------------

    def step(
        self, name: str, says: str, *arcs: Arc, at: int | None = None, guard: Exp | None = None
    ) -> None:
        """A transition of the medium, by default a step that others may see."""
        made = self.b.transition(
            f"medium.{name}",
            arcs,
            priority=self.slow if at is None else at,
            guards=() if guard is None else (guard,),
        )
        self.says[made] = says

    def on(self, place: int) -> Arc:
        """Puts a dot."""
        return self.b.put(place, self.b.dot)

    def off(self, place: int) -> Arc:
        """Takes a dot."""
        return self.b.take(place, self.b.dot)

    def has(self, place: int) -> Arc:
        """Tests for a dot."""
        return self.b.test(place, self.b.dot)

    def wrong(self, fault: Fault) -> Arc:
        """Ends the run with a verdict."""
        return self.b.put(self.fault_place, self.b.number(fault.value))

    def value(self, place: int, name: str = "v") -> Exp:
        """A variable for a token of a place."""
        return self.b.var(name, self.b.places[place].colset)

    def any(self, place: int) -> Arc:
        """Tests that the place holds a token."""
        return self.b.test(place, self.value(place))

    def number(self, name: str) -> Exp:
        """A variable for a number."""
        return self.b.var(name, self.b.int)

    def memory(self, owner: int, name: str) -> int:
        """A place of a dot in an owner's memory."""
        place = self.b.place(f"medium.{self.partition.owners[owner].name}.{name}", self.b.unit)
        self.programs[owner].memory.append(place)
        return place

    def message(self, f: Files, session: str = "s", seq: str = "q", used: Exp | None = None) -> Exp:
        """A pattern of a message in a file."""
        used = self.number("u") if used is None else used
        return self.b.pair(self.value(f.made), self.number(session), self.number(seq), used)

    def state(self, state: int | str, session: str = "s") -> Exp:
        """A pattern of a status."""
        b = self.b
        said = self.number(state) if isinstance(state, str) else b.number(state)
        return b.pair(said, self.number(session))

    def stop_or_fault(
        self, o: int, name: str, says: str, fault: Fault, *arcs: Arc, guard: Exp | None = None
    ) -> None:
        """A side notices something that must not be unless somebody has crashed; then it stops safely."""
        self.step(
            f"{name}, in fair weather",
            says,
            *arcs,
            self.has(self.fair),
            self.wrong(fault),
            guard=guard,
        )
        if not self.crashes.lives:
            return
        self.step(
            name,
            f"{says}: it stops",
            *arcs,
            self.b.absent(self.fair),
            self.on(self.sides[o].stopping),
            guard=guard,
        )

    # --- places ----------------------------------------------------------------------------------

    def _side(self, o: int) -> Side:
        b, name = self.b, self.partition.owners[o].name
        zero = b.pair(b.number(ABSENT), b.number(0))
        side = Side(
            name=name,
            calm=self.memory(o, "calm"),
            session=b.place(f"medium.{name}.session", b.int),
            status=b.place(f"{name}.status", self.status_colset, zero),
            locked=b.place(f"{name}.status is locked", b.unit),
            alive=b.place(f"medium.{name}.alive", b.unit),
            off=b.place(f"medium.{name}.off", b.unit, b.dot),
            stopping=self.memory(o, "stopping"),
        )
        if not self.crashes.lives:
            b.begin(side.calm, b.dot)
        if o == 0 or not self.crashes.lives:
            b.begin(side.session, b.number(0 if self.crashes.lives else 1))
        return side

    def _files(self, c: Channel) -> Files:
        b = self.b
        colset = b.places[c.place].colset
        kind = b.product(f"FILE_{c.name}", colset, b.int, b.int, b.int)
        made = Files(
            channel=c,
            made=c.place,
            tmp=b.place(f".{c.file}.{self.partition.owners[c.writer].name}.tmp", colset),
            file=b.place(c.file, kind),
            zero=b.place(f"{c.file} holds 0", b.unit, b.dot),
            half=b.place(f"{c.file} is torn", b.unit),
            read=b.place(f"medium.{c.name}.read", colset),
            pending=b.place(f"medium.{c.name}.pending", b.unit),
            consumed=b.place(f"medium.{c.name}.consumed", b.unit),
            next_out=b.place(f"medium.{c.name}.next out", b.int),
            next_in=b.place(f"medium.{c.name}.next in", b.int),
        )
        one = b.number(1)
        if not self.crashes.lives:
            for place in (made.next_out, made.next_in):
                b.begin(place, one)
        writer, reader = self.programs[c.writer], self.programs[c.reader]
        writer.memory += [made.made, made.tmp, made.next_out]
        reader.memory += [made.read, made.pending, made.consumed, made.next_in]
        writer.initial.append((made.next_out, one, Form.TOKEN))
        reader.initial.append((made.next_in, one, Form.TOKEN))
        return made

    def _own_places(self) -> None:
        """The places of the net itself begin empty: a process has them when it begins."""
        channels = {c.place for c in self.partition.channels}
        for place, owner in enumerate(self.partition.place_owner):
            if place in channels:
                continue
            program = self.programs[owner or 0]
            program.memory.append(place)
            if not self.crashes.lives:
                continue
            initial = self.b.forget_initial(place)
            if initial is not None:
                program.initial.append((place, *initial))

    def _begins(self, o: int) -> list[Arc]:
        """What a process has in its memory when it begins."""
        own = [self.b.put(p, value, form) for p, value, form in self.programs[o].initial]
        return [*own, self.on(self.sides[o].calm)]

    def _forgets(self, o: int, *keep: int) -> list[Arc]:
        """Resets happen last, so what the same transition puts has to be kept."""
        return [self.b.empties(p) for p in self.programs[o].memory if p not in keep]

    # --- the net's own transitions ---------------------------------------------------------------

    def _net_transitions(self) -> None:
        reads = {f.made: f.read for f in self.files}
        self.says_of: list[int] = []
        for o in range(len(self.sides)):
            self.says_of.append(self.memory(o, "says"))
        for t in self.partition.net.transitions:
            o = self.partition.transition_owner[t.index]
            side = self.sides[o]
            touches = any(a.place in reads for a in t.arcs)
            arcs = [self.has(side.calm)]
            if o and touches:  # a script empties and writes after each transition
                arcs = [self.off(side.calm), self.on(self.says_of[o])]
            self.b.add_arcs(t.index, arcs, reads)
        for f in self.files:
            name = self.partition.owners[f.channel.reader].name
            label = f"{name}.consumes {f.channel.file}"
            taken = [self.off(f.pending), self.b.absent(f.read), self.on(f.consumed)]
            for used in (0, 1):
                self.step(
                    label if used == 0 else f"{label} again",
                    f"{name} has consumed the message of {f.channel.file}"
                    + (", which had been consumed before" if used else ""),
                    *taken,
                    self.b.take(f.file, self.message(f, used=self.b.number(used))),
                    self.b.put(f.file, self.message(f, used=self.b.number(1))),
                    *([self.wrong(Fault.TWICE)] if used else []),
                    at=self.ghost,
                )
            self.step(
                f"{label}, which is gone",
                f"{name} has consumed a message of {f.channel.file} that is not there any more",
                *taken,
                self.b.absent(f.file),
                self.wrong(Fault.LOST),
                at=self.ghost,
            )

    # --- emptying and writing --------------------------------------------------------------------

    def _publishing(self, o: int) -> None:
        """Execution scheme, step 3: I4, I5, I3, I2."""
        side = self.sides[o]
        clears = [(self._empty, f) for f in self.files if f.channel.reader == o]
        own = [f for f in self.files if f.channel.writer == o]
        data = [f for f in own if f.channel.kind is ChannelKind.DATA]
        flags = [f for f in own if f.channel.kind is ChannelKind.FLAG]
        order = [*data, *flags] if self.rules.data_first else [*flags, *data]
        writes = [(self._write, f) for f in order]
        late = self.rules.empties is Emptying.AFTER
        steps = [*writes, *clears] if late else [*clears, *writes]
        here = self.says_of[o]
        if o == 0:
            for f in self.files:
                if f.channel.reader == o or f.channel.writer == o:
                    held = self.has(f.consumed) if f.channel.reader == o else self.any(f.made)
                    self.step(
                        f"{side.name}.publishes because of {f.channel.file}",
                        "",
                        self.off(side.calm),
                        held,
                        self.on(here),
                        at=self.local,
                    )
        for i, (make, f) in enumerate(steps):
            following = self.memory(o, f"says {i + 1}")
            make(o, f, here, following)
            here = following
        self.step(
            f"{side.name}.has published", "", self.off(here), self.on(side.calm), at=self.local
        )

    def _next(self, q: Exp) -> Exp:
        """The number after a number."""
        b = self.b
        two, three = b.number(2), b.number(3)
        return b.choice(b.less(q, two), two, b.choice(b.less(q, three), three, two))

    def _empty(self, o: int, f: Files, here: int, following: int) -> None:
        b, name, file = self.b, self.sides[o].name, f.channel.file
        tmp = f".{file}.{name}.tmp"
        self.step(
            f"{name}.nothing to empty in {file}",
            "",
            self.off(here),
            b.absent(f.consumed),
            self.on(following),
            at=self.local,
        )
        q = self.number("e")
        counts = [b.take(f.next_in, q), b.put(f.next_in, self._next(q))]
        if self.rules.empties is Emptying.NEVER:
            self.step(
                f"{name}.forgets to empty {file}",
                "",
                self.off(here),
                self.off(f.consumed),
                *counts,
                self.on(following),
                at=self.local,
            )
            return
        half = self.memory(o, f"half 0 for {file}")
        self.step(
            f"{name}.begins 0 for {file}",
            f"{name} begins to write `0` to {tmp}",
            self.off(here),
            self.off(f.consumed),
            self.on(half),
            at=self.unseen,
        )
        done = [self.off(half), self.on(following), *counts]
        for arcs, lost in self._replaced(f):
            self.step(
                f"{name}.empties {file}" + (", with a message lost" if lost else ""),
                f"{name} renames {tmp} over {file}: it is empty"
                + (", and a message that nobody has consumed is lost" if lost else ""),
                *done,
                *arcs,
                self.on(f.zero),
                *([self.wrong(Fault.LOST)] if lost else []),
            )

    def _replaced(self, f: Files) -> Iterator[tuple[list[Arc], bool]]:
        """The contents that a rename can replace, and whether that loses a message."""
        b = self.b
        yield [self.off(f.zero)], False
        yield [b.take(f.file, self.message(f, "w", "k", b.number(1)))], False
        yield [b.take(f.file, self.message(f, "w", "k", b.number(0)))], True

    def _write(self, o: int, f: Files, here: int, following: int) -> None:
        b, name, file = self.b, self.sides[o].name, f.channel.file
        side = self.sides[o]
        tmp = f".{file}.{name}.tmp"
        v = self.value(f.made)
        half = self.memory(o, f"half {file}")
        after = self.memory(o, f"published {file}")
        self.step(
            f"{name}.nothing to write to {file}",
            "",
            self.off(here),
            b.absent(f.made),
            self.on(following),
            at=self.local,
        )
        begin = [self.off(here), b.take(f.made, v), b.put(f.tmp, v), self.on(half)]
        if self.rules.checks_empty:
            begin.append(self.has(f.zero))
            self.stop_or_fault(
                o,
                f"{name}.cannot write to {file}",
                f"{name} has a message for {file}, which is not empty",
                Fault.OVERRUN,
                self.off(here),
                self.any(f.made),
                b.absent(f.zero),
            )
        into = tmp
        if not self.rules.renames:
            begin = [a for a in begin if a.place != f.zero]
            begin += [self.off(f.zero), self.on(f.half)]
            into = file
        self.step(
            f"{name}.begins {file}",
            f"{name} begins to write a message to {into}",
            *begin,
            at=self.unseen if self.rules.renames else None,
        )
        q = self.number("q")
        counts = [b.take(f.next_out, q), b.put(f.next_out, self._next(q))]
        made = b.pair(v, self.number("s"), q, b.number(0))
        done = [
            self.off(half),
            b.take(f.tmp, v),
            b.test(side.session, self.number("s")),
            *counts,
            b.put(f.file, made),
            self.on(after),
        ]
        if not self.rules.renames:
            says = f"the message in {file} is whole"
            self.step(f"{name}.ends {file}", says, *done, self.off(f.half))
        else:
            says = f"{name} renames {tmp} over {file}: the message is there"
            self.step(f"{name}.renames {file}", says, *done, self.off(f.zero))
            if not self.rules.checks_empty:
                for used in (0, 1):
                    old = b.pair(
                        self.value(f.made, "o"), self.number("w"), self.number("k"), b.number(used)
                    )
                    self.step(
                        f"{name}.overwrites {file} ({used})",
                        f"{name} renames {tmp} over {file}, which held a message"
                        + ("" if used else " that nobody had consumed: it is lost"),
                        *done,
                        b.take(f.file, old),
                        *([] if used else [self.wrong(Fault.LOST)]),
                    )
        self.step(
            f"{name}.wrote {file}",
            "",
            self.off(after),
            b.absent(f.made),
            self.on(following),
            at=self.local,
        )
        self.step(
            f"{name}.has two messages for {file}",
            f"{name} has a second message for {file} in the same cycle",
            self.off(after),
            self.any(f.made),
            self.wrong(Fault.OVERRUN),
            at=self.local,
        )

    # --- reading ---------------------------------------------------------------------------------

    def _reading(self, o: int) -> None:
        """Execution scheme, step 1: the files are looked at one after the other (I6).

        A look that finds nothing leaves no trace. So a round begins with the first file that holds something; those
        before it were looked at earlier, and may have been filled since.
        """
        side = self.sides[o]
        own = [f for f in self.files if f.channel.reader == o]
        flags_first = self.rules.reads_flags_first or o != 0
        own.sort(key=lambda f: (f.channel.kind is ChannelKind.FLAG) != flags_first)
        looks = [self.memory(o, f"looks at {f.channel.file}") for f in own]
        for i, f in enumerate(own):
            after = looks[i + 1] if i + 1 < len(own) else side.calm
            self._take(o, f, side.calm, after, "")
            if i:
                self._take(o, f, looks[i], after, " as well")
                self._nothing(o, f, looks[i], after)
            self._refuse(o, f)

    def _take(self, o: int, f: Files, here: int, after: int, how: str) -> None:
        b, side, file = self.b, self.sides[o], f.channel.file
        s, q = self.number("s"), self.number("q")
        expected = [b.test(side.session, s)]
        if self.rules.checks_seq:
            expected.append(b.test(f.next_in, q))
        taken = [
            self.off(here),
            b.absent(f.pending),
            b.put(f.read, self.value(f.made)),
            self.on(f.pending),
            self.on(after),
        ]
        name, says = f"{side.name}.sees {file}{how}", f"{side.name} reads the message of {file}"
        self.step(name, says, *taken, *expected, b.test(f.file, self.message(f)))
        if not self.rules.checks_session:
            older = b.less(self.number("w"), s)
            self.step(
                f"{name}, of another session",
                f"{says}, which is of an earlier session",
                *taken,
                *expected,
                b.test(f.file, self.message(f, "w")),
                self.wrong(Fault.OLD),
                guard=older,
            )
        if not self.rules.validates:
            self.step(
                f"{name}, torn",
                f"{side.name} reads half a message from {file}",
                self.off(here),
                self.has(f.half),
                self.wrong(Fault.TORN),
            )

    def _bad(self, o: int, f: Files) -> Iterator[tuple[str, list[Arc], Exp | None, Fault]]:
        """Contents that are refused: in words, arcs, guard, and what that is."""
        b, side = self.b, self.sides[o]
        s, w, q, e = (self.number(x) for x in "swqe")
        if not self.rules.renames and self.rules.validates:
            yield "half a message", [self.has(f.half)], None, Fault.REFUSED
        if self.rules.checks_session:
            found = [b.test(side.session, s), b.test(f.file, self.message(f, "w"))]
            yield "a message of an earlier session", found, b.less(w, s), Fault.STALE
            yield "a message of a later session", found, b.less(s, w), Fault.REFUSED
        if self.rules.checks_seq:
            found = [
                b.test(side.session, s),
                b.test(f.file, self.message(f, "s")),
                b.test(f.next_in, e),
            ]
            yield "a message with another number", found, b.less(q, e), Fault.REFUSED
            yield "a message with another number", found, b.less(e, q), Fault.REFUSED

    def _refuse(self, o: int, f: Files) -> None:
        side, file = self.sides[o], f.channel.file
        for what, arcs, guard, fault in self._bad(o, f):
            name = f"{side.name}.refuses {file}"
            says = f"{side.name} finds {what} in {file}"
            arcs = [self.off(side.calm), self.b.absent(f.pending), *arcs]
            if fault is Fault.STALE:
                self.step(name, says, *arcs, self.wrong(fault), guard=guard)
            else:
                self.stop_or_fault(o, name, says, fault, *arcs, guard=guard)

    def _nothing(self, o: int, f: Files, here: int, after: int) -> None:
        side, file = self.sides[o], f.channel.file
        name = f"{side.name}.sees nothing in {file}"
        says = f"{side.name} looks at {file}, which is empty"
        self.step(name, says, self.off(here), self.has(f.zero), self.on(after))
        self.step(
            f"{side.name}.has read {file}",
            "",
            self.off(here),
            self.has(f.pending),
            self.on(after),
            at=self.local,
        )
        for what, arcs, guard, _ in self._bad(o, f):
            self.step(
                f"{name} yet",
                f"{side.name} finds {what} in {file}, and waits",
                self.off(here),
                self.b.absent(f.pending),
                *arcs,
                self.on(after),
                guard=guard,
            )

    # --- the ends of a process -------------------------------------------------------------------

    def _stopping(self, o: int) -> None:
        """I10: nothing more is written but the status; then the lock is given up."""
        b, side = self.b, self.sides[o]
        s = self.number("s")
        last, leaving = self.memory(o, "last word"), self.memory(o, "leaving")
        ended = self.memory(o, "has finished")
        self.leaving = [*getattr(self, "leaving", []), leaving]
        self.ended = [*getattr(self, "ended", []), ended]
        self.step(
            f"{side.name}.stops in fair weather",
            f"{side.name} stops although nobody has crashed",
            self.off(side.stopping),
            self.has(self.fair),
            self.wrong(Fault.STOP),
            at=self.local,
        )
        self.step(
            f"{side.name}.stops",
            "",
            self.off(side.stopping),
            b.absent(self.fair),
            *self._forgets(o, last),
            self.on(last),
            at=self.local,
        )
        said = [b.take(side.status, self.state("x", "w")), b.test(side.session, s)]
        self.step(
            f"{side.name}.says stopped",
            f"{side.name} writes `stopped` to {side.name}.status",
            self.off(last),
            *said,
            b.put(side.status, self.state(STOPPED)),
            self.on(leaving),
        )
        gone = [b.empties(side.locked), self.off(side.alive)]
        forgets = [b.empties(side.session)] if o else []
        self.step(
            f"{side.name}.leaves",
            f"{side.name} ends, and its lock is free",
            self.off(leaving),
            *gone,
            *forgets,
            self.on(side.off),
        )
        self.step(
            f"{side.name}.leaves in peace",
            f"{side.name} ends, and its lock is free",
            self.off(ended),
            *gone,
            *forgets,
            self.on(side.off if o else self.done),
        )

    def _finish(self, o: int, says: str, *why: Arc) -> None:
        b, side = self.b, self.sides[o]
        self.step(
            f"{side.name}.finishes",
            f"{side.name} {says}: it writes `finished` to {side.name}.status",
            self.off(side.calm),
            *why,
            b.take(side.status, self.state("x", "w")),
            b.test(side.session, self.number("s")),
            b.put(side.status, self.state(FINISHED)),
            *self._forgets(o, self.ended[o]),
            self.on(self.ended[o]),
        )

    def _crashing(self, o: int) -> None:
        b, side, k = self.b, self.sides[o], self.number("k")
        if (self.crashes.robots if o else self.crashes.supervisor) == 0:
            return
        self.step(
            f"{side.name}.crashes",
            f"{side.name} crashes: its memory is lost, its lock is free, the files stay",
            self.off(side.alive),
            b.take(self.budgets[o], k),
            b.put(self.budgets[o], b.plus(k, b.number(-1))),
            b.empties(self.fair),
            b.empties(side.locked),
            *([b.empties(side.session)] if o else []),
            *self._forgets(o),
            self.on(side.off),
            guard=b.less(b.number(0), k),
        )

    # --- the supervisor's life -------------------------------------------------------------------

    def _supervisor(self) -> None:
        b, side, robots = self.b, self.sides[0], self.sides[1:]
        name, s = side.name, self.number("s")
        here = self.memory(0, "started")
        self.step(
            f"{name}.starts",
            f"{name} is started",
            self.off(side.off),
            b.test(side.session, s),
            self.on(side.alive),
            self.on(here),
            guard=b.less(s, b.number(self.crashes.all_sessions)),
        )

        def then(what: str, says: str, *arcs: Arc, stay: int | None = None) -> int:
            after = stay or self.memory(0, what)
            self.step(f"{name}.{what}", f"{name} {says}", self.off(here), *arcs, self.on(after))
            return after

        nothing = b.pair(b.number(ABSENT), b.number(0))
        unsays = (
            "takes back its old status",
            f"empties {name}.status",
            b.take(side.status, self.state("x", "w")),
            b.put(side.status, nothing),
        )
        locks = ("locks", f"locks {name}.status", self.on(side.locked))
        for act in (unsays, locks) if self.rules.unsays_first else (locks, unsays):
            here = then(*act)
            self.begun.append(here)
        for robot in robots if self.rules.awaits_peers else ():
            self.step(
                f"{name}.gives up before {robot.name}",
                f"{name} finds {robot.name} of an earlier session alive, and gives up",
                self.off(here),
                self.has(robot.locked),
                self.on(self.leaving[0]),
            )
            here = then(
                f"finds no {robot.name}",
                f"finds that nobody holds the lock of {robot.name}.status",
                b.absent(robot.locked),
            )
            here = then(
                f"removes the status of {robot.name}",
                f"removes {robot.name}.status",
                b.take(robot.status, self.state("x", "w")),
                b.put(robot.status, nothing),
            )
        for f in self.files if self.rules.cleans else ():
            after = self.memory(0, f"cleaned {f.channel.file}")
            contents = [
                [self.off(f.zero)],
                [b.take(f.file, self.message(f, "w", "k"))],
                *([] if self.rules.renames else [[self.off(f.half)]]),
            ]
            for arcs in contents:
                here = (
                    then(
                        f"cleans {f.channel.file}",
                        f"empties {f.channel.file}",
                        *arcs,
                        self.on(f.zero),
                        stay=after,
                    )
                    and here
                )
            here = after
        self.step(
            f"{name}.announces itself",
            f"{name} writes `running` and its session to {name}.status",
            self.off(here),
            b.take(side.status, self.state("x", "w")),
            b.take(side.session, s),
            b.put(side.session, b.plus(s, b.number(1))),
            b.put(side.status, b.pair(b.number(RUNNING), b.plus(s, b.number(1)))),
            *self._begins(0),
        )
        for i, place in enumerate(self.partition.final_places):
            self._finish(0, f"holds a token in its final place {i + 1}", self.any(place))
        for robot in robots if self.rules.looks_after else ():
            seen = [self.off(side.calm), b.test(side.session, s), self.on(side.stopping)]
            self.step(
                f"{name}.sees {robot.name} stopped",
                f"{name} reads `stopped` in {robot.name}.status",
                *seen,
                b.test(robot.status, self.state(STOPPED)),
            )
            self.step(
                f"{name}.sees {robot.name} dead",
                f"{name} finds the lock of {robot.name}.status free, which says `running`",
                *seen,
                b.test(robot.status, self.state(RUNNING)),
                b.absent(robot.locked),
            )

    # --- a robot's life --------------------------------------------------------------------------

    def _robot(self, o: int) -> None:
        b, side, boss = self.b, self.sides[o], self.sides[0]
        name, s, w, x = side.name, self.number("s"), self.number("w"), self.number("x")
        seen, locked, emptied, sure = (
            self.memory(o, n) for n in ("saw the supervisor", "locked", "emptied", "joins")
        )
        runs = [b.test(boss.status, self.state(RUNNING)), self.has(boss.locked)]
        fresh = [b.test(side.status, self.state("x", "w"))] if self.rules.joins_once else []
        self.step(
            f"{name}.starts",
            f"{name} is started, and sees {boss.name} running",
            self.off(side.off),
            *runs,
            *fresh,
            b.put(side.session, s),
            self.on(side.alive),
            self.on(seen),
            guard=b.less(w, s) if fresh else None,
        )
        if not self.rules.unsays_first:  # the lock is that of the next supervisor
            self.step(
                f"{name}.starts in a dead session",
                f"{name} is started; it finds the lock of {boss.name}.status held, and an old `running` in it",
                self.off(side.off),
                *runs,
                self.has(self.begun[0]),
                self.wrong(Fault.DEAD),
            )
        self.step(
            f"{name}.locks",
            f"{name} locks {name}.status",
            self.off(seen),
            self.on(side.locked),
            self.on(locked),
        )
        self.step(
            f"{name}.takes back its old status",
            f"{name} empties {name}.status",
            self.off(locked),
            b.take(side.status, self.state("x", "w")),
            b.put(side.status, b.pair(b.number(ABSENT), b.number(0))),
            self.on(emptied),
        )
        same = b.test(side.session, s)
        if not self.rules.looks_again:
            self.step(f"{name}.is sure", "", self.off(emptied), self.on(sure), at=self.local)
        else:
            self.step(
                f"{name}.looks again",
                f"{name} sees {boss.name} still running in the same session",
                self.off(emptied),
                same,
                *runs,
                self.on(sure),
            )
            elsewhere = b.test(boss.status, self.state("x", "w"))
            changes: Sequence[tuple[list[Arc], Exp | None]] = (
                ([b.absent(boss.locked)], None),
                ([same, elsewhere], b.less(w, s)),
                ([same, elsewhere], b.less(s, w)),
                ([same, b.test(boss.status, self.state("x"))], b.less(b.number(RUNNING), x)),
            )
            for arcs, guard in changes:
                self.step(
                    f"{name}.does not join",
                    f"{name} sees that {boss.name} does not run in that session any more",
                    self.off(emptied),
                    *arcs,
                    self.on(self.leaving[o]),
                    guard=guard,
                )
        self.step(
            f"{name}.joins",
            f"{name} writes `running` and the session to {name}.status",
            self.off(sure),
            b.take(side.status, self.state("x", "w")),
            same,
            b.put(side.status, self.state(RUNNING)),
            *self._begins(o),
        )
        self._finish(
            o, f"reads `finished` in {boss.name}.status", b.test(boss.status, self.state(FINISHED))
        )
        if not self.rules.looks_after:
            return
        looks: Sequence[tuple[str, list[Arc], Exp | None]] = (
            ("stopped", [b.test(boss.status, self.state(STOPPED))], None),
            ("dead", [b.test(boss.status, self.state(RUNNING)), b.absent(boss.locked)], None),
            ("replaced", [b.test(boss.status, self.state("x", "w"))], b.less(w, s)),
            ("replaced", [b.test(boss.status, self.state("x", "w"))], b.less(s, w)),
        )
        words = {
            "stopped": f"reads `stopped` in {boss.name}.status",
            "dead": f"finds the lock of {boss.name}.status free, which says `running`",
            "replaced": f"does not find its session in {boss.name}.status",
        }
        for what, arcs, guard in looks:
            self.step(
                f"{name}.sees {boss.name} {what}",
                f"{name} {words[what]}",
                self.off(side.calm),
                same,
                *arcs,
                self.on(side.stopping),
                guard=guard,
            )

    # --- the ends that are wanted, and the others ------------------------------------------------

    def _rest(self) -> None:
        b = self.b
        if not self.crashes.lives:
            for i, place in enumerate(self.partition.final_places):
                says = "the supervisor has finished"
                self.step(f"rest {i + 1}", says, self.has(self.sides[0].calm), self.any(place))
            return
        robots = [self.has(side.off) for side in self.sides[1:]]
        last = b.test(self.sides[0].session, b.number(self.crashes.all_sessions))
        self.step("rest after the end", "all have finished", self.has(self.done), *robots)
        self.step("rest after a stop", "all have ended", self.has(self.sides[0].off), last, *robots)

    def finish(self) -> MediumNet:
        """The net."""
        b = self.b
        everything = [p.index for p in b.places if p.index not in (self.fault_place, self.verdict)]
        n = self.number("n")
        made = b.transition(
            "medium.verdict",
            [
                b.take(self.fault_place, n),
                b.put(self.verdict, n),
                *(b.empties(p) for p in [*everything, self.fault_place]),
            ],
            priority=self.urgent,
        )
        self.says[made] = ""
        net = b.net()
        return MediumNet(
            net=net,
            partition=self.partition,
            verdict=self.verdict,
            ending=len(net.transitions) - 1,
            ends=tuple(t.index for t in net.transitions if t.name.startswith("medium.rest")),
            says=self.says,
            files=tuple(self.files),
            sides=tuple(self.sides),
        )
