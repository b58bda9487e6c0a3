"""Variables that nothing binds: neither an input arc nor a guard `v = ...` gives them a value.

CPN Tools draws one of the values of the colour set where such a variable is on output arcs alone (a state space has
all of them), and tries all of them where a guard or an input arc tests it. That may be meant, and is often a slip.
"""

from __future__ import annotations

from collections.abc import Collection

from pn2code.diagnostics import Diagnostics, Note
from pn2code.ml.core.terms import Symbol
from pn2code.net.codes import FREE_VARIABLE
from pn2code.net.flat import BindAll, BindRandom, FlatNet, FlatTransition

_MOST_NOTES = 5


def remark(net: FlatNet, d: Diagnostics, of: Collection[int] | None = None) -> None:
    """Say which variables are free, in one note.

    Args:
        net: the net.
        d: gets it.
        of: the transitions of a supervisor, by index, the only ones that are looked at: there it is a warning, since
            the program always takes the same value; None: all, of a net that is no cell.
    """
    found: dict[tuple[str, str, str], tuple[FlatTransition, Symbol, bool]] = {}
    for t in net.transitions:
        if of is not None and t.index not in of:
            continue
        for step in t.plan:
            if isinstance(step, BindAll | BindRandom):
                key = (t.origin.page, t.origin.element, step.symbol.name)
                found.setdefault(key, (t, step.symbol, isinstance(step, BindRandom)))
    if not found:
        return
    (first, symbol, is_drawn), *others = found.values()
    assert symbol.colset is not None, "only variables of a small colour set are free"
    values = f"the values of `{symbol.colset.name}`"
    says = (
        f"it is on output arcs alone, and CPN Tools draws one of {values}; a state space has all of them"
        if is_drawn
        else f"no input arc and no guard `{symbol.name} = ...` gives it a value, and CPN Tools tries all {values}"
    )
    more = (
        f" (so are {len(others)} more)"
        if len(others) > 1
        else " (so is one more)"
        if others
        else ""
    )
    message = (
        f"variable `{symbol.name}` of transition `{_name(first)}` is bound by no arc{more}: {says}"
    )
    notes = [Note(f"`{s.name}` of `{_name(t)}`", t.origin) for t, s, _ in others[:_MOST_NOTES]]
    bind = f"if that is not meant, put `{symbol.name}` on an input arc, or write a guard `{symbol.name} = ...`"
    if of is None:
        d.note(FREE_VARIABLE, message, first.origin, notes=notes, hint=bind)
    else:
        d.warning(
            FREE_VARIABLE,
            f"{message}; the supervisor always takes the first one that is possible",
            first.origin,
            notes=notes,
            hint=bind,
        )


def _name(t: FlatTransition) -> str:
    return t.name.rpartition(".")[2]
