"""Conditions that CPN Tools may look at before others that keep them from being looked at here.

With `[length l >= 2, m = hd l]` its engine computes `hd l` first, whatever `length l` is, and stops with the exception
`Empty` at an empty list. Here the first condition ends the question. In which order the engine asks is decided by a
search for the cheapest order, in which equal ones are taken as its queue happens to hold them (found by experiment):

    [length l > 0, hd l > 0]         asked as written; the other way round if written so
    [n > 1, length l > 0, hd l > n]  `hd l > n` first
    [length l > 0, m = hd l]         the equation first
    [length l > 0, m = hd l, m > 1]  the equation second

The search is a shortest path, from "all conditions and arcs are open" to "all variables are known" (CPN Tools' public
sources). It is made for each group of variables that conditions and arcs connect. Steps cost: a token matched with a
pattern 100, found by its known parts 20, an arc whose variables are known 10, a condition 2, an equation that binds 1,
all values of a small colour set 1,000. Of paths that cost the same, one is taken as the queue holds them, so that
nothing is built on it here.

`unsure`: what raises no exception in the order of the plan, and might in another (`other_orders`).
`doubtful`: what may raise one in the order of the plan, and none in another.
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note
from pn2code.ml.core.terms import Exp
from pn2code.net.codes import GUARD_ORDER
from pn2code.net.conditions import conditions
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.net.magnitudes import Magnitudes
from pn2code.net.other_orders import asking
from pn2code.net.raising import Raising
from pn2code.net.uses import NetVariables

MOST_NAMED = 5
"""Transitions that get a warning of their own."""


@frozen
class Unsure:
    """A transition, what may raise an exception in it, and a condition that may keep it from being computed."""

    transition: FlatTransition
    raises: Exp
    first: Exp


def unsure(net: FlatNet, sizes: Magnitudes | None = None) -> tuple[Unsure, ...]:
    """One of each transition at most, in the order of the net; none in PNML nets, which CPN Tools does not read.

    Args:
        net: the net.
        sizes: how large its integers may become: an Overflow counts, too; None: it does not.
    """
    made = asking(net, sizes)
    if made is None:
        return ()
    found: dict[int, Unsure] = {}
    for q in (*made.questions, *made.left):
        if q.beside is not None and q.transition not in found:
            found[q.transition] = Unsure(net.transitions[q.transition], q.condition, q.beside)
    return tuple(found[i] for i in sorted(found))


def doubtful(net: FlatNet) -> tuple[Unsure, ...]:
    """What may raise an exception here, and in CPN Tools none, as it may ask first what comes later here.

    One of each transition at most, in the order of the net; none in PNML nets.
    """
    if net.file.lower().endswith(".pnml"):
        return ()
    raising, uses = Raising(net.program), NetVariables(net.program.variables)
    found = (_doubtful(t, raising, uses) for t in net.transitions)
    return tuple(x for x in found if x is not None)


def rows(net: FlatNet) -> list[dict[str, str]]:
    """As plain data: `transition`, what `raises`, what is `beside` it, and `where` alone: `CPN Tools` or `here`."""
    return [
        {
            "transition": x.transition.name,
            "raises": _line(x.raises),
            "beside": _line(x.first),
            "where": where,
        }
        for where, found in (("CPN Tools", unsure(net)), ("here", doubtful(net)))
        for x in found
    ]


def not_there(net: FlatNet, transition: int) -> str | None:
    """What is to be said of an exception in a search for bindings of a transition that CPN Tools may not raise."""
    for x in doubtful(net):
        if x.transition.index == transition:
            return (
                f"CPN Tools may look at `{_line(x.first)}` before it computes `{_line(x.raises)}`, and raise "
                "nothing if the former fails; here the latter is computed first"
            )
    return None


def warn(net: FlatNet, d: Diagnostics) -> None:
    """Warn of the first such transitions, of those on a page that is used more than once only once."""
    found = unsure(net)
    first = {x.transition.id: x for x in reversed(found)}
    named = [x for x in found if first[x.transition.id] is x]
    for i, x in enumerate(named[:MOST_NAMED], 1):
        t = x.transition
        more = len(named) - i if i == MOST_NAMED else 0
        d.warning(
            GUARD_ORDER,
            f"CPN Tools may compute `{_line(x.raises)}` of transition `{t.short}` before it looks at "
            f"`{_line(x.first)}`, and stops if it raises an exception then; here the latter is asked first"
            + (f"; and so in {more} more transitions" if more else ""),
            x.raises.span,
            notes=[Note("the transition is here", t.origin)]
            if x.raises.span.origin != t.origin
            else [],
            hint="put both into one condition: `a andalso b`, or `m = (if a then b else c)`"
            if x.first in t.guards
            else "let it raise nothing, whatever the values are: `if l <> [] then hd l else 0`",
        )


def _line(e: Exp) -> str:
    return " ".join(e.span.text.split())


def _doubtful(t: FlatTransition, raising: Raising, uses: NetVariables) -> Unsure | None:
    found = conditions(t, raising, uses)
    for i, condition in enumerate(found):
        if not condition.may_raise:
            continue
        known = condition.binds
        for other in found[i + 1 :]:
            if other.needs & known:
                known |= other.binds
            elif other.may_fail or other.term is not None:  # a place may be empty
                return Unsure(t, condition.text, other.text)
    return None
