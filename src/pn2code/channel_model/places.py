"""The places of a cell's channel model: of channels and parties; what both parts of the composition build with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.cell.partition import Channel, Partition
from pn2code.channel_model.faults import Fault
from pn2code.channel_model.rules import Rules
from pn2code.ml.core.terms import Exp
from pn2code.net.builder import Arc, Builder
from pn2code.net.flat import FlatNet, Form

ABSENT, RUNNING, FINISHED, STOPPED = range(4)
"""What a status file says; ABSENT: nothing that can be understood."""


@frozen
class Crashes:
    """How often a side may crash, and how many sessions there may be.

    Args:
        supervisor, robots: crashes at most; `robots`: of each.
        sessions: how often the supervisor is started at most; None: as often as crashes may make it necessary.
        life_cycle: whether starts, stops, locks and statuses are modelled; else all sides run from the beginning.
    """

    supervisor: int = 0
    robots: int = 0
    sessions: int | None = None
    life_cycle: bool = True

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
class ChannelModel:
    """The net, and what is needed to understand its runs.

    Args:
        verdict: the place of the verdict; `ending`: the transition that ends a run with one.
        ends: transitions that are enabled where all have come to an end.
        says: what each transition of the channel model does, in words.
        files, sides: the places of channels and owners.
        fault: the place of the token that ends a run with a verdict.
        memory: by owner, the places that nobody else knows of.
    """

    net: FlatNet
    partition: Partition
    verdict: int
    ending: int
    ends: tuple[int, ...]
    says: Mapping[str, str]
    files: tuple[Files, ...]
    sides: tuple[Side, ...]
    fault: int
    memory: tuple[tuple[int, ...], ...]


@record
class _Program:
    """What an owner holds while its process lives."""

    memory: list[int] = field(default_factory=list)
    """places that are lost with the process"""
    initial: list[tuple[int, Exp, Form]] = field(default_factory=list)
    """what is in them at first"""


class Parts:
    """The places, and helpers to make transitions."""

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
        self.unseen = self.slow if crashes.life_cycle else self.local
        self.says: dict[str, str] = {}
        self.fault_place = b.place("medium.fault", b.int)
        self.verdict = b.place("medium.verdict", b.int)
        self.fair = b.place("medium.fair weather", b.unit, b.dot)
        self.status_colset = b.product("STATUS", b.int, b.int)
        self.programs = [_Program() for _ in partition.owners]
        self.begun: list[int] = []
        self.says_of: list[int] = []
        self.leaving: list[int] = []
        self.ended: list[int] = []
        self.sides = [self._side(o) for o in range(len(partition.owners))]
        self.done = b.place("medium.supervisor.done", b.unit)
        self.files = [self._files(c) for c in partition.channels]
        self.budgets = [
            b.place(
                f"medium.{side.name}.crashes left",
                b.int,
                b.number(crashes.robots if o else crashes.supervisor),
            )
            for o, side in enumerate(self.sides)
        ]

    # --- helpers ---------------------------------------------------------------------------------

    def step(
        self, name: str, says: str, *arcs: Arc, at: int | None = None, guard: Exp | None = None
    ) -> str:
        """A transition of the channel model, by default a step that others may see; its name."""
        made = self.b.transition(
            f"medium.{name}",
            arcs,
            priority=self.slow if at is None else at,
            guards=() if guard is None else (guard,),
        )
        self.says[made] = says
        return made

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
        if not self.crashes.life_cycle:
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
        if not self.crashes.life_cycle:
            b.begin(side.calm, b.dot)
        if o == 0 or not self.crashes.life_cycle:
            b.begin(side.session, b.number(0 if self.crashes.life_cycle else 1))
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
        if not self.crashes.life_cycle:
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
            if not self.crashes.life_cycle:
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
