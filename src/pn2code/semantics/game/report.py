"""Markings and binding elements as the verbs report them (docs/cli.md): plain data for JSON.

places(net, game.marking)
# [{"page": "Top", "instance": 1, "name": "Buffer", "id": "ID7", "marking": "1`3++\\n2`5"}, ...]
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import BindingElement, Marking, place_text, variable_text
from pn2code.semantics.values.colours import TEXTS
from pn2code.semantics.values.data import Value, real_text

PlaceRow = dict[str, str | int]
"""`page`, `instance`, `name`, `id`, `marking`; of a fusion set also `fusion`."""


def places(net: FlatNet, marking: Marking) -> list[PlaceRow]:
    """What every place instance holds, as CPN Tools prints it.

    Ports, sockets and members of fusion sets each have a row, with what they share; so has a fusion set itself (with
    its own id as name and no page; `fusion` is its name), as in the real tool. Names are as they are written, with line
    breaks; a place without a name has the name "".
    """
    texts = [place_text(TEXTS, p.colset, marking.places[p.index]) for p in net.places]
    rows: list[PlaceRow] = [
        {
            "page": p.page,
            "instance": p.number,
            "name": p.caption,
            "id": p.id,
            "marking": texts[p.place],
        }
        for p in net.place_instances
    ]
    rows.extend(
        {
            "page": "",
            "instance": 1,
            "name": f.id,
            "id": f.id,
            "fusion": f.name,
            "marking": texts[f.place],
        }
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
        "binding": {s.name: variable_text(TEXTS, s, value) for s, value in e.values},
    }


def marking_text(net: FlatNet, marking: Marking, *, empty: bool = False) -> str:
    """For people: by page instance, one place below the other; empty places only if wanted."""
    lines = [f"time {time_text(marking.time)}"] if net.timed else []
    rows = [row for row in places(net, marking) if row["page"]]
    shown = [row for row in rows if empty or row["marking"] != "empty"]
    width = max((len(_name(row)) for row in shown), default=0)
    heading = None
    for row in shown:
        if heading != (row["page"], row["instance"]):
            heading = (row["page"], row["instance"])
            heading_text = _page(net, str(row["page"]), int(row["instance"]))
            lines += [*([""] if lines else []), heading_text]
        first, *others = str(row["marking"]).split("\n")
        lines.append(f"  {_name(row).ljust(width)}  {first}")
        lines += [f"  {' ' * width}  {other}" for other in others]
    left = len(rows) - len(shown)
    if left:
        lines += [
            *([""] if lines else []),
            f"{left} places are empty" if left > 1 else "1 place is empty",
        ]
    return "\n".join(lines)


def _page(net: FlatNet, page: str, number: int) -> str:
    """A page instance: with its number if there are several of its page."""
    numbers = {t.instance_number for t in net.transitions if t.page == page}
    numbers |= {p.number for p in net.place_instances if p.page == page}
    return page if numbers <= {1} else f"{page} {number}"


def _name(row: PlaceRow) -> str:
    return " ".join(str(row["name"]).split()) or str(row["id"])


def enabled_text(net: FlatNet, time: int | float, elements: Iterable[BindingElement]) -> str:
    """For people: the enabled transitions, and below each its bindings."""
    lines = [f"time {time_text(time)}"] if net.timed else []
    at = -1
    for e in elements:
        if e.transition != at:
            at = e.transition
            t = net.transitions[at]
            where = _page(net, t.page, t.instance_number)
            lines += [*([""] if lines else []), f"{t.short} ({where})"]
        values = element(net, e)["binding"]
        shown = ", ".join(f"{name} = {' '.join(text.split())}" for name, text in values.items())
        lines.append(f"  {shown or 'no variables'}")
    return "\n".join(lines if at >= 0 else [*lines, "nothing is enabled"])


def value_text(symbol: Symbol, value: Value) -> str:
    """The value of a net variable."""
    return variable_text(TEXTS, symbol, value)


def time_text(time: int | float) -> str:
    """A model time as the real tool prints it."""
    return real_text(time) if isinstance(time, float) else str(time)
