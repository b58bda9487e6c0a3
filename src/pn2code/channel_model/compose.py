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

from pn2code.cell.partition import Partition
from pn2code.channel_model.faults import Fault
from pn2code.channel_model.places import ChannelModel, Crashes
from pn2code.channel_model.reading import Reading
from pn2code.channel_model.rules import Rules
from pn2code.channel_model.unseen_repeats import repeated_unseen
from pn2code.channel_model.writing import Writing
from pn2code.net.flat import ArcKind

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
    composer.build()
    if extra is not None:
        extra(composer)
    return composer.finish()


class Composer(Writing, Reading):
    """Makes the net, part by part; public are the helpers for `Extra`."""

    def build(self) -> None:
        """All parts, in their order."""
        crashes = self.crashes
        self._net_transitions()
        for o in range(len(self.sides)):
            self.publishing(o)
            self.reading(o)
            if crashes.life_cycle:
                self._stopping(o)
        if crashes.life_cycle:
            self._supervisor()
            for o in range(1, len(self.sides)):
                self._robot(o)
            for o in range(len(self.sides)):
                self._crashing(o)  # last: all places of its memory are there now
        self.ends = frozenset[str]() if self.is_loose else frozenset(self._rest())

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
