"""The exchange between the supervisor and one other side, without the net around it.

A cell's topology is kept: which data and flags go to the side and come from it. Each message has the number of its
exchange, each flag says which data go with it, and both sides act upon a flag at once. So it is seen when a flag is
acted upon without its data, or with those of another exchange, however the cell's own net uses the files.

    supervisor: command n by flag f (with data d, or none) -> waits for the answer n -> command n + 1, ... -> finished
    robot:      flag f (and data d) -> answer n by flag g (with data e, or none)
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Channel, ChannelKind, OwnerKind, Partition
from pn2code.channel_model.compose import Composer
from pn2code.channel_model.faults import Fault
from pn2code.ml.core.terms import Exp
from pn2code.net.builder import Arc, Builder

ROUNDS = 2
"""Exchanges: the second one can meet what is left of the first."""


@frozen
class Topology:
    """What goes to a side and comes from it, by kind; two sides with the same one need one check."""

    data_out: int
    flags_out: int
    data_in: int
    flags_in: int


def topology(partition: Partition, owner: int) -> Topology:
    """Of the channels between the supervisor and a side."""
    mine = [c for c in partition.channels if {c.writer, c.reader} == {0, owner}]

    def count(out: bool, kind: ChannelKind) -> int:
        return sum(c.kind is kind and (c.writer == 0) is out for c in mine)

    data, flag = ChannelKind.DATA, ChannelKind.FLAG
    return Topology(count(True, data), count(True, flag), count(False, data), count(False, flag))


@frozen
class _End:
    """One direction: channels (places) of data and flags."""

    data: tuple[int, ...]
    flags: tuple[int, ...]


class Skeleton:
    """The net of an exchange, its partition, and what is wrong with it once the channel model is there."""

    def __init__(self, partition: Partition, owner: int, rounds: int = ROUNDS) -> None:
        self._b = b = Builder.empty("exchange", partition.net.file)
        self._slots: list[tuple[int, int, int]] = []
        owners = (partition.owners[0], partition.owners[owner])
        self._places: list[int] = []
        channels: list[Channel] = []
        for c in partition.channels:
            if {c.writer, c.reader} != {0, owner}:
                continue
            place = b.place(c.name, b.int)
            writer = 0 if c.writer == 0 else 1
            channels.append(Channel(c.name, c.file, place, writer, 1 - writer, c.kind))
        self._owned: list[int] = []
        self.transitions: list[int] = []
        out, back = (self._end(channels, o) for o in (0, 1))
        # Whoever is told nothing does not know when its message has been taken, so it says something once.
        self.rounds = rounds = rounds if out.flags else 1
        todo = self._local(0, "to do", b.number(1))
        asked, done = self._local(0, "asked"), self._local(0, "finished")
        ready = self._local(1, "ready", b.number(1))
        answer = self._local(1, "to answer")
        n = b.var("n", b.int)
        more = [b.less(n, b.number(rounds + 1))]
        if out.flags:
            self._send(0, "command", todo, asked, out, n, more)
            self._receive(1, "obeys", ready, answer, out, any_number=True)
        else:  # a sensor speaks unasked
            self._act(0, "waits", [b.take(todo, n), b.put(asked, n)], more)
            self._act(1, "speaks", [b.take(ready, n), b.put(answer, n)], more)
        if back.flags:
            self._send(1, "answers", answer, ready, back, n, [], following=not out.flags)
            self._receive(0, "hears", asked, todo, back, any_number=False)
        else:  # nobody knows when it has been obeyed: one command only
            self._act(1, "is ready", [b.take(answer, n), b.put(ready, n)], [])
            self._act(0, "is done", [b.take(asked, n), b.put(todo, b.number(rounds + 1))], [])
        self._act(0, "finishes", [b.take(todo, n), b.put(done, n)], [b.less(b.number(rounds), n)])
        net = b.net()
        local = dict(zip(self._places, self._owned, strict=True))
        self.partition = Partition(
            net=net,
            owners=(
                owners[0],
                type(owners[1])(1, owners[1].name, OwnerKind.ROBOT, owners[1].instance),
            ),
            transition_owner=tuple(self.transitions),
            place_owner=tuple(local.get(p.index) for p in net.places),
            channels=tuple(sorted(channels, key=lambda c: c.kind is ChannelKind.FLAG)),
            inputs=(),
            final_places=(done,),
        )

    def _end(self, channels: Sequence[Channel], writer: int) -> _End:
        mine = [c for c in channels if c.writer == writer]
        flags = tuple(c.place for c in mine if c.kind is ChannelKind.FLAG)
        data = tuple(c.place for c in mine if c.kind is ChannelKind.DATA)
        return _End(data, flags) if flags else _End((), data)

    def _local(self, owner: int, name: str, initial: Exp | None = None) -> int:
        side = ("supervisor", "robot")[owner]
        place = self._b.place(f"exchange.{side}.{name}", self._b.int, initial)
        self._places.append(place)
        self._owned.append(owner)
        return place

    def _act(self, owner: int, name: str, arcs: Sequence[Arc], guards: Sequence[Exp]) -> None:
        side = ("supervisor", "robot")[owner]
        self._b.transition(
            f"exchange.{side}.{name}",
            arcs,
            priority=1000,
            guards=guards,
        )
        self.transitions.append(owner)

    def _combinations(self, end: _End) -> Iterator[tuple[int, int, int | None]]:
        """Each flag with each data or none: flag, code, data."""
        for flag in end.flags:
            for k, data in enumerate((None, *end.data)):
                yield flag, k, data

    def _send(
        self,
        owner: int,
        name: str,
        here: int,
        after: int,
        end: _End,
        n: Exp,
        guards: Sequence[Exp],
        following: bool = False,
    ) -> None:
        b = self._b
        then = b.plus(n, b.number(1)) if following else n
        for i, (flag, k, data) in enumerate(self._combinations(end), 1):
            arcs = [b.take(here, n), b.put(after, then), b.put(flag, self._flag(n, k))]
            if data is not None:
                arcs.append(b.put(data, n))
            self._act(owner, f"{name} {i}", arcs, guards)

    def _flag(self, n: Exp, k: int) -> Exp:
        return self._b.plus(self._b.number(10 * k), n) if k else n

    def _receive(
        self, owner: int, name: str, here: int, after: int, end: _End, *, any_number: bool
    ) -> None:
        """A flag n + 10 k is taken when it is there; then its data k, at once."""
        b = self._b
        n, m, h = (b.var(x, b.int) for x in "nmh")
        then = n if any_number else b.plus(n, b.number(1))
        own = b.take(here, m if any_number else n)
        for flag in end.flags:
            alone = [own, b.take(flag, n), b.put(after, then)]
            self._act(owner, f"{name}: a flag alone", alone, [b.less(n, b.number(10))])
            for k, data in enumerate(end.data, 1):
                wanted = self._local(owner, f"wants data {k} of flag {flag}")
                guards = [b.less(b.number(10 * k), h), b.less(h, b.number(10 * k + 10))]
                less = b.plus(h, b.number(-10 * k))
                arcs = [own, b.take(flag, h), b.put(wanted, less)]
                self._act(owner, f"{name}: a flag with data {k}", arcs, guards)
                arcs = [b.take(wanted, n), b.take(data, n), b.put(after, then)]
                self._act(owner, f"{name}: data {k} of flag {flag}", arcs, [])
                self._slots.append((owner, wanted, data))

    def extra(self, composer: Composer) -> None:
        """What must not be: a flag without its data, or with those of another exchange."""
        b = composer.b
        files = {f.made: f for f in composer.files}
        n, m = b.var("n", b.int), b.var("m", b.int)
        for owner, wanted, data in self._slots:
            f, side = files[data], composer.sides[owner]
            file, name = f.channel.file, composer.sides[owner].name
            missing = [b.absent(f.read)]
            if owner:  # a script reads a file when it needs it
                missing += [composer.has(f.zero)]
            composer.step(
                f"{name}.lacks {file}",
                f"{name} acts upon the flag, but {file} is empty",
                composer.has(side.calm),
                b.test(wanted, n),
                *missing,
                composer.wrong(Fault.BARE),
            )
            for guard in (b.less(n, m), b.less(m, n)):
                composer.step(
                    f"{name}.mixes {file}",
                    f"{name} acts upon the flag with the data of another one in {file}",
                    composer.has(side.calm),
                    b.test(wanted, n),
                    b.test(f.read, m),
                    composer.wrong(Fault.MIXED),
                    guard=guard,
                )
