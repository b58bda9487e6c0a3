"""What can be said of a line of a trace (docs/trace.md) without playing the net; both engines ask this of each line.

Each function gives what is wrong, in words, or None.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from sys import float_info
from typing import Any, TypeGuard

from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.trace.parties import Parties

SKEW_S = 1.0
"""So much may clocks of parties differ whose traces are one: messages say what came first, not times."""


_HEADER = {"trace": int, "net": str, "source": str, "digest": str, "by": str, "initial": dict}
_STEP = {"step": int, "t": float, "transition": str, "binding": dict, "origin": str}
_NOTES: Mapping[str, Mapping[str, type]] = {
    "end": {"t": float, "event": str, "why": str},
    "tool": {"t": float, "event": str, "robot": str, "action": str, "duration": float},
    "part": {"t": float, "event": str, "robot": str, "effect": str, "part": str},
    "hold": {"t": float, "event": str, "robot": str, "by": str},
    "stand": {"t": float, "event": str, "robot": str, "duration": float},
    "sense": {"t": float, "event": str, "robot": str, "sensor": str, "value": object},
    "message": {"t": float, "event": str, "robot": str, "channel": str, "fate": str, "by": str},
}
_MORE: Mapping[str, Mapping[str, type]] = {
    "header": {"seed": int, "still": bool},
    "end": {"final": list, "reason": str, "loop": int},
    "stand": {"by": str},
    "sense": {"by": str},
    "message": {"seconds": float},
}
"""Members that a line may have; all others it must have."""


def is_by_hand(line: Mapping[str, Any]) -> bool:
    """Whether a note says what a person has chosen. A hold is counted when it ends, by its `stand`."""
    return "by" in line and line.get("event") != "hold"


def form_problem(line: Mapping[str, Any], *, is_first: bool) -> str | None:
    """A line has the members of its kind, each of its type, and no others."""
    kind = "header" if is_first else str(line["event"]) if "event" in line else "step"
    if kind == "header":
        own: Mapping[str, type] = _HEADER
    elif kind == "step":
        own = _STEP
    elif kind in _NOTES:
        own = _NOTES[kind]
    else:
        return f"there is no event `{kind}`"
    more = _MORE.get(kind, {})
    for name, wanted in own.items():
        if name not in line:
            return f"its `{name}` is missing"
        if not _is_of(line[name], wanted):
            return f"its `{name}` is {line[name]!r}"
    for name, value in line.items():
        if name not in own and name not in more:
            return f"it has a `{name}`, which is no member of such a line"
        if name in more and not _is_of(value, more[name]):
            return f"its `{name}` is {value!r}"
    return None


def _is_of(value: object, wanted: type) -> bool:
    if wanted is float:
        return is_number(value) and abs(value) <= float_info.max
    return isinstance(value, wanted) and (wanted in (object, bool) or not isinstance(value, bool))


def is_number(t: object) -> TypeGuard[int | float]:
    """Whether a member is a number (JSON's true and false are none, nor are Python's NaN and Infinity)."""
    if isinstance(t, float):
        return isfinite(t)
    return isinstance(t, int) and not isinstance(t, bool)


def digest_problem(header: Mapping[str, Any], net: FlatNet, parties: Parties) -> str | None:
    """The digest of a header must be the net's, or that of the programs made from it."""
    said = header.get("digest")
    if said is None or said == net.sha256 or said in parties.digests:
        return None
    hint = "" if parties.is_cell else ", or of a cell (then name its cell.toml instead of the net)"
    return (
        f"the trace is of another net, or of another version of it{hint}: "
        "its digest differs (`--any-digest` leaves this out)"
    )


def origin_problem(line: Mapping[str, Any], t: FlatTransition) -> str | None:
    """The element that a step names must be the transition's."""
    said = line.get("origin", t.id)
    if said == t.id:
        return None
    return f"its `origin` is `{said}`, but the transition is element `{t.id}`"


def unknown_variable(binding: Mapping[str, Any], t: FlatTransition) -> str | None:
    """A binding has no other variables than the transition."""
    unknown = sorted(set(binding) - {s.name for s in t.variables})
    if not unknown:
        return None
    return f"its binding has `{unknown[0]}`, which is no variable of the transition"


def order_problem(line: Mapping[str, Any], number: int, latest: float) -> str | None:
    """Steps are numbered 1, 2, ..., and time does not go back."""
    said = line.get("step", number)
    if said != number:
        return f"it has number {said}, but {number} is next: steps are missing or out of order"
    return time_problem(line, latest)


def time_problem(line: Mapping[str, Any], latest: float) -> str | None:
    """Time does not go back."""
    t = line.get("t")
    if is_number(t) and t < latest - SKEW_S:
        return f"time goes back: {t} after {latest}"
    return None
