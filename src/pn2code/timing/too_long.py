"""How a run waits for longer than it may, or why that is not known.

wait = longest_wait(search.successors, first, second, ends, over)
shown = too_long(one, wait, (first, second), limit, over)       # Shown: a run that nothing stops before; or None
why_open(one, cycle, wait, (first, second), limit)              # where there is none
"""

from __future__ import annotations

from collections.abc import Collection

from pn2code.base.frozen import frozen
from pn2code.timing.answers import Cycle, between
from pn2code.timing.look import RAISES, Measured
from pn2code.timing.search import TIE, Search
from pn2code.timing.waits import Is, Wait, longest_wait

WHY = {
    "idle": "something that takes no time can go on for ever before it",
    "ends": "the cell can come to its end before it",
}
"""Why there is no longest wait."""
_FAULT = "something may not be possible that it does"


@frozen
class Shown:
    """A run that waits too long.

    Args:
        before: the way to where the wait begins: node and mark of each arc.
        ns: how long it waits, if the second event comes; None: that is not known, or it does not.
    """

    before: tuple[tuple[int, int], ...]
    wait: Wait
    ns: int | None


def too_long(
    one: Measured, wait: Wait, events: tuple[Is, Is], limit: int, over: Collection[int]
) -> Shown | None:
    """A run that waits too long, and that nothing stops before; None: none is known.

    Args:
        wait: the longest one, if nothing stops a run.
        over: situations in which nobody waits for the second event.
    """
    search, runs = one.search, one.runs
    if runs.is_all and wait.why in ("never", "repeats"):
        return Shown(tuple(search.path_to(wait.before)), wait, None)
    if runs.is_all and wait.ns is not None:
        surely, its = surely_waited(search, wait, *events)
        is_longer = surely - TIE > limit
        return Shown(tuple(search.path_to(its.before)), its, surely) if is_longer else None
    found = runs.too_long(*events, limit) or runs.never(*events, over)
    return None if found is None else seen(one, found, events[1])


def seen(one: Measured, wait: Wait, second: Is) -> Shown:
    """A wait of the runs that nothing stops, with the way to it."""
    is_whole = bool(wait.way) and second(wait.way[-1][1])
    return Shown(tuple(one.runs.way_before(wait)), wait, wait.ns if is_whole else None)


def why_open(one: Measured, cycle: Cycle, wait: Wait, events: tuple[Is, Is], limit: int) -> str:
    """Why it is not known whether a run waits too long where none is shown."""
    if wait.why in WHY:
        return WHY[wait.why]
    if wait.ns is not None:
        surely, _ = surely_waited(one.search, wait, *events)
        if surely - TIE <= limit:
            return f"the longest wait takes {between(surely, wait.ns)}"
    stops = [*one.search.faults, *(["a script may stop the cell"] if one.search.halts else [])]
    stops += [RAISES] if one.search.may_raise() else []
    full = [f"channel `{x}` may come to hold two messages" for x in one.search.overfull()]
    return f"a run may stop before it: {[*stops, *full, *cycle.late, _FAULT][0]}"


def surely_waited(search: Search, wait: Wait, first: Is, second: Is) -> tuple[int, Wait]:
    """ns: some run waits no less, whatever ends before what it is a tie with; and the wait of this run.

    Args:
        wait: the longest one, where such ties may add up.
    """
    assert wait.ns is not None
    held_up = search.held_up(wait.way[0][0], wait.way[1:]) if wait.way else 0
    if not held_up:
        return wait.ns, wait
    found = longest_wait(search.surely(), first, second, ())
    if found.ns is None or found.ns < wait.ns - held_up:
        return wait.ns - held_up, wait
    return found.ns, found


def seen_too_long(one: Measured, first: Is, second: Is, limit: int) -> Shown | None:
    """Where a limit has ended the search: how some run waits for longer than `limit` (ns) in what was seen.

    None: none was seen, or not only a limit is why not all is known.
    """
    search = one.search
    if search.why not in ("situations", "time") or search.doings.why or search.doings.stops:
        return None
    found = one.runs.too_long(first, second, limit)
    return None if found is None else seen(one, found, second)
