"""What can be said of a line of a trace (docs/trace.md) without playing the net; both engines ask this of each line.

Each function gives what is wrong, in words, or None.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeGuard

from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.parties import Parties

SKEW_S = 1.0
"""So much may clocks of parties differ whose traces are one: messages say what came first, not times."""


def is_number(t: object) -> TypeGuard[int | float]:
    """Whether a member is a number (JSON's true and false are none)."""
    return isinstance(t, int | float) and not isinstance(t, bool)


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
    t = line.get("t")
    if is_number(t) and t < latest - SKEW_S:
        return f"time goes back: {t} after {latest}"
    return None
