"""Names of place and transition instances as the real engine writes them: `Page'Place 1`.

    EngineNames(net).transition(0)      # "Top'Send_Packet 1"

Each odd character, line breaks too, becomes `_`; a name that begins with a digit gets an `N` before it. Of the
places and transitions of a page the first of a name has it, the others have `_u1`, `_u2`, ... behind it.
"""

from __future__ import annotations

import re
from functools import lru_cache

from pn2code.net.flat import FlatNet, PlaceInstance


class EngineNames:
    """The names of a net's instances."""

    def __init__(self, net: FlatNet) -> None:
        self._net = net
        used: set[tuple[str, str]] = set()
        self._names: dict[str, str] = {}
        for place in net.place_instances:
            self._name(used, place.page, place.id, place.caption or place.name)
        for t in net.transitions:
            self._name(used, t.page, t.id, t.caption or t.short)

    def _name(self, used: set[tuple[str, str]], page: str, element: str, text: str) -> None:
        if element in self._names:
            return  # another instance of its page
        chosen = name = legal_name(text)
        number = 0
        while (page, chosen) in used:
            number += 1
            chosen = f"{name}_u{number}"
        used.add((page, chosen))
        self._names[element] = chosen

    def transition(self, index: int) -> str:
        """Of `FlatNet.transitions[index]`."""
        t = self._net.transitions[index]
        return f"{legal_name(t.page)}'{self._names[t.id]} {t.instance_number}"

    def place_instance(self, place: PlaceInstance) -> str:
        """Of a place as it stands on a page."""
        return f"{legal_name(place.page)}'{self._names[place.id]} {place.number}"

    def place(self, index: int) -> str:
        """Of `FlatNet.places[index]`: that of the topmost of the places that share the marking."""
        p = self._net.places[index]
        return (
            f"{legal_name(p.page)}'{self._names.get(p.id, legal_name(p.short))} {p.instance_number}"
        )


def engine_name(name: str) -> str:
    """A name of the net as the engine writes it: each line cut at the first odd character, blanks replaced."""
    cut = re.sub(r"[^A-Za-z'_0-9 \n\t.\-].*", "", name.strip())
    return re.sub(r"[^A-Za-z'_0-9]", "_", cut.strip())


def sent_name(name: str) -> str:
    """A name as the editor sends it to the engine: cut at the first sign that it refuses, "" if none is left."""
    found = re.match(r"[A-Za-z][A-Za-z0-9'_\s]*", name.strip())
    return re.sub(r"\s+", "_", found.group().strip()) if found else ""


@lru_cache(maxsize=4096)
def legal_name(text: str) -> str:
    """What the engine makes of a name that no other element has."""
    name = engine_name(text)
    return f"N{name}" if name[:1].isdigit() else name
