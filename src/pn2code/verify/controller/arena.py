"""How much memory the lists and strings of a deployed supervisor get: what the state space shows, with room to spare.

size(found)      # 65536; None: it is not known
need(found)      # 20480: without the room to spare

The arena of a supervisor (cnative/include/pn/pn_arena.h) has a part for the values of declarations and two halves. A
firing begins in a half that is used to a half at most, or with what the marking refers to; so a half has to hold twice
a firing, and a firing with a marking. Twice that is given, since the explored net may be compiled with other places
packed than the deployed one. That is no proof for the deployed one: `emission.arena_size` takes no less than the usual
size where it has none of its own.
"""

from __future__ import annotations

from pn2code.verify.exploring.result import Exploration

MOST = 1 << 30
_UNIT = 1 << 16


def size(found: Exploration | None) -> int | None:
    """Bytes, whether or not there is so much; None: the state space was not seen to its end.

    Args:
        found: a state space with at least all markings that the cell can reach.
    """
    least = need(found)
    if found is None or found.arena is None or least is None:
        return None
    start = int(found.arena["start"])
    return max(-(-(start + 2 * (least - start)) // _UNIT), 1) * _UNIT


def need(found: Exploration | None) -> int | None:
    """Bytes that are used at most, and no more; None: the state space was not seen to its end."""
    if found is None or not found.seen.markings or found.arena is None:
        return None
    start, firing, marking = (int(found.arena[part]) for part in ("start", "firing", "marking"))
    return start + 2 * max(2 * firing, firing + marking)
