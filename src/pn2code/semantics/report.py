"""Markings and binding elements as the verbs report them (docs/cli.md): plain data for JSON.

places(net, game.marking)
# [{"page": "Top", "instance": 1, "name": "Buffer", "id": "ID7", "marking": "1`3++\\n2`5"}, ...]
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pn2code.net.flat import FlatNet
from pn2code.semantics.colours import Colours
from pn2code.semantics.marking import BindingElement, Marking, place_text, variable_text
from pn2code.semantics.values import real_text

PlaceRow = dict[str, str | int]
"""`page`, `instance`, `name`, `id`, `marking`."""

_NO_EVALUATOR: Any = None
_TEXTS = Colours(_NO_EVALUATOR)
"""Texts and the order of values need nothing evaluated."""


def places(net: FlatNet, marking: Marking) -> list[PlaceRow]:
    """What every place instance holds, as CPN Tools prints it.

    Ports, sockets and members of fusion sets each have a row, with what they share; so has a fusion set itself (with
    its own id and no page), as in the real tool. A place without a name has the name "".
    """
    texts = [place_text(_TEXTS, p.colset, marking.places[p.index]) for p in net.places]
    rows: list[PlaceRow] = [
        {
            "page": p.page,
            "instance": p.number,
            "name": "" if p.name == p.id else p.name,
            "id": p.id,
            "marking": texts[p.place],
        }
        for p in net.place_instances
    ]
    rows.extend(
        {"page": "", "instance": 1, "name": f.name, "id": f.id, "marking": texts[f.place]}
        for f in net.fusions
        if f.place >= 0
    )
    return rows


def enabled(net: FlatNet, elements: Iterable[BindingElement]) -> list[dict[str, Any]]:
    """Binding elements: `page`, `instance`, `transition`, `id`, `binding` (variable -> CPN ML text)."""
    return [element(net, e) for e in elements]


def element(net: FlatNet, e: BindingElement) -> dict[str, Any]:
    """One binding element; see `enabled`."""
    t = net.transitions[e.transition]
    return {
        "page": t.page,
        "instance": t.instance_number,
        "transition": t.short,
        "id": t.id,
        "binding": {s.name: variable_text(_TEXTS, s, value) for s, value in e.values},
    }


def time_text(time: int | float) -> str:
    """A model time as the real tool prints it."""
    return real_text(time) if isinstance(time, float) else str(time)
