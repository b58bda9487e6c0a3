"""Reading: how a side looks at its files, one after the other."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cell.partition import ChannelKind
from pn2code.channel_model.deciding import Deciding
from pn2code.channel_model.faults import Fault
from pn2code.channel_model.places import Files
from pn2code.ml.core.terms import Exp
from pn2code.net.builder import Arc


class Reading(Deciding):
    """Adds the steps by which sides look at files."""

    def reading(self, o: int) -> None:
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
