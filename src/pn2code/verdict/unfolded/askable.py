"""Whether the unfolded net of a net can be asked, as far as the net shows it at once.

    why_not(net)          # "place `Top.P` is timed; ..."; "": it can

Its answers have to be about the same state space: nothing is timed or drawn at random, nobody looks at files or at
references that are assigned (code segments neither), no inscription raises an exception whatever is asked first, and
there are no priorities, inhibitor and reset arcs. What asks it is loaded when it is wanted (`look`). Each reason names
the element, and what the user could change.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.net.magnitudes import Magnitudes
from pn2code.net.other_orders import asking
from pn2code.semantics.evaluation.effects import OUTSIDE, Effect, effects_of
from pn2code.unfold.unfold import check
from pn2code.verdict.unfolded import raised
from pn2code.verify.exploring import nondeterminism

EXPLORING = 2 / 3
"""Of a limit of time, what the exploration of single markings may take where the unfolded net can be asked, too."""
_ARCS = {ArcKind.INHIBITOR: "an inhibitor arc from", ArcKind.RESET: "a reset arc to"}


def why_not(net: FlatNet) -> str:
    """Why the unfolded net of a net cannot be asked, as far as it is seen at once; "": it can."""
    return next(_reasons(net), "")


def _reasons(net: FlatNet) -> Iterator[str]:
    yield from _of_arcs(net)
    yield from _of_priorities(net)
    d = Diagnostics()
    check(net, d, with_code=True)
    for error in d.errors:
        is_timed = error.origin.element.startswith("place ")
        where = "" if is_timed else f" ({_element(error.origin)})"
        yield f"{error.message}{where}; {_LEAVE_TIMES if is_timed else _BIND}"
    if nondeterminism.draws(net):
        yield f"{_drawing(net)} random numbers or files; without `--unfold` the net is explored as it is"
    if nondeterminism.counts(net):
        yield "it asks for the number of steps (`step ()`), which is no part of a marking; leave that out"
    made = asking(net, Magnitudes(net))
    if made is not None:
        yield raised.why(net, made)


_LEAVE_TIMES = "leave `timed` out of its colour set, or explore the net with `--reduce time`"
_BIND = "what a place holds, a variable or a constant could be used instead"


def _element(origin: Origin) -> str:
    part = f" of {origin.element}" if origin.element else ""
    page = f", page `{origin.page}`" if origin.page else ""
    return f"{origin.part or 'inscription'}{part}{page}"


def _of_arcs(net: FlatNet) -> Iterator[str]:
    for t in net.transitions:
        for arc in t.arcs:
            if arc.kind in _ARCS:
                place = net.places[arc.place].name
                yield (
                    f"transition `{t.name}` has {_ARCS[arc.kind]} place `{place}`; a place that holds what is missing "
                    "there could be asked for a token instead"
                )


def _of_priorities(net: FlatNet) -> Iterator[str]:
    first = net.transitions[0] if net.transitions else None
    for t in net.transitions:
        if first is not None and t.priority != first.priority:
            yield (
                f"transitions `{first.name}` and `{t.name}` have different priorities ({first.priority} and "
                f"{t.priority}), which the unfolded net does not know; give all transitions the same one"
            )


def _drawing(net: FlatNet) -> str:
    """What depends on them."""
    effects = effects_of(net.program)
    outside = OUTSIDE | {Effect.COUNT}
    for p in net.places:
        if p.initial is not None and outside & effects.of(p.initial[0]):
            return f"the initial marking of place `{p.name}` depends on"
    return "a declaration depends on"
