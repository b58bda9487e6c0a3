"""Registers: values that one program sets and others look at, made of messages.

A place with `kind = "register"` in cell.toml holds one token, which the supervisor replaces and robots and devices look
at. Files cannot show them the value of the moment. So the net gets, before anything else is done with it, a place for
each reader with what this reader has seen, and messages that bring it there:

    setter    idle --Tell--> told         the reader has not been sent the present value: sends it
              told --Again--> told        it has taken the last one, and there is a newer one: sends that
              told --Confirm--> known     it has taken the last one, and there is no newer one: says so
              known --Heard--> idle       it has taken that, too
    reader    X --See--> X'               in each state X in which it looks: takes the value into its own place, says so
              X' --See again--> X'        a newer one
              X' --Go on--> X             what it has is the latest one: says that it has heard so

All of these are ordinary transitions, all messages ordinary channels with one writer and one reader. What is verified,
generated, run and replayed is this net: there is none in which a reader sees a value at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePath

from pn2code.base.frozen import frozen
from pn2code.cell import codes
from pn2code.cell.config import CellConfig, ChannelConfig
from pn2code.cell.divide import divide
from pn2code.cell.files import faults, one_name
from pn2code.cell.owners import owners_of, owners_of_transitions
from pn2code.cell.partition import SUPERVISOR, ChannelKind, Owner, Partition
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.net.builder import Arc, Builder
from pn2code.net.flat import ArcKind, FlatNet, FlatPlace, FlatTransition, Role
from pn2code.net.register_places import MADE
from pn2code.registers.recognised import Register, refuse, registers
from pn2code.robot_scripts.analyse import analyse


@frozen
class _Made:
    """Where an element that is added stands."""

    short: str
    page: str
    instance: str
    number: int
    origin: Origin
    role: Role = Role.REGISTER


def with_messages(net: FlatNet, config: CellConfig, d: Diagnostics) -> tuple[FlatNet, CellConfig]:
    """The net and the cell with registers made of messages; as they are after an error."""
    before = len(d.errors)
    owners = owners_of(net, config, d)
    of = owners_of_transitions(net, owners, d) if len(d.errors) == before else ()
    if len(d.errors) != before:
        return net, config
    found = registers(net, config, owners, of, d)
    if len(d.errors) != before:
        return net, config
    return _Composer(net, config, owners, of, found, d).made()


# --- the net -------------------------------------------------------------------------------------


class _Composer:
    def __init__(
        self,
        net: FlatNet,
        config: CellConfig,
        owners: Sequence[Owner],
        of: Sequence[int],
        found: Sequence[Register],
        d: Diagnostics,
    ) -> None:
        self.net = net
        self.config = config
        self.owners = owners
        self.of = of
        self.found = found
        self.d = d
        self.before = min(t.priority for t in net.transitions) - 1
        self.copies: dict[tuple[int, int], int] = {}
        self.places: dict[int, _Made] = {}
        self.transitions: list[_Made] = []
        self.entries: list[ChannelConfig] = [c for c in config.channels if not c.is_register]
        self.b = Builder(net)
        self.is_latest = self.b.truth_values("LATEST")

    def made(self) -> tuple[FlatNet, CellConfig]:
        """The net and the cell; as they were after an error."""
        for register in self.found:
            for reader in register.readers:
                self._copy(register, reader)
        plain = replace(self.config, channels=tuple(self.entries))
        looks = self._looks(plain)
        if looks is None:
            return self.net, self.config
        for register in self.found:
            for reader in register.readers:
                self._messages(register, reader, looks[register.place.index, reader])
        if not self._are_files_apart():
            return self.net, self.config
        return self._placed(self.b.net()), replace(self.config, channels=tuple(self.entries))

    def _copy(self, register: Register, reader: int) -> None:
        """What a reader has seen: a place of its own, where its transitions look."""
        place = register.place
        short = f"{_word(place.short)}_seen"
        copy = self._place(reader, short, place.colset, place)
        self.b.places[copy] = replace(self.b.places[copy], initial=place.initial)
        self.copies[place.index, reader] = copy
        for t, owner in enumerate(self.of):
            if owner == reader:
                arcs = tuple(
                    replace(a, place=copy) if a.place == place.index else a
                    for a in self.b.old[t].arcs
                )
                self.b.old[t] = replace(self.b.old[t], arcs=arcs)

    def _looks(self, plain: CellConfig) -> dict[tuple[int, int], list[int]] | None:
        """For each register and reader the control places of states in which it looks; None after errors."""
        tried = Diagnostics()
        before = len(tried.errors)
        partition = divide(self._placed(self.b.net()), plain, tried)
        looks: dict[tuple[int, int], list[int]] = {}
        for owner in self.owners[1:] if partition is not None else ():
            own = {p: c for (p, reader), c in self.copies.items() if reader == owner.index}
            if own:
                looks |= self._looks_of(partition, owner, own, tried)
        if len(tried.errors) != before:
            self.d.items += tried.errors
            return None
        return looks

    def _looks_of(
        self, partition: Partition | None, owner: Owner, own: dict[int, int], d: Diagnostics
    ) -> dict[tuple[int, int], list[int]]:
        assert partition is not None
        machine = analyse(partition, owner, d)
        out: dict[tuple[int, int], list[int]] = {}
        if machine is None:
            return out
        for register in self.found:
            copy = own.get(register.place.index)
            if copy is None:
                continue
            if copy not in machine.variables:
                refuse(d, register.place, register.entry, f"tells where {owner.phrase} is")
            states = {
                p
                for s in machine.steps
                if any(q == copy for q, *_ in s.takes)
                for p, *_ in s.takes
                if p in machine.control
            }
            out[register.place.index, owner.index] = sorted(states)
        return out

    def _messages(self, register: Register, reader: int, states: Sequence[int]) -> None:
        """The messages between setter and reader, and the transitions that send and take them."""
        b, place, who = self.b, register.place, self.owners[reader].name
        name, stem = _word(place.short), PurePath(register.entry.file).stem
        copy = self.copies[place.index, reader]
        sends = b.product(f"{name}_{who}", place.colset, self.is_latest)
        value = self._place(reader, f"{name}_new", sends, place)
        taken = self._place(reader, f"{name}_taken", b.unit, place)
        ending = PurePath(register.entry.file).suffix
        for channel, file in ((value, f"{stem}_{who}"), (taken, f"{stem}_{who}_taken")):
            self.entries.append(
                ChannelConfig(
                    b.places[channel].name,
                    f"{file}{ending}",
                    ChannelKind.DATA,
                    register.entry.origin,
                )
            )
        idle, told, known, sent = (
            self._place(SUPERVISOR, f"{name}_{who}_{state}", b.unit, place)
            for state in ("idle", "told", "known", "sent")
        )
        b.begin(idle, b.dot)
        b.begin(sent, b.dot)
        for t, owner in enumerate(self.of):
            if owner == SUPERVISOR and _sets(self.net.transitions[t], place.index):
                b.add_arcs(t, [b.empties(sent)], {})
        now, newer, latest = self._token(place.index, "v"), b.truth(False), b.truth(True)
        is_now = b.test(place.index, now)
        send = [b.absent(sent), b.put(sent, b.dot), is_now, b.put(value, b.pair(now, newer))]
        off = [b.take(told, b.dot), b.take(taken, b.dot)]
        on = b.put(told, b.dot)
        soon = self.before
        at = f"{place.short} {who}"
        self._step(SUPERVISOR, f"Tell {at}", soon, [b.take(idle, b.dot), on, *send], place)
        self._step(SUPERVISOR, f"Again {at}", soon, [*off, on, *send], place)
        same = [b.test(sent, b.dot), is_now, b.put(value, b.pair(now, latest)), b.put(known, b.dot)]
        self._step(SUPERVISOR, f"Confirm {at}", soon, [*off, *same], place)
        heard = [b.take(known, b.dot), b.take(taken, b.dot), b.put(idle, b.dot)]
        self._step(SUPERVISOR, f"Heard {at}", soon, heard, place)
        old, new = self._token(copy, "old"), self._token(copy, "v")
        own = [b.take(copy, old), b.put(copy, new), b.put(taken, b.dot)]
        any_of_them = b.var("is_latest", self.is_latest)
        for state in states:
            control = b.places[state]
            looking = self._place(reader, f"{_word(control.short)}_{name}", control.colset, control)
            x = self._token(state, "x")
            here = f"{place.short} in {control.short}"
            takes = b.take(value, b.pair(new, any_of_them))
            begins = [b.take(state, x), b.put(looking, x), takes, *own]
            self._step(reader, f"See {here}", soon, begins, place, Role.LOOK)
            takes = b.take(value, b.pair(new, newer))
            again = [b.take(looking, x), b.put(looking, x), takes, *own]
            self._step(reader, f"See again {here}", soon, again, place)
            takes = b.take(value, b.pair(new, latest))
            goes = [b.take(looking, x), b.put(state, x), takes, b.put(taken, b.dot)]
            self._step(reader, f"Go on {here}", soon, goes, place)

    def _are_files_apart(self) -> bool:
        """Whether the files of the messages have names that are possible, and that nothing else has."""
        before = len(self.d.errors)
        statuses = {one_name(f"{o.name}.status") for o in self.owners}
        seen: dict[str, str] = {}
        for entry in self.entries:
            stem = one_name(PurePath(entry.file).stem)
            why = [f"cannot be made: {text}" for text, _ in faults(entry.file)]
            if stem in seen:
                why.append(f"has the name of another channel, `{seen[stem]}`")
            if one_name(entry.file) in statuses:
                why.append("is the status file of a program")
            seen.setdefault(stem, entry.file)
            for text in why[:1]:
                self.d.error(
                    codes.REGISTER,
                    f"the file `{entry.file}` {text}",
                    entry.origin,
                    hint="the files of a register are named by its `file` and its readers, `FILE_READER` and "
                    "`FILE_READER_taken`: give it or the other channel another file",
                )
        return len(self.d.errors) == before

    # --- elements --------------------------------------------------------------------------------

    def _token(self, place: int, name: str) -> core.Exp:
        colset = self.b.places[place].colset
        is_unit = colset.resolved.kind is Kind.UNIT
        return self.b.dot if is_unit else self.b.var(name, colset)

    def _at(self, owner: int, short: str, origin: Origin) -> _Made:
        """Where an element of an owner stands: on the topmost page of its program."""
        instance = self.owners[owner].instance
        own = [
            t
            for t, o in zip(self.net.transitions, self.of, strict=True)
            if o == owner
        ]  # fmt: skip
        top = min(own, key=lambda t: len(t.instance))
        return _Made(short, top.page, instance, top.instance_number, origin)

    def _place(self, owner: int, short: str, colset: Colset, of: FlatPlace) -> int:
        made = self._at(owner, short, of.origins[0])
        index = self.b.place(f"{made.instance.replace('/', '.')}.{short}", colset)
        self.places[index] = made
        return index

    def _step(
        self,
        owner: int,
        short: str,
        priority: int,
        arcs: Sequence[Arc],
        of: FlatPlace,
        role: Role = Role.REGISTER,
    ) -> None:
        made = replace(self._at(owner, short, of.origins[0]), role=role)
        path = f"{made.instance.replace('/', '.')}.{short}"
        self.b.transition(path, arcs, priority=priority)
        self.transitions.append(made)

    def _placed(self, net: FlatNet) -> FlatNet:
        """The net with each added element on its page, and what readers name on theirs."""
        count = len(self.net.transitions)
        transitions = [
            *net.transitions[:count],
            *(
                replace(
                    t,
                    short=made.short,
                    caption=made.short,
                    page=made.page,
                    instance=made.instance,
                    instance_number=made.number,
                    id=f"{MADE}{t.index}",
                    origin=made.origin,
                    role=made.role,
                )
                for t, made in zip(net.transitions[count:], self.transitions, strict=True)
            ),
        ]
        places = [
            replace(
                p,
                short=p.name.rpartition(".")[2],
                page=self.places[p.index].page,
                instance=self.places[p.index].instance,
                instance_number=self.places[p.index].number,
                id=f"{MADE}{p.index}p",
                origins=(self.places[p.index].origin,),
            )
            if p.index in self.places
            else p
            for p in net.places
        ]
        instances = []
        for i in net.place_instances:
            if i.place in self.places:
                p = places[i.place]
                i = replace(
                    i,
                    id=p.id,
                    name=p.short,
                    caption=p.short,
                    page=p.page,
                    instance=p.instance,
                    number=p.instance_number,
                )
            for (place, reader), copy in self.copies.items():
                owner = self.owners[reader].instance
                if i.place == place and f"{i.instance}/".startswith(f"{owner}/"):
                    i = replace(i, place=copy)
                    break
            instances.append(i)
        return replace(
            net,
            transitions=tuple(transitions),
            places=tuple(places),
            place_instances=tuple(instances),
        )


def _sets(t: FlatTransition, place: int) -> bool:
    """Whether a transition replaces the token of a register."""
    return any(a.place == place and a.kind is ArcKind.OUTPUT for a in t.arcs)


def _word(name: str) -> str:
    """A name in a path: without dots, which separate its parts."""
    return "_".join(name.replace(".", " ").split())
