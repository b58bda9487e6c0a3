"""Emptying and writing: what a side does with its files between two rounds of looks."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cell.partition import ChannelKind
from pn2code.channel_model.deciding import Deciding
from pn2code.channel_model.faults import Fault
from pn2code.channel_model.places import Files
from pn2code.channel_model.rules import Emptying
from pn2code.ml.core.terms import Exp
from pn2code.net.builder import Arc


class Writing(Deciding):
    """Adds the steps by which sides empty files and write messages."""

    def publishing(self, o: int) -> None:
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
