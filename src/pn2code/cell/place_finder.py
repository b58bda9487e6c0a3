"""Which place of the net a name in cell.toml means."""

from __future__ import annotations

from pn2code.cell import codes
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.net.finding import Finder
from pn2code.net.flat import FlatNet, FlatPlace


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
