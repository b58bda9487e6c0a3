"""Which monitors a net has, of which kind, and what they watch.

    found = resolve(document, typed, flat, d)      # the enabled ones, in order of the file

A file names the nodes of a monitor by XML id and page instance; here they are places and transitions of the flat net.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.ml.core.colsets import Kind as ColsetKind
from pn2code.monitors.codes import MONITOR_ERROR, UNSUPPORTED_MONITOR
from pn2code.net.flat import FlatNet, FlatTransition, PlaceInstance
from pn2code.net.instances import unique_names
from pn2code.reading.document import Document, RawInstance, RawMonitor


class Kind(Enum):
    """What a monitor does; the value is CPN Tools' number in files."""

    MARKING_SIZE = "0"
    BREAKPOINT = "1"
    USER_DEFINED = "2"
    DATA_COLLECTION = "3"
    WRITE_IN_FILE = "4"
    LIST_LENGTH = "5"
    COUNT_OCCURRENCES = "6"
    PLACE_CONTENT = "7"
    TRANSITION_ENABLED = "8"


_WORDS = (
    # The first that fits; the tools of the last twenty years spell them in several ways.
    ("markingsize", Kind.MARKING_SIZE),
    ("listlength", Kind.LIST_LENGTH),
    ("counttransition", Kind.COUNT_OCCURRENCES),
    ("placecontent", Kind.PLACE_CONTENT),
    ("transitionenabled", Kind.TRANSITION_ENABLED),
    ("breakpoint", Kind.BREAKPOINT),
    ("datacoll", Kind.DATA_COLLECTION),
    ("userdef", Kind.USER_DEFINED),
    ("writeinfile", Kind.WRITE_IN_FILE),
)
_NAMES = {
    Kind.MARKING_SIZE: "marking size",
    Kind.BREAKPOINT: "breakpoint",
    Kind.USER_DEFINED: "user-defined",
    Kind.DATA_COLLECTION: "data collection",
    Kind.WRITE_IN_FILE: "write in file",
    Kind.LIST_LENGTH: "list length",
    Kind.COUNT_OCCURRENCES: "count transition occurrences",
    Kind.PLACE_CONTENT: "place content breakpoint",
    Kind.TRANSITION_ENABLED: "transition enabled breakpoint",
}
BREAKPOINTS = frozenset({Kind.BREAKPOINT, Kind.PLACE_CONTENT, Kind.TRANSITION_ENABLED})
COLLECTORS = frozenset(
    {Kind.MARKING_SIZE, Kind.LIST_LENGTH, Kind.COUNT_OCCURRENCES, Kind.DATA_COLLECTION}
)


def kind_of(text: str) -> Kind | None:
    """The kind that a file means by its type: a number, or words in some spelling."""
    if text.strip() in {k.value for k in Kind}:
        return Kind(text.strip())
    letters = re.sub(r"[^a-z]", "", text.lower())
    return next((kind for word, kind in _WORDS if word in letters), None)


def kind_text(kind: Kind) -> str:
    """The kind in words."""
    return _NAMES[kind]


def ml_name(name: str) -> str:
    """CPN Tools' rule for names: cut at the first character that cannot stand in one, the others become `_`."""
    kept = re.match(r"[A-Za-z0-9_' .\-]*", " ".join(name.split("\n")).strip())
    assert kept is not None
    return re.sub(r"[ .\-]", "_", kept.group().strip())


@frozen
class Monitor:
    """A monitor whose nodes have been found.

    Args:
        id, name: as in the file.
        ml_name: the name as an ML identifier, of its structure and its files.
        kind: what it does.
        places: the watched place instances, sorted by `mark_name`.
        transitions: the watched transition instances, in order of the flat net.
        functions: the texts by name, lower case: "predicate", "observer", "init", "action", "stop".
        options: by name, lower case.
        origin: the monitor.
    """

    id: str
    name: str
    ml_name: str
    kind: Kind
    places: tuple[PlaceInstance, ...]
    transitions: tuple[FlatTransition, ...]
    functions: Mapping[str, SourceText]
    options: Mapping[str, str]
    origin: Origin

    def option(self, name: str) -> bool:
        """A switch of the monitor."""
        return self.options.get(name.lower(), "").strip().lower() == "true"


def mark_name(place: PlaceInstance) -> str:
    """The argument that is the marking of a place: `Top'Buffer_1_mark`."""
    return f"{ml_name(place.page)}'{ml_name(place.name)}_{place.number}_mark"


def resolve(document: Document, flat: FlatNet, d: Diagnostics) -> list[Monitor]:
    """The monitors that are not disabled, in order of the file; those that are wrong are warned of and left out."""
    nodes = _Nodes(document, flat)
    found: list[Monitor] = []
    for raw in document.monitors:
        if not raw.disabled and raw_option(raw, "disabled") != "true":
            monitor = _resolve(raw, nodes, d)
            if monitor is not None:
                found.append(monitor)
    return found


def raw_option(raw: RawMonitor, name: str) -> str:
    """An option of a monitor as the file has it, lower case."""
    return next((v.strip().lower() for n, v in raw.options if n.lower() == name), "")


def _resolve(raw: RawMonitor, nodes: _Nodes, d: Diagnostics) -> Monitor | None:
    kind = kind_of(raw.type)
    if kind is None:
        d.warning(
            UNSUPPORTED_MONITOR,
            f"monitor `{raw.name}` is of the unknown kind `{raw.type}`",
            raw.origin,
            hint="it is left out of the simulation",
        )
        return None
    places: list[PlaceInstance] = []
    transitions: list[FlatTransition] = []
    for identity, instance in raw.nodes:
        place = nodes.place(identity, instance)
        transition = nodes.transition(identity, instance)
        if place is not None:
            places.append(place)
        elif transition is not None:
            transitions.append(transition)
        else:
            d.warning(
                MONITOR_ERROR,
                f"monitor `{raw.name}` watches `{identity}`, which is no place or transition of the net",
                raw.origin,
                hint="it is left out of the simulation; add the node again, or delete the monitor",
            )
            return None
    monitor = Monitor(
        id=raw.id,
        name=raw.name,
        ml_name=ml_name(raw.name),
        kind=kind,
        places=tuple(sorted(places, key=mark_name)),
        transitions=tuple(sorted(set(transitions), key=lambda t: t.index)),
        functions={_function(n): text for n, text in raw.declarations if text.text.strip()},
        options={n.lower(): value for n, value in raw.options},
        origin=raw.origin,
    )
    return monitor if _has_nodes(monitor, d) and _has_lists(monitor, nodes.net, d) else None


def _function(name: str) -> str:
    """`Init function` and `Init` are the same."""
    return name.strip().lower().removesuffix("function").strip()


def _has_lists(m: Monitor, net: FlatNet, d: Diagnostics) -> bool:
    """Only the length of a list can be measured."""
    if m.kind is not Kind.LIST_LENGTH:
        return True
    if net.places[m.places[0].place].colset.whole.kind is ColsetKind.LIST:
        return True
    d.warning(
        MONITOR_ERROR,
        f"monitor `{m.name}` (list length) watches place `{m.places[0].name}`, whose tokens are no lists",
        m.origin,
        hint="it is left out of the simulation; a marking size monitor counts tokens",
    )
    return False


def _has_nodes(m: Monitor, d: Diagnostics) -> bool:
    """The standard monitors watch exactly one node."""
    needs_place = m.kind in (Kind.MARKING_SIZE, Kind.LIST_LENGTH, Kind.PLACE_CONTENT)
    needs_transition = m.kind in (Kind.COUNT_OCCURRENCES, Kind.TRANSITION_ENABLED)
    missing = (
        "place"
        if needs_place and not m.places
        else "transition"
        if needs_transition and not m.transitions
        else ""
    )
    if missing:
        d.warning(
            MONITOR_ERROR,
            f"monitor `{m.name}` ({kind_text(m.kind)}) watches no {missing}",
            m.origin,
            hint="it is left out of the simulation",
        )
    return not missing


class _Nodes:
    """Finds places and transitions by XML id and page instance."""

    def __init__(self, document: Document, flat: FlatNet) -> None:
        self.net = flat
        self._places: dict[str, list[PlaceInstance]] = {}
        for place in flat.place_instances:
            self._places.setdefault(place.id, []).append(place)
        self._transitions: dict[str, list[FlatTransition]] = {}
        for t in flat.transitions:
            self._transitions.setdefault(t.id, []).append(t)
        pages = {p.id: p.name for p in document.pages}
        names: dict[str, str] = {}
        for page in document.pages:
            leading = [(t.id, t.name) for t in page.transitions if t.substitution is not None]
            names |= unique_names(leading)
        self._paths = dict(_paths(document.instances, "", pages, names))

    def place(self, identity: str, instance: str) -> PlaceInstance | None:
        """A place instance; the first one when the page instance is not known."""
        found = self._places.get(identity, [])
        path = self._paths.get(instance)
        return next((p for p in found if p.instance == path), found[0] if found else None)

    def transition(self, identity: str, instance: str) -> FlatTransition | None:
        """A transition instance; the first one when the page instance is not known."""
        found = self._transitions.get(identity, [])
        path = self._paths.get(instance)
        return next((t for t in found if t.instance == path), found[0] if found else None)


def _paths(
    instances: tuple[RawInstance, ...],
    above: str,
    pages: Mapping[str, str],
    transitions: Mapping[str, str],
) -> Iterator[tuple[str, str]]:
    """Id and path of each page instance, as in the flat net (but that prime pages of one name get a number there)."""
    for i in instances:
        own = pages.get(i.page, "") if i.page else transitions.get(i.transition, "")
        segment = own.replace("/", "_")
        path = f"{above}/{segment}" if above else segment
        yield i.id, path
        yield from _paths(i.below, path, pages, transitions)
