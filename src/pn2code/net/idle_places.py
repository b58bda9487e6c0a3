"""Places without any arc: nothing puts a token there, takes one away, or looks."""

from __future__ import annotations

from pn2code.diagnostics import Diagnostics, Note
from pn2code.net.codes import PLACE_IDLE, PORT_IDLE
from pn2code.net.flat import FlatNet, FlatPlace

_MOST_NOTES = 5


def remark(net: FlatNet, d: Diagnostics, *, is_cell: bool) -> None:
    """Say which they are, once; ports of which that is said already are left out.

    Args:
        net: the net.
        d: gets it.
        is_cell: of a cell it is a warning, since each of its places becomes a part of a program.
    """
    touched = {a.place for t in net.transitions for a in t.arcs}
    said = {(i.origin.page, i.origin.element) for i in d if i.code == PORT_IDLE}
    found: dict[tuple[str, str], FlatPlace] = {}
    for p in net.places:
        elements = [(o.page, o.element) for o in p.origins]
        if p.index not in touched and said.isdisjoint(elements):
            found.setdefault(elements[0], p)  # one for all instances of its page
    if not found:
        return
    first, *others = found.values()
    more = (
        ""
        if not others
        else f" (nor have {len(others)} more)"
        if len(others) > 1
        else " (nor has one more)"
    )
    say = d.warning if is_cell else d.note
    say(
        PLACE_IDLE,
        f"place `{first.short}` has no arc{more}: its tokens never change, and nothing looks at them",
        first.origins[0],
        notes=[Note(f"`{p.short}`", p.origins[0]) for p in others[:_MOST_NOTES]],
        hint="draw the arcs that are missing, or remove the place",
    )
