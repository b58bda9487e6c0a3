"""What the searches of a swarm have found, as if one explorer had said it.

It depends on the searches alone, in the order of their numbers: not on who carried them out, nor on which was first.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pn2code.verify.swarm.coverage import Coverage, coverage
from pn2code.verify.swarm.plan import SKETCH, Search

SWARM = "swarm"
"""Why not all markings were seen, where nothing else was in the way; and the kind of the approximation."""
UNKNOWN: Mapping[str, Any] = {
    "answer": "unknown",
    "why": SWARM,
    "node": None,
    "trace": None,
    "steps": None,
    "loop": None,
    "value": None,
}
"""Of a question that no search has decided."""


def is_event(said: Mapping[str, Any], ending: Sequence[int]) -> bool:
    """Whether a search has found something that ends the swarm: an exception, too little room, a violation."""
    if said["error"] is not None:
        return True
    return any(_is_shown(said["queries"][i]) for i in ending)


def _is_shown(answer: Mapping[str, Any]) -> bool:
    """Whether a run shows it; an answer without one is not believed."""
    return answer["answer"] == "no" and answer.get("trace") is not None


def looked_at(said: Mapping[str, Any]) -> int:
    """Different markings that a search has looked at. A walk comes to some again and again."""
    return int(min(said["nodes"], said["expanded"]))


def merged(
    by_number: Mapping[int, Mapping[str, Any]],
    searches: int,
    why: str,
    seconds: float,
    workers: int,
) -> dict[str, Any]:
    """The report of the searches that count.

    Args:
        by_number: what each has said, at least one.
        searches: how many were wanted.
        why: the swarm has ended, unless one of them has met an exception.
        seconds: how long it took.
        workers: who carried it out.
    """
    found = [by_number[i] for i in sorted(by_number)]
    most = max(found, key=looked_at)
    sketches = [said["swarm"]["sketch"] for said in found]
    errors = [said["error"] for said in found if said["error"] is not None]
    dead = [said["swarm"]["dead_trace"] for said in found if said["swarm"]["dead_trace"]]
    asked = len(found[0].get("queries") or ())
    is_over = bool(errors) and errors[0]["kind"] == "exception"
    return {
        "complete": False,
        "why": "error" if is_over else why,
        "error": errors[0] if errors else None,
        "nodes": looked_at(most),
        "arcs": most["arcs"],
        "depth": max(said["depth"] for said in found),
        "seconds": seconds,
        "bytes_per_state": most["bytes_per_state"],
        "peak_mib": max(said["peak_mib"] for said in found),
        "threads": 1,
        "fired": [sum(own) for own in zip(*(said["fired"] for said in found), strict=True)],
        "bounds": _bounds(found),
        "dead_count": max(_dead(i, said) for i, said in by_number.items()),
        "dead": [],
        "graph": None,
        "traces": dead[:1],
        "approximate": {"kind": SWARM, "omission_probability": None},
        "reductions": most["reductions"],
        "queries": [_answer([said["queries"][i] for said in found]) for i in range(asked)],
        "swarm": _row(found, coverage(sketches, SKETCH), searches, workers),
    }


def _dead(number: int, said: Mapping[str, Any]) -> int:
    """Dead markings that a search has seen; a walk counts one as often as it comes there."""
    count = int(said["dead_count"])
    return min(count, 1) if Search.of(number).is_walk else count


def _bounds(found: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Of each place the least and the most that any search has seen, without colours."""
    rows = zip(*(said.get("bounds") or () for said in found), strict=False)
    return [
        {
            "lower": min(b["lower"] for b in own),
            "upper": max(b["upper"] for b in own),
            "lower_multiset": None,
            "upper_multiset": None,
            "lower_colours": 0,
            "upper_colours": 0,
        }
        for own in rows
    ]


def _answer(given: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    """To one question: the first that a run shows. That nothing was found is never an answer."""
    for answer in given:
        if _is_shown(answer):
            return answer
    raised = [a for a in given if a["answer"] == "unknown" and a["why"] not in _ENDS]
    return {**UNKNOWN, "why": raised[0]["why"]} if raised else UNKNOWN


_ENDS = ("approximation", "states", "seconds", "memory", "interrupted", "decided", "error", None)
"""Why a search has left a question open without knowing more about it than that it has come to its end."""


def _row(
    found: Sequence[Mapping[str, Any]], seen: Coverage, searches: int, workers: int
) -> dict[str, Any]:
    """What `--json` says of the swarm."""
    return {
        "searches": searches,
        "counted": len(found),
        "workers": workers,
        "markings": round(seen.markings),
        "markings_are_exact": seen.is_exact,
        "seen_by_one_search": round(seen.alone, 4),
        "estimated_total": None if seen.total is None else round(seen.total),
        "estimated_coverage": None if seen.part is None else round(seen.part, 4),
        "occupancy": max(said["swarm"]["occupancy"] for said in found),
    }
