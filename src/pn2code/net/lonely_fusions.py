"""Fusion sets of one place that keep the state-space tool of CPN Tools from being entered.

If a fusion set has a single place instance, and that place is the socket of a substitution transition, the tool
raises an exception (`ExnDuringExecution`) when it is entered. A second place in the set, or a second instance of its
page, and the tool works. The simulator is not affected. (Found by experiment, among random nets.)
"""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.diagnostics import Diagnostics
from pn2code.net.codes import SPACE_FUSION
from pn2code.net.linked import Page, Place


def warn(linked: Mapping[str, Page], d: Diagnostics) -> None:
    """Warn of such fusion sets; `linked`: the pages, by id."""
    members: dict[str, list[tuple[Page, Place]]] = {}
    for page in linked.values():
        for place in page.places:
            if place.fusion:
                members.setdefault(place.fusion, []).append((page, place))
    for name, places in members.items():
        page, place = places[0]
        sockets = {pair.socket for s in page.substitutions for pair in s.ports}
        if len(places) == 1 and place.id in sockets and _is_single(page, linked):
            d.warning(
                SPACE_FUSION,
                f"`{place.name}` is the only place of the fusion set `{name}`, and a socket: the state-space tool of "
                "CPN Tools cannot be entered with this net",
                place.origin,
                hint="take the place out of the set, or add the other places of the set, if the net is to be analysed "
                "there, too",
            )


def _is_single(page: Page, linked: Mapping[str, Page]) -> bool:
    """Whether there is exactly one instance of the page."""
    above: dict[str, list[Page]] = {}
    for other in linked.values():
        for s in other.substitutions:
            above.setdefault(s.subpage, []).append(other)
    seen = {page.id}
    while page.id in above:
        if len(above[page.id]) > 1:
            return False
        page = above[page.id][0]
        if page.id in seen:
            return False  # a page below itself, which the linker refuses
        seen.add(page.id)
    return True
