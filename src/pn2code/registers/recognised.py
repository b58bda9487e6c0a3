"""Which places of a cell are registers: those that are declared, if the net uses them as such; else why not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.cell import codes
from pn2code.cell.config import CellConfig, ChannelConfig
from pn2code.cell.looked_at import only_looks
from pn2code.cell.partition import SUPERVISOR, Owner
from pn2code.cell.place_finder import PlaceFinder
from pn2code.cell.scalars import message_scalars
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.ml.core import terms as core
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, FlatPlace, FlatTransition
from pn2code.robot_scripts.tokens import initial_tokens, tokens

_HINT = (
    "a register has one token from the start, which each transition of the supervisor that uses it replaces or puts "
    "back, and each of a robot or device puts back (docs/cookbook.md, `A value that several read`)"
)
_SENT = (
    "let who knows the value send it in a message to the supervisor, which takes it and puts it "
    "into the register: readers are answered by who sets it, and a robot that moves answers nobody "
    "(docs/adr/015-values-that-many-read.md)"
)


@frozen
class Register:
    """An entry of cell.toml that is a register, its place, and who looks there."""

    entry: ChannelConfig
    place: FlatPlace
    readers: tuple[int, ...]


def registers(
    net: FlatNet,
    config: CellConfig,
    owners: Sequence[Owner],
    of: Sequence[int],
    d: Diagnostics,
) -> list[Register]:
    """The registers of a cell; of what cannot be one an error says why.

    Args:
        net: the net.
        config: the cell.
        owners: supervisor first.
        of: the owner of each transition.
        d: diagnostics.
    """
    find = PlaceFinder(net, d)
    found: list[Register] = []
    for entry in (c for c in config.channels if c.is_register):
        place = find(entry.place, entry.origin, "register")
        if place is None:
            continue
        if any(r.place.index == place.index for r in found):
            refuse(d, place, entry, "has two entries")
        else:
            found += _register(net, config, owners, of, entry, place, d)
    return found


def refuse(
    d: Diagnostics,
    place: FlatPlace,
    entry: ChannelConfig,
    says: str,
    at: Origin | None = None,
    hint: str = _HINT,
) -> None:
    """An error: this place is no register, for what it `says`."""
    d.error(
        codes.REGISTER,
        f"register `{place.name}` {says}",
        at or place.origins[0],
        notes=[Note("it is a register here", entry.origin)],
        hint=hint,
    )


def _register(
    net: FlatNet,
    config: CellConfig,
    owners: Sequence[Owner],
    of: Sequence[int],
    entry: ChannelConfig,
    place: FlatPlace,
    d: Diagnostics,
) -> Iterator[Register]:
    before = len(d.errors)
    users = {
        owner
        for t, owner in zip(net.transitions, of, strict=True)
        if any(a.place == place.index for a in t.arcs)
    }
    setters = sorted(i for i in users if not only_looks(net, place.index, owners[i]))
    readers = sorted(users - {SUPERVISOR})
    others = [owners[i].phrase for i in setters if i != SUPERVISOR]
    if others:
        refuse(
            d,
            place,
            entry,
            f"is changed by {', '.join(others)}, but only the supervisor sets registers",
            hint=_SENT,
        )
    elif not setters:
        refuse(d, place, entry, "is set by no transition of the supervisor")
    if not readers:
        refuse(d, place, entry, "is read by no robot or device")
    if place.colset.timed:
        refuse(
            d,
            place,
            entry,
            f"has the timed colour set `{place.colset.name}`, and values carry no time stamps",
        )
    elif message_scalars(place.colset) is None:
        refuse(d, place, entry, f"has colour set `{place.colset.name}`, which no message can hold")
    elif not _is_one_initially(net, place):
        refuse(d, place, entry, "does not hold exactly one token in its initial marking")
    find = PlaceFinder(net, Diagnostics())
    if any(place.index in find.meant(i.place) for i in config.inputs):
        refuse(d, place, entry, "is an [[input]] as well")
    if any(place.index in find.meant(name) for name in config.supervisor.final):
        refuse(d, place, entry, "is a final place as well")
    for t in net.transitions:
        odd = _odd(t, place.index, net.program)
        if odd is not None:
            refuse(d, place, entry, f"and transition `{t.name}`: {odd[0]}", odd[1])
    if len(d.errors) == before:
        yield Register(entry, place, tuple(readers))


def _is_one_initially(net: FlatNet, place: FlatPlace) -> bool:
    if place.initial is None:
        return False
    found = list(initial_tokens(*place.initial, net.program))
    return len(found) == 1 and found[0][1] is not None and len(found[0][1]) == 1


def _odd(t: FlatTransition, place: int, program: core.Program) -> tuple[str, Origin] | None:
    """What a transition does with a register that leaves more or less than one token there, and where."""
    arcs = [a for a in t.arcs if a.place == place]
    if not arcs:
        return None
    for a in arcs:
        if a.kind in (ArcKind.INHIBITOR, ArcKind.RESET):
            return f"{a.kind.value} arc", a.origin
        if a.kind is not ArcKind.OUTPUT and not a.takes_one:
            return "the arc does not take just one token", a.origin
        if a.kind is not ArcKind.INPUT and not _puts_one(a):
            return "the arc does not put just one token", a.origin
    taken = sum(a.kind is not ArcKind.OUTPUT for a in arcs)
    put = sum(a.kind is not ArcKind.INPUT for a in arcs)
    if (taken, put) != (1, 1):
        return f"it takes {taken} tokens and puts {put}", arcs[0].origin
    return None


def _puts_one(arc: FlatArc) -> bool:
    if arc.inscription is None:
        return False
    outcomes = list(tokens(arc.inscription.value, arc.inscription.form))
    return all(found is not None and len(found) == 1 for _, found in outcomes)
