"""Whether the unfolded net of a net can be asked, as far as the net shows it at once.

    why_not(net)          # "place `Top.P` is timed"; "": it can

Its answers have to be about the same state space: nothing is timed or drawn at random, nobody looks at references or
files (code segments neither), no inscription raises an exception whatever is asked first, and there are no priorities,
inhibitor and reset arcs. What asks it is loaded when it is wanted (`look`).
"""

from __future__ import annotations

from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.net.magnitudes import Magnitudes
from pn2code.net.other_orders import asking
from pn2code.unfold.unfold import check
from pn2code.verify.exploring import nondeterminism

EXPLORING = 2 / 3
"""Of a limit of time, what the exploration of single markings may take where the unfolded net can be asked, too."""


def why_not(net: FlatNet) -> str:
    """Why the unfolded net of a net cannot be asked, as far as it is seen at once; "": it can."""
    if any(a.kind in (ArcKind.INHIBITOR, ArcKind.RESET) for t in net.transitions for a in t.arcs):
        return "it has inhibitor or reset arcs"
    if len({t.priority for t in net.transitions}) > 1:
        return "its transitions have priorities"
    d = Diagnostics()
    check(net, d, with_code=True)
    if d.errors:
        return d.errors[0].message
    if nondeterminism.draws(net):
        return "it depends on random numbers or files"
    if nondeterminism.counts(net):
        return "it asks for the number of steps"
    if asking(net, Magnitudes(net)) is not None:
        return "an inscription may raise an exception, perhaps in another order only"
    return ""
