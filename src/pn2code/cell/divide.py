"""Partition: each transition gets its owner, each place that two owners share becomes a channel.

In: a `FlatNet` and a `CellConfig` (or None: the supervisor owns the whole net). Out: a `Partition` or diagnostics.

    places        Top.Robot1.Waiting -> robot1     Top.flag1_interno -> channel supervisor -> robot1
    transitions   Top.Robot1.Accept  -> robot1     Top.Supervisor.Approach.Send -> supervisor
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import SequenceMatcher
from pathlib import PurePath

from pn2code.cell import codes
from pn2code.cell.config import CellConfig, ChannelConfig
from pn2code.cell.partition import Channel, ChannelKind, Input, Owner, OwnerKind, Partition
from pn2code.cell.scalars import scalars_of
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.net.finding import Finder
from pn2code.net.flat import ArcKind, FlatNet, FlatPlace


def divide(net: FlatNet, config: CellConfig | None, d: Diagnostics) -> Partition | None:
    """Divides the net among the owners of a cell; None when an error was reported."""
    if config is None:
        owner = Owner(0, "supervisor", OwnerKind.SUPERVISOR, "")
        return Partition(
            net, (owner,), (0,) * len(net.transitions), (0,) * len(net.places), (), (), ()
        )
    before = len(d.errors)
    owners = _owners(net, config, d)
    if len(d.errors) != before:
        return None
    transition_owner = _transition_owners(net, owners, d)
    if len(d.errors) != before:
        return None
    writers, readers = _touching(net, transition_owner)
    find = PlaceFinder(net, d)
    channels = tuple(_channels(net, config, owners, writers, readers, find, d))
    _undeclared(net, owners, writers, readers, config, find, d)
    inputs = tuple(_inputs(config, writers, readers, find, d))
    final = _final(net, config, owners, transition_owner, find, d)
    if len(d.errors) != before:
        return None
    _limits(net, channels, inputs, config, d)
    if len(d.errors) != before:
        return None
    shared = {c.place for c in channels}
    place_owner = tuple(
        None if i in shared else next(iter(sorted(writers[i] | readers[i])), 0)
        for i in range(len(net.places))
    )
    primitives = {
        net.program.globals[name].uid: primitive
        for name, primitive in config.primitives.items()
        if name in net.program.globals
    }
    return Partition(
        net, owners, transition_owner, place_owner, channels, inputs, final, primitives, config
    )


def _owners(net: FlatNet, config: CellConfig, d: Diagnostics) -> tuple[Owner, ...]:
    paths = _instance_paths(net)
    wanted = [
        ("supervisor", OwnerKind.SUPERVISOR, config.supervisor.instance, config.supervisor.origin)
    ]
    wanted += [(r.name, OwnerKind.ROBOT, r.instance, r.origin) for r in config.robots]
    wanted += [(r.name, OwnerKind.DEVICE, r.instance, r.origin) for r in config.devices]
    owners: list[Owner] = []
    for name, kind, instance, origin in wanted:
        found = [p for p in paths if p == instance or p.endswith("/" + instance)]
        if len(found) == 1:
            clash = next((o for o in owners if _overlap(o.instance, found[0])), None)
            if clash:
                d.error(
                    codes.CELL_OWNER,
                    f"`{name}` and `{clash.name}` would both own page instance `{found[0]}`",
                    origin,
                    hint="give each owner a substitution transition of its own",
                )
            owners.append(Owner(len(owners), name, kind, found[0]))
        elif not found:
            last = [p.rsplit("/", 1)[-1] for p in paths]
            d.error(
                codes.CELL_UNKNOWN_PAGE,
                f"the net has no page instance `{instance}` for `{name}`",
                origin,
                hint=did_you_mean(
                    instance,
                    [*paths, *last],
                    f"page instances of the net: {', '.join(f'`{p}`' for p in paths[:12])}",
                ),
            )
        else:
            d.error(
                codes.CELL_UNKNOWN_PAGE,
                f"`{instance}` is the name of {len(found)} page instances",
                origin,
                hint="write the path: " + " or ".join(f"`{p}`" for p in found[:4]),
            )
    return tuple(owners)


def _overlap(a: str, b: str) -> bool:
    return a == b or a.startswith(b + "/") or b.startswith(a + "/")


def _instance_paths(net: FlatNet) -> list[str]:
    """All page instances that hold something, and the paths above them, in order."""
    paths: dict[str, None] = {}
    for instance in [*(t.instance for t in net.transitions), *(p.instance for p in net.places)]:
        parts = instance.split("/")
        for i in range(1, len(parts) + 1):
            paths.setdefault("/".join(parts[:i]))
    return sorted(paths)


def _transition_owners(net: FlatNet, owners: tuple[Owner, ...], d: Diagnostics) -> tuple[int, ...]:
    out = []
    for t in net.transitions:
        owner = next(
            (
                o.index
                for o in owners
                if t.instance == o.instance or t.instance.startswith(o.instance + "/")
            ),
            None,
        )
        if owner is None:
            d.error(
                codes.CELL_OWNER,
                f"transition `{t.name}` belongs to no owner",
                t.origin,
                notes=[f"it lies on page instance `{t.instance}`"],
                hint="move it to the page of the supervisor or of a robot, or name its page instance in cell.toml",
            )
        out.append(0 if owner is None else owner)
    return tuple(out)


def _touching(
    net: FlatNet, transition_owner: tuple[int, ...]
) -> tuple[list[set[int]], list[set[int]]]:
    """Per place: the owners that put tokens and those that take, test, inhibit or reset."""
    writers: list[set[int]] = [set() for _ in net.places]
    readers: list[set[int]] = [set() for _ in net.places]
    for t, owner in zip(net.transitions, transition_owner, strict=True):
        for arc in t.arcs:
            if arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH):
                writers[arc.place].add(owner)
            if arc.kind is not ArcKind.OUTPUT:
                readers[arc.place].add(owner)
    return writers, readers


class PlaceFinder:
    """Resolves names of places in cell.toml: the name, or as much of the path as makes it unique."""

    def __init__(self, net: FlatNet, d: Diagnostics) -> None:
        self._net = net
        self._d = d
        self._finder = Finder.of_places(net)
        self._lost = {p.place for p in net.place_instances if p.is_port and not p.is_assigned}

    def __call__(self, name: str, at: Origin, what: str) -> FlatPlace | None:
        """The place; None after an error at `at`, which begins with `what`."""
        found = [self._net.places[i] for i in self.meant(name)]
        if len(found) == 1:
            return found[0]
        if found:
            self._d.error(
                codes.CELL_UNKNOWN_PLACE,
                f"{what}: `{name}` is the name of {len(found)} places",
                at,
                hint="write the path: " + " or ".join(f"`{p.name}`" for p in found[:4]),
            )
        else:
            names = [p.short for p in self._net.places] + [p.name for p in self._net.places]
            self._d.error(
                codes.CELL_UNKNOWN_PLACE,
                f"{what}: the net has no place `{name}`",
                at,
                hint=did_you_mean(name, names),
            )
        return None

    def meant(self, name: str) -> list[int]:
        """The indices of what it may mean. A port that has lost its socket is not meant where something else is."""
        found = self._finder.ending(name)
        return [i for i in found if i not in self._lost] or found


def _final(
    net: FlatNet,
    config: CellConfig,
    owners: tuple[Owner, ...],
    transition_owner: tuple[int, ...],
    find: PlaceFinder,
    d: Diagnostics,
) -> tuple[int, ...]:
    """The places whose tokens say that the supervisor has finished: its own, and it puts tokens there."""
    writers, readers = _touching(net, transition_owner)
    out: list[int] = []
    supervisor = config.supervisor
    for name, at in zip(supervisor.final, supervisor.final_origins, strict=True):
        place = find(name, at, "final")
        if place is None:
            continue
        others = sorted((writers[place.index] | readers[place.index]) - {0})
        if place.index in out:
            d.error(
                codes.CELL_VALUE,
                f"`final` names place `{place.name}` twice",
                at,
                hint="remove one of the names",
            )
        elif others:
            who = " and ".join(owners[i].phrase for i in others)
            shared = 0 in writers[place.index] | readers[place.index] or len(others) > 1
            d.error(
                codes.CELL_FINAL,
                f"final: place `{place.name}` "
                + (f"is shared with {who}" if shared else f"belongs to {who}")
                + ", and a final place belongs to the supervisor alone",
                at,
                notes=[Note("the place is here", place.origins[0])],
                hint="let a transition of the supervisor put a token into a place of its own when the cell has "
                "finished, and name that place",
            )
        elif place.colset.timed:
            d.error(
                codes.CELL_FINAL,
                f"final: place `{place.name}` has the timed colour set `{place.colset.name}`, so that it is not clear "
                "whether the cell has finished when the token is put or when it becomes available",
                at,
                notes=[Note("the place is here", place.origins[0])],
                hint="let a transition take the timed token and put one without a time stamp into the final place",
            )
        elif 0 not in writers[place.index] and place.initial is None:
            # The cell is as it is drawn; what is proved about its end will say so as well.
            d.warning(
                codes.CELL_FINAL,
                f"final: no transition of the supervisor puts a token into place `{place.name}`",
                at,
                notes=[Note("the place is here", place.origins[0])],
                hint="name a place that the supervisor marks when the cell has finished",
            )
        out.append(place.index)
    return tuple(out)


def _channels(
    net: FlatNet,
    config: CellConfig,
    owners: tuple[Owner, ...],
    writers: list[set[int]],
    readers: list[set[int]],
    find: PlaceFinder,
    d: Diagnostics,
) -> Iterable[Channel]:
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
        elif not _fixed(place.colset):
            d.error(
                codes.UNSUPPORTED_CHANNEL_COLSET,
                f"channel `{place.name}` has colour set `{place.colset.name}`, which has no fixed number of scalars",
                place.origins[0],
                notes=[Note("it is a channel here", entry.origin)],
                hint="send products and records of scalars; for a list, send its elements one by one",
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
        and not any(_overlap(o.instance, p.instance) for o in users)
    ]
    lost = [p for p in lost if p.name == place.short] or lost
    bare = [
        p
        for p in net.place_instances
        if p.is_port
        and p.place == place.index
        and not any(_overlap(o.instance, p.instance) for o in users)
    ]
    alike = [
        p
        for p in net.place_instances
        if p.name == place.short
        and not p.is_port
        and p.place != place.index
        and not any(_overlap(o.instance, p.instance) for o in users)
    ]
    who = f"by {users[0].phrase} alone" if users else "by no owner"
    place_named = f"`{place.short}` of page `{place.page}`"
    hint = (
        f"connect place {place_named} to the page of the other owner, with a port; an entry for a place inside "
        "one program is not needed"
    )
    if lost:
        hint = f"assign port `{lost[0].name}` of page `{lost[0].page}` to place {place_named} in CPN Tools"
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
    """As written; where it is not, several scalars are data, and one is a flag."""
    if entry.is_kind_given:
        return entry.kind
    return ChannelKind.FLAG if len(scalars_of(place.colset) or ()) == 1 else ChannelKind.DATA


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
    d.error(
        codes.CHANNEL_DIRECTION,
        f"channel `{place.name}` is written by {names(writers)} and read by {names(readers)}",
        place.origins[0],
        notes=[Note("it is a channel here", at)],
        hint="exactly one owner must have output arcs to it, exactly one other owner input arcs from it",
    )
    return False


def _undeclared(
    net: FlatNet,
    owners: tuple[Owner, ...],
    writers: list[set[int]],
    readers: list[set[int]],
    config: CellConfig,
    find: PlaceFinder,
    d: Diagnostics,
) -> None:
    """Shared places without an entry; not those whose entry is there, but names another place or none."""
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
        kind = "flag" if len(scalars_of(place.colset) or ()) == 1 else "data"
        d.error(
            codes.CHANNEL_UNDECLARED,
            f"place `{place.name}` is shared by {who}, but is not a channel",
            place.origins[0],
            hint=f'add to {config.path.name}: [[channel]] place = "{place.short}", '
            f'file = "{place.short}.robcad", kind = "{kind}"',
        )


def _inputs(
    config: CellConfig,
    writers: list[set[int]],
    readers: list[set[int]],
    find: PlaceFinder,
    d: Diagnostics,
) -> Iterable[Input]:
    seen: set[int] = set()
    for entry in config.inputs:
        place = find(entry.place, entry.origin, "input")
        if place is None:
            continue
        if place.index in seen:
            d.error(
                codes.CELL_VALUE,
                f"place `{place.name}` has two inputs",
                entry.origin,
                hint="remove one of them",
            )
            continue
        seen.add(place.index)
        if (writers[place.index] | readers[place.index]) - {0}:
            d.error(
                codes.CELL_OWNER,
                f"input place `{place.name}` is used by a robot",
                entry.origin,
                hint="files are read by the supervisor: give the data to the robot through a channel",
            )
        elif not _fixed(place.colset):
            d.error(
                codes.UNSUPPORTED_CHANNEL_COLSET,
                f"input place `{place.name}` has colour set `{place.colset.name}`, "
                "which has no fixed number of scalars",
                place.origins[0],
                notes=[Note("its marking is read from a file here", entry.origin)],
            )
        else:
            yield Input(PurePath(entry.file).stem, entry.file, place.index)


MOST_CHANNELS = 128
MOST_PEERS = 64
MOST_SCALARS = 64
"""What cnative/include/pn/pn_cell.h and pn_channel.h have room for."""


def _limits(
    net: FlatNet,
    channels: tuple[Channel, ...],
    inputs: tuple[Input, ...],
    config: CellConfig,
    d: Diagnostics,
) -> None:
    """What a supervisor has no room for."""
    at = config.supervisor.origin
    if len(channels) > MOST_CHANNELS:
        text = (
            f"the cell has {len(channels)} channels, and a supervisor has room for {MOST_CHANNELS}"
        )
        d.error(codes.CHANNEL_LIMIT, text, at, hint="send several values in one message")
    if len(config.programs) > MOST_PEERS:
        many = len(config.programs)
        text = f"the cell has {many} robots and devices, and a supervisor has room for {MOST_PEERS}"
        d.error(
            codes.CHANNEL_LIMIT, text, at, hint="combine several small devices into one program"
        )
    for name, place in (
        *((c.name, c.place) for c in channels),
        *((i.name, i.place) for i in inputs),
    ):
        flat = net.places[place]
        count = len(scalars_of(flat.colset) or ())
        if count > MOST_SCALARS:
            d.error(
                codes.CHANNEL_LIMIT,
                f"a message of `{name}` has {count} values, but at most {MOST_SCALARS} are possible",
                flat.origins[0],
                hint=f"divide colour set `{flat.colset.name}` among several places",
            )


_SCALARS = {
    Kind.UNIT,
    Kind.BOOL,
    Kind.INT,
    Kind.INTINF,
    Kind.REAL,
    Kind.STRING,
    Kind.ENUM,
    Kind.INDEX,
}


def _fixed(colset: Colset) -> bool:
    """Whether a token is a fixed number of scalars."""
    c = colset.resolved
    if c.kind in (Kind.PRODUCT, Kind.RECORD):
        return all(part is not None and _fixed(part) for part in c.components)
    if c.kind is Kind.SUBSET:
        base = c.components[0]
        return base is not None and _fixed(base)
    return c.kind in _SCALARS
