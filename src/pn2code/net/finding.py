"""What may be meant by the name of a place or transition that a user writes.

    places = Finder.of_places(net)
    places.named("Top'Buffer")              # as in the queries of CPN Tools: all instances that this may be
    places.ending("Supervisor.Finished")    # indices of those whose path this is, or ends in this

Two elements may have one name: `A B` and `A_B` are both `A_B` for the engine, and nobody keeps an author from writing
the same name twice. So all that may be meant is given, and whoever asks refuses what is more than one. The id of an
element in the place of its name, `Top'ID12`, is always of one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from pn2code.base.frozen import frozen
from pn2code.net.engine_names import EngineNames, legal_name
from pn2code.net.flat import FlatNet, PlaceInstance


@frozen
class Instance:
    """A place or transition on an instance of its page.

    Args:
        element: its XML id.
        number: that of the page instance.
        index: in `FlatNet.places` or `FlatNet.transitions`.
        path: as in traces; of a member of a merged place, where that member stands.
        full: `Page'Name` as the engine writes it, another one for each element of a page.
        drawn: the path with the names as they are drawn; those of traces differ where two elements have one.
    """

    element: str
    number: int
    index: int
    path: str
    full: str
    drawn: str


@frozen
class _Element:
    """What is needed of a place or transition."""

    instance: Instance
    page: str
    names: tuple[str, ...]
    """each way to write its own name, without the page"""


class Finder:
    """The places, or the transitions, of a net by what users call them."""

    def __init__(
        self,
        elements: Iterable[_Element],
        paths: Sequence[tuple[str, str]],
        sets: Sequence[tuple[str, int]] = (),
    ) -> None:
        self._own = paths
        self._all: list[Instance] = []
        self._by_name: dict[str, list[Instance]] = {}
        self.bare: dict[str, list[str]] = {}
        for e in elements:
            self._all.append(e.instance)
            for name in dict.fromkeys(e.names):
                for text in (f"{e.page}'{name}", name):
                    self._by_name.setdefault(text, []).append(e.instance)
                if e.instance.full not in self.bare.setdefault(name, []):
                    self.bare[name].append(e.instance.full)
        self.paths = _unique(self._all) | {path: index for index, (path, _) in enumerate(paths)}
        """Those of traces, and those of the ports and the members of fusion sets where only one place has it."""
        self.doubtful = _doubtful([*((x.drawn, x.index) for x in self._all), *sets])
        """Paths that several have as they are drawn (`B.P` on page `A`, and `P` on page `B` below it)."""

    @staticmethod
    def of_places(net: FlatNet) -> Finder:
        """The places; each member of a merged place has its own name."""
        engine = EngineNames(net)
        return Finder(
            (
                _element(
                    Instance(
                        p.id,
                        p.number,
                        p.place,
                        _path(net, p),
                        engine.place_instance(p).rpartition(" ")[0],
                        _drawn(p.instance, p.name),
                    ),
                    p.page,
                    p.name,
                    p.caption,
                )
                for p in net.place_instances
            ),
            [(p.name, p.short) for p in net.places],
            [(f"Fusion.{f.name}", f.place) for f in net.fusions if f.place >= 0],
        )

    @staticmethod
    def of_transitions(net: FlatNet) -> Finder:
        """The transitions."""
        engine = EngineNames(net)
        return Finder(
            (
                _element(
                    Instance(
                        t.id,
                        t.instance_number,
                        t.index,
                        t.name,
                        engine.transition(t.index).rpartition(" ")[0],
                        _drawn(t.instance, t.short),
                    ),
                    t.page,
                    t.short,
                    t.caption,
                )
                for t in net.transitions
            ),
            [(t.name, t.short) for t in net.transitions],
        )

    @property
    def full(self) -> list[str]:
        """`Page'Name` of all elements."""
        return list(dict.fromkeys(x.full for x in self._all))

    def named(self, text: str) -> Sequence[Instance]:
        """All that may be meant by `Page'Name`, or by a name alone."""
        return self._by_name.get(text, ())

    def drawn(self, path: str) -> list[Instance]:
        """One for each of those that have this path as they are drawn."""
        found = {x.index: x for x in reversed(self._all) if x.drawn == path}
        for index in self.doubtful.get(path, ()):
            found.setdefault(index, next(x for x in self._all if x.index == index))
        return list(found.values())

    def surely(self, instance: Instance) -> str:
        """A name that only this element has; its path in quotes where there is no better one."""
        page = instance.full.partition("'")[0]
        for text in (instance.full, f"{page}'{instance.element}"):
            if {x.element for x in self.named(text)} == {instance.element}:
                return text
        return f'"{instance.path}"'

    def ending(self, text: str) -> list[int]:
        """The indices of what has this path; or else of all whose name this is, or whose path ends in it.

        Names of ports, and of members of fusion sets, count where nothing else has the name.
        """
        if text in self.doubtful:
            return list(self.doubtful[text])
        if text in self.paths:
            return [self.paths[text]]
        own = {i for i, (path, short) in enumerate(self._own) if text == short or _ends(path, text)}
        if own:
            own.update(*(found for path, found in self.doubtful.items() if _ends(path, text)))
        return sorted(own or {x.index for x in self._all if _ends(x.path, text)})


def _unique(instances: Iterable[Instance]) -> dict[str, int]:
    found: dict[str, set[int]] = {}
    for x in instances:
        found.setdefault(x.path, set()).add(x.index)
    return {path: min(meant) for path, meant in found.items() if len(meant) == 1}


def _doubtful(drawn: Iterable[tuple[str, int]]) -> dict[str, tuple[int, ...]]:
    found: dict[str, set[int]] = {}
    for path, index in drawn:
        found.setdefault(path, set()).add(index)
    return {path: tuple(sorted(meant)) for path, meant in found.items() if len(meant) > 1}


def _drawn(instance: str, name: str) -> str:
    return f"{instance.replace('/', '.')}.{name}"


def _ends(path: str, text: str) -> bool:
    return path.endswith(f".{text}")


def _path(net: FlatNet, p: PlaceInstance) -> str:
    """That of traces, if the place has one of its own there."""
    page = p.instance.replace("/", ".")
    whole = net.places[p.place]
    own = (whole.id, whole.instance) == (p.id, p.instance) and whole.name.startswith(f"{page}.")
    return whole.name if own else f"{page}.{p.name}"


def _element(instance: Instance, page: str, short: str, caption: str) -> _Element:
    own = instance.full.partition("'")[2]
    names = (own, legal_name(caption or short), short, instance.element)
    return _Element(instance, legal_name(page), names)
