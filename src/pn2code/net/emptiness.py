"""A net in which nothing can happen.

warn(net, d)        # "the net has no transitions: ..."
"""

from __future__ import annotations

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.codes import NET_EMPTY
from pn2code.net.flat import FlatNet


def warn(net: FlatNet, d: Diagnostics) -> None:
    """Warns of a net without transitions, or without places; pages that are not reached from a prime page count not."""
    if not net.transitions:
        lack, hint = (
            "transitions",
            "draw some, and see whether their pages are prime pages, or reached from one",
        )
    elif not net.places:
        lack, hint = (
            "places",
            "connect its transitions with places: they can always occur, and change nothing",
        )
    else:
        return
    d.warning(
        NET_EMPTY,
        f"the net has no {lack}: its only marking is the initial one",
        Origin(net.file),
        hint=hint,
    )
