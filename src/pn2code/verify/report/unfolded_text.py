"""What the unfolded net tells, in rows of a name and a text, for the screen, the report and the page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.unfolded import Unfolded, in_words

_DIGITS = 24
"""Of a number that is written out; of a longer one only how long it is, and its first digits."""
_NAMED = 6


def rows(net: FlatNet, found: Exploration) -> Iterator[tuple[str, str]]:
    """All there is to say; nothing where it was not looked at."""
    u = found.unfolded
    if u is None:
        return
    if u.why:
        yield "Unfolded net", f"it cannot be asked instead: {u.why}"
        return
    size = f"{u.places:,} places and {u.transitions:,} transitions, asked for {u.seconds:.1f} s"
    yield "Unfolded net", size
    if u.whole is None:
        yield "All markings", "not known: their set could not be built in time"
    else:
        by = in_words(u.whole.methods)
        yield "All markings", f"{number(u.whole.states)}, with {number(u.whole.arcs)} arcs, by {by}"
    yield "Dead markings", _dead(u)
    yield "Dead transitions", _never(net, u)
    yield "Bounds", _bounds(net, u)


def number(n: int) -> str:
    """With commas; of a long one the first digits: `1.2345e+40`."""
    text = str(n)  # of any length: whoever has counted so far allows it
    return f"{n:,}" if len(text) <= _DIGITS else f"{text[0]}.{text[1:5]}e+{len(text) - 1}"


def _dead(u: Unfolded) -> str:
    if u.has_dead is None:
        return "not known whether there are any"
    by = f", by {in_words(u.dead_methods)}"
    if not u.has_dead:
        return f"none{by}"
    if u.dead_run is None:
        return f"there are some{by}; no run to one was found in time"
    file, steps = u.dead_run
    return f"there are some{by} (a run of {steps} step{'s' * (steps != 1)}: {file})"


def _never(net: FlatNet, u: Unfolded) -> str:
    names = EngineNames(net)
    found = _listed([names.transition(i) for i in u.never]) if u.never else "none"
    if not u.open_:
        return found
    rest = f"not known of {len(u.open_)} of {len(net.transitions)}"
    return f"{found}; {rest}" if u.never else rest


def _listed(names: Sequence[str]) -> str:
    more = f", and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return f"{len(names)}: {', '.join(names[:_NAMED])}{more}"


def _bounds(net: FlatNet, u: Unfolded) -> str:
    bounds = u.bounds or {}
    if not bounds:
        return "not known"
    most = max(bounds.values())
    where = [net.places[i].name for i, n in sorted(bounds.items()) if n == most]
    shown = ", ".join(where[:3]) if len(where) <= 3 else f"{len(where)} of {len(net.places)} places"
    rest = len(net.places) - len(bounds)
    open_ = f"; not known of {rest} of {len(net.places)} places" if rest else ""
    return f"at most {most:,} token{'s' * (most != 1)} in a place (in {shown}){open_}"
