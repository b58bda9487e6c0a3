"""A cell's net with its channel model: the stages that a message goes through between writer and reader of a channel.

In: a `Partition` and the `Rules` that the sides keep. Out: a `ChannelModel`, a flat net that can be explored.

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

from collections.abc import Callable, Iterator

from pn2code.cell.partition import ChannelKind, Partition
from pn2code.channel_model.faults import Fault
from pn2code.channel_model.life_cycle import LifeCycle
from pn2code.channel_model.places import ChannelModel, Crashes, Files
from pn2code.channel_model.rules import Emptying, Rules
from pn2code.ml.core.terms import Exp
from pn2code.net.builder import Arc
from pn2code.net.flat import ArcKind
from pn2code.verify.controller.rival_transitions import hasty as hasty_ones
from pn2code.verify.controller.rival_transitions import meek


def repeated_unseen(partition: Partition) -> frozenset[int]:
    """The transitions of scripts that touch no message and that may follow themselves without one that does."""
    messages = {c.place for c in partition.channels}
    takers: dict[int, set[int]] = {}
    puts: dict[int, set[int]] = {}
    for t in partition.net.transitions:
        if partition.transition_owner[t.index] and not any(a.place in messages for a in t.arcs):
            puts[t.index] = {a.place for a in t.arcs if a.kind in (ArcKind.OUTPUT, ArcKind.BOTH)}
            for a in t.arcs:
                if a.kind in (ArcKind.INPUT, ArcKind.BOTH):
                    takers.setdefault(a.place, set()).add(t.index)
    found = set()
    for first in puts:
        seen: set[int] = set()
        todo = [first]
        while todo:
            after = {x for place in puts[todo.pop()] for x in takers.get(place, ())} - seen
            seen |= after
            todo += after
        if first in seen:
            found.add(first)
    return frozenset(found)


Extra = Callable[["Composer"], None]
"""Adds transitions when the composition is done."""


def compose(
    partition: Partition,
    rules: Rules,
    crashes: Crashes,
    extra: Extra | None = None,
    *,
    loose: bool = False,
    hasty: bool = False,
) -> ChannelModel:
    """The net of a cell with its channel model.

    Args:
        partition: the cell.
        rules: that the sides keep.
        crashes: how many there may be.
        extra: adds to it.
        loose: as `by_turns` needs it.
        hasty: scripts that decide while messages come (`rival_transitions.hasty`) can do whatever their order of looks
            permits, and more; else they look as if in the order of the files, and can do neither all of that nor more.
    """
    composer = Composer(partition, rules, crashes, loose=loose, hasty=hasty)
    if extra is not None:
        extra(composer)
    return composer.finish()


class Composer(LifeCycle):
    """Makes the net, part by part; public are the helpers for `Extra`."""

    def __init__(
        self,
        partition: Partition,
        rules: Rules,
        crashes: Crashes,
        *,
        loose: bool = False,
        hasty: bool = False,
    ) -> None:
        super().__init__(partition, rules, crashes)
        self.is_loose = loose
        self._own_places()
        is_exact = not (loose or crashes.life_cycle)
        self.meek = frozenset(meek(partition)) if is_exact else frozenset()
        self.undecided = self._undecided()
        self.fresh = self._fresh()
        self.to_decide = {o: self.memory(o, "is to decide") for o in self.fresh}
        self.hasty = {partition.transition_owner[t] for t, _ in hasty_ones(partition) if hasty}
        self.looks_on: dict[int, int] = {}
        self._net_transitions()
        for o in range(len(self.sides)):
            self._publishing(o)
            self._reading(o)
            if crashes.life_cycle:
                self._stopping(o)
        if crashes.life_cycle:
            self._supervisor()
            for o in range(1, len(self.sides)):
                self._robot(o)
            for o in range(len(self.sides)):
                self._crashing(o)  # last: all places of its memory are there now
        self.ends = frozenset[str]() if loose else frozenset(self._rest())

    def _fresh(self) -> dict[int, int]:
        """Where scripts begin to look that wait for one of several messages: by owner, a place.

        Such a script takes what comes first in its order of what is there. Whatever was there before its last
        transition it finds, since it looks at all files after it; what has come since it may have missed. Loosely, and
        with crashes, scripts may miss anything.
        """
        owners = {self.partition.transition_owner[t] for t in self.meek}
        found = {o: self.memory(o, "looks anew") for o in sorted(owners)}
        for o, place in found.items():
            own = (p for p in self.undecided if self.partition.place_owner[p] == o)
            if any(self.b.places[p].initial is not None for p in own):
                self.b.forget_initial(self.sides[o].calm)
                self.b.begin(place, self.b.dot)
        return found

    def _undecided(self) -> frozenset[int]:
        """The places of scripts, without their messages, where one of several messages may be waited for."""
        messages = {c.place for c in self.partition.channels}
        inputs = (ArcKind.INPUT, ArcKind.BOTH)
        return frozenset(
            a.place
            for t in self.meek
            for a in self.partition.net.transitions[t].arcs
            if a.kind in inputs and a.place not in messages
        )

    # --- the net's own transitions ---------------------------------------------------------------

    def _net_transitions(self) -> None:
        reads = {f.made: f.read for f in self.files}
        for o in range(len(self.sides)):
            self.says_of.append(self.memory(o, "says"))
        repeated = repeated_unseen(self.partition)
        pauses: dict[int, int] = {}
        for t in self.partition.net.transitions:
            o = self.partition.transition_owner[t.index]
            side = self.sides[o]
            touches = any(a.place in reads for a in t.arcs)
            decides = any(a.place in self.undecided and a.kind is not ArcKind.INPUT for a in t.arcs)
            arcs = [self.has(side.calm)]
            if o and touches:  # a script empties and writes after each transition
                arcs = [self.off(side.calm), self.on(self.says_of[o])]
            elif t.index in repeated:
                # What a side repeats for ever in its memory must not keep the others from doing anything.
                if o not in pauses:
                    pauses[o] = self.memory(o, "pause")
                    self._goes_on(f"{side.name}.goes on", o, pauses[o], self.slow)
                arcs = [self.off(side.calm), self.on(pauses[o])]
            elif o in self.fresh and decides:
                arcs = [self.off(side.calm), self.on(self.fresh[o])]
            if o in self.fresh and decides and self.fresh[o] not in {a.place for a in arcs}:
                arcs.append(self.on(self.to_decide[o]))
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
        self._goes_on(f"{side.name}.has published", o, here, self.local)

    def _goes_on(self, name: str, o: int, here: int, at: int) -> None:
        """A side has done something, and is calm, or looks at all files before it decides what comes next."""
        calm = self.on(self.sides[o].calm)
        if o not in self.fresh:
            self.step(name, "", self.off(here), calm, at=at)
            return
        decides = self.to_decide[o]
        self.step(name, "", self.off(here), self.b.absent(decides), calm, at=at)
        anew = [self.off(decides), self.on(self.fresh[o])]
        self.step(f"{name} and looks anew", "", self.off(here), *anew, at=at)

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
        before it were looked at earlier, and may have been filled since. Where it matters (`_fresh`), a round that
        begins with the first file, whatever it holds, comes before all others. If scripts are hasty, they may see or
        pass over what is there after that round, in any order, and decide late (`_looking_on`): they look in an order
        of their own, more than once at a file, while messages come.
        """
        side = self.sides[o]
        own = [f for f in self.files if f.channel.reader == o]
        flags_first = self.rules.reads_flags_first or o != 0
        own.sort(key=lambda f: (f.channel.kind is ChannelKind.FLAG) != flags_first)
        looks = [self.memory(o, f"looks at {f.channel.file}") for f in own]
        ends = [*looks[1:], side.calm]
        following = ends
        if o in self.fresh:
            looks[0] = self.fresh[o]
        if o in self.fresh and o in self.hasty:
            following = self._looking_on(o, own)
            ends = [*looks[1:], self.looks_on[o]]
        for i, f in enumerate(own):
            self._take(o, f, side.calm, following[i], "")
            if i or o in self.fresh:
                self._take(o, f, looks[i], ends[i], " as well")
                self._nothing(o, f, looks[i], ends[i])
            self._refuse(o, f)

    def _looking_on(self, o: int, own: list[Files]) -> list[int]:
        """A round in which a script sees of what is there whatever it likes; by file, where it is after that."""
        side = self.sides[o]
        looks = [self.memory(o, f"looks on at {f.channel.file}") for f in own]
        following = [*looks[1:], side.calm]
        self.looks_on[o] = looks[0]
        for f, here, after in zip(own, looks, following, strict=True):
            self._take(o, f, here, after, ", looking on")
            file = f.channel.file
            says = f"{side.name} does not look at {file} again"
            self.step(f"{side.name}.passes over {file}", says, self.off(here), self.on(after))
        return following

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
        # Loosely, a message that is there may be passed over: it could have come a little later.
        empty = [] if self.is_loose else [self.has(f.zero)]
        self.step(name, says, self.off(here), *empty, self.on(after))
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

    # --- the ends that are wanted, and the others ------------------------------------------------

    def _rest(self) -> Iterator[str]:
        """The names of the steps that are possible at an end that is wanted."""
        b = self.b
        if not self.crashes.life_cycle:
            for i, place in enumerate(self.partition.final_places):
                says = "the supervisor has finished"
                yield self.step(
                    f"rest {i + 1}", says, self.has(self.sides[0].calm), self.any(place)
                )
            return
        robots = [self.has(side.off) for side in self.sides[1:]]
        last = b.test(self.sides[0].session, b.number(self.crashes.all_sessions))
        yield self.step("rest after the end", "all have finished", self.has(self.done), *robots)
        off = self.has(self.sides[0].off)
        yield self.step("rest after a stop", "all have ended", off, last, *robots)

    def finish(self) -> ChannelModel:
        """The net."""
        b = self.b
        if not self.is_loose:
            self._verdict()
        net = b.net()
        return ChannelModel(
            net=net,
            partition=self.partition,
            verdict=self.verdict,
            ending=len(net.transitions) - 1,
            ends=tuple(t.index for t in net.transitions if t.name in self.ends),
            says=self.says,
            files=tuple(self.files),
            sides=tuple(self.sides),
            fault=self.fault_place,
            memory=tuple(tuple(program.memory) for program in self.programs),
        )

    def _verdict(self) -> None:
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
