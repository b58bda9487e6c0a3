"""Which shared places are channels: the entries of cell.toml, and the places that lack one."""

from __future__ import annotations

import json
from collections.abc import Iterable
from difflib import SequenceMatcher
from pathlib import PurePath

from pn2code.cell import codes, looked_at
from pn2code.cell.config import CellConfig, ChannelConfig
from pn2code.cell.owners import overlap
from pn2code.cell.partition import Channel, ChannelKind, Owner
from pn2code.cell.place_finder import PlaceFinder
from pn2code.cell.scalars import is_one_value, message_scalars
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.net.flat import ArcKind, FlatNet, FlatPlace


def channels_of(
    net: FlatNet,
    config: CellConfig,
    owners: tuple[Owner, ...],
    writers: list[set[int]],
    readers: list[set[int]],
    find: PlaceFinder,
    d: Diagnostics,
) -> Iterable[Channel]:
    """The channels of a cell, data before flags, each in the order of cell.toml.

    Args:
        net: the net.
        config: the cell.
        owners: supervisor first.
        writers, readers: per place the indices of the owners that put tokens, and of those that look or take.
        find: gives the place of a name, or reports that there is none.
        d: gets an error for each entry that cannot be a channel: not shared, several writers or readers, an initial
            marking, time stamps, tokens that no message can hold. Those are not given, but for the last three.
    """
    found = [(c, find(c.place, c.origin, "channel")) for c in config.channels]
    known = [(c, place, _kind(c, place)) for c, place in found if place is not None]
    seen: dict[int, ChannelConfig] = {}
    for entry, place, kind in sorted(known, key=lambda x: x[2] is not ChannelKind.DATA):
        if place.index in seen:
            d.error(
                codes.CELL_VALUE,
                f"place `{place.name}` has two channels",
                entry.origin,
                hint="remove one of them",
            )
            continue
        seen[place.index] = entry
        w, r = writers[place.index], readers[place.index]
        if len(w | r) < 2:
            _not_shared(net, place, [owners[i] for i in w | r], entry, d)
            continue
        if not _directed(net, place, owners, w, r, entry.origin, d):
            continue
        if place.initial is not None:
            d.error(
                codes.CHANNEL_INITIAL,
                f"channel `{place.name}` has an initial marking",
                place.origins[0],
                notes=[Note("it is a channel here", entry.origin)],
                hint="let the writer's first transition put the token",
            )
        if place.colset.timed:
            d.error(
                codes.CHANNEL_TIMED,
                f"channel `{place.name}` has the timed colour set `{place.colset.name}`, "
                "and messages carry no time stamps",
                place.origins[0],
                notes=[Note("it is a channel here", entry.origin)],
                hint="declare the channel's colour set without `timed`; let the writer delay on a place of its own",
            )
        elif message_scalars(place.colset) is None:
            d.error(
                codes.UNSUPPORTED_CHANNEL_COLSET,
                f"channel `{place.name}` has colour set `{place.colset.name}`, which no message can hold",
                place.origins[0],
                notes=[Note("it is a channel here", entry.origin)],
                hint="send scalars, lists of scalars or of products and records of scalars, and products and records "
                "of all these; the elements of a list of lists one by one",
            )
        yield Channel(
            PurePath(entry.file).stem,
            entry.file,
            place.index,
            next(iter(w)),
            next(iter(r)),
            kind,
        )


def _not_shared(
    net: FlatNet, place: FlatPlace, users: list[Owner], entry: ChannelConfig, d: Diagnostics
) -> None:
    """A channel that lacks a side: a port has lost its socket, or nothing on the other page has an arc with it."""
    lost = [
        p
        for p in net.place_instances
        if p.is_port
        and not p.is_assigned
        and p.place != place.index
        and net.places[p.place].colset.resolved == place.colset.resolved
        and not any(overlap(o.instance, p.instance) for o in users)
    ]
    lost = [p for p in lost if p.name == place.short] or lost
    bare = [
        p
        for p in net.place_instances
        if p.is_port
        and p.place == place.index
        and not any(overlap(o.instance, p.instance) for o in users)
    ]
    alike = [
        p
        for p in net.place_instances
        if p.name == place.short
        and not p.is_port
        and p.place != place.index
        and not any(overlap(o.instance, p.instance) for o in users)
    ]
    who = f"by {users[0].phrase} alone" if users else "by no owner"
    place_named = f"`{place.short}` of page `{place.page}`"
    hint = (
        f"connect place {place_named} to the page of the other owner, with a port; an entry for a place inside "
        "one program is not needed"
    )
    if lost:
        hint = f"assign port `{lost[0].name}` of page `{lost[0].page}` to place {place_named}"
    elif bare:
        hint = (
            f"port `{bare[0].name}` of page `{bare[0].page}` is connected to it, but no transition there has an arc "
            "with it: draw the arc that sends the message, or takes it"
        )
    elif alike:
        hint = (
            f"if place `{alike[0].name}` of page `{alike[0].page}` is the other side, make it a port and assign it to "
            f"place {place_named} in CPN Tools; an entry for a place inside one program is not needed"
        )
    d.error(
        codes.CHANNEL_NOT_SHARED,
        f"place `{place.name}` is used {who}, but a channel is shared by two owners",
        entry.origin,
        notes=[
            Note(
                f"port `{p.name}` of page `{p.page}` (`{p.instance}`) is not assigned to any place",
                net.places[p.place].origins[0],
            )
            for p in lost[:3]
        ],
        hint=hint,
    )


def _kind(entry: ChannelConfig, place: FlatPlace) -> ChannelKind:
    """As written; where it is not, several scalars or a list are data, and one scalar is a flag."""
    if entry.is_kind_given:
        return entry.kind
    return ChannelKind.FLAG if is_one_value(place.colset) else ChannelKind.DATA


def _directed(
    net: FlatNet,
    place: FlatPlace,
    owners: tuple[Owner, ...],
    writers: set[int],
    readers: set[int],
    at: Origin,
    d: Diagnostics,
) -> bool:
    """Whether exactly one owner puts and exactly one other takes, with plain arcs only."""

    def names(which: set[int]) -> str:
        return ", ".join(f"`{owners[i].name}`" for i in sorted(which)) or "no owner"

    if len(writers) == 1 and len(readers) == 1 and writers != readers:
        odd = [
            (t, a)
            for t in net.transitions
            for a in t.arcs
            if a.place == place.index and a.kind not in (ArcKind.INPUT, ArcKind.OUTPUT)
        ]
        for t, a in odd:
            d.error(
                codes.CHANNEL_DIRECTION,
                f"{a.kind.value} arc at channel `{place.name}`: only plain input and output arcs work across files",
                a.origin,
                notes=[f"transition `{t.name}`", Note("it is a channel here", at)],
            )
        return not odd
    says, hint = looked_at.told(net, place.index, owners, writers, readers) or (
        f"is written by {names(writers)} and read by {names(readers)}",
        "exactly one owner must have output arcs to it, exactly one other owner input arcs from it",
    )
    d.error(
        codes.CHANNEL_DIRECTION,
        f"channel `{place.name}` {says}",
        place.origins[0],
        notes=[Note("it is a channel here", at)],
        hint=hint,
    )
    return False


def report_undeclared(
    net: FlatNet,
    owners: tuple[Owner, ...],
    writers: list[set[int]],
    readers: list[set[int]],
    config: CellConfig,
    find: PlaceFinder,
    d: Diagnostics,
) -> None:
    """Shared places without an entry; not those whose entry is there, but names another place or none.

    Args as for `channels_of`; each such place is an error.
    """
    declared: set[int] = set()
    misspelt: list[str] = []
    for c in config.channels:
        meant = find.meant(c.place)
        declared |= set(meant)
        misspelt += [] if meant else [c.place]
    lacking = {
        place.index: place
        for place in net.places
        if len(writers[place.index] | readers[place.index]) > 1 and place.index not in declared
    }
    for name in misspelt[: len(lacking)]:
        likeness = {
            i: SequenceMatcher(None, name, place.short).ratio() for i, place in lacking.items()
        }
        del lacking[max(likeness, key=lambda i: likeness[i])]
    for place in lacking.values():
        who = ", ".join(
            f"`{owners[i].name}`" for i in sorted(writers[place.index] | readers[place.index])
        )
        kind = "flag" if is_one_value(place.colset) else "data"
        puts, looks = writers[place.index], readers[place.index]
        if looked_at.is_register(net, place.index, owners, puts, looks):
            kind = "register"
        d.error(
            codes.CHANNEL_UNDECLARED,
            f"place `{place.name}` is shared by {who}, but is not a channel",
            place.origins[0],
            hint=f"add to {config.path.name}:\n[[channel]]\nplace = {json.dumps(place.short, ensure_ascii=False)}\n"
            f'file = {json.dumps(place.short + ".robcad", ensure_ascii=False)}\nkind = "{kind}"',
        )
