"""`inst ()`: the number of the page instance that an inscription belongs to, as CPN Tools counts the instances.

The elaborator leaves `Page.inst` in typed inscriptions, which all instances of their page share. When the net is
flattened each instance gets its own inscriptions with its number in them, so that nothing behind knows of `Page.inst`.

In initial markings the engine of CPN Tools has another number, the same for all instances: 1 more than there are
instances of the place that it made before. The order in which it makes places is that in which its editor sent them,
so that it is no number of the net's; `warn` says so.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.instances import mentioned
from pn2code.net.codes import INITIAL_INSTANCE
from pn2code.net.typed import TypedPage, TypedPlace, TypedTransition


def mentioning(pages: Iterable[TypedPage]) -> frozenset[str]:
    """Ids of the places and transitions with `inst` in their inscriptions."""
    found: set[str] = set()
    for page in pages:
        nodes: Sequence[TypedPlace | TypedTransition] = (*page.places, *page.transitions)
        found.update(node.id for node in nodes if mentioned(node))
    return frozenset(found)


def warn(pages: Iterable[TypedPage], d: Diagnostics) -> None:
    """Warn of initial markings with `inst`."""
    for page in pages:
        for place in page.places:
            if mentioned(place.initial):
                d.warning(
                    INITIAL_INSTANCE,
                    f"the initial marking of `{place.name}` uses `inst ()`: here that is the number of the page "
                    "instance (1, 2, ...); CPN Tools has the same number for all instances there, mostly another one",
                    place.origin,
                    hint="let a transition put these tokens, or give each instance its number as a token of a "
                    "socket",
                )
