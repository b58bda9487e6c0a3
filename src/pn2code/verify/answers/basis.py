"""What an answer rests on: an exploration may have seen all markings, and have had no time for the graph.

    said(found)            # sentences about what of the state space is complete
    of_property(p, "yes")  # "markings"

An answer that something never happens rests on what was *not* seen, so all has to be seen that could show it. An answer
that something happens rests on the one marking or run that shows it, however little was seen besides.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from pn2code.properties import meaning as m
from pn2code.verify.exploring.result import Exploration

MARKINGS: Final = "markings"
ARCS: Final = "arcs"
COMPONENTS: Final = "components"
MARKING: Final = "marking"
PART: Final = "part"
RUN: Final = "run"
NET: Final = "net"
UNFOLDED: Final = "unfolded"

SAYS: Final = {
    MARKINGS: "all reachable markings were seen",
    ARCS: "all reachable markings and all arcs between them were seen",
    COMPONENTS: "all markings, all arcs and the components of the graph were seen",
    MARKING: "a marking was reached that shows the answer",
    PART: "a part of the markings was seen that decides it, whatever the others are like",
    RUN: "a run was found that shows the answer",
    NET: "the net itself was examined, not its state space",
    UNFOLDED: "the unfolded net was asked about all of its markings, without visiting each",
}
_OF_MARKINGS = frozenset({"channels", "capacity", "messages", "memory", "reach"})
"""Checks of a supervisor that look at one marking after the other."""


def of_property(
    p: m.Property, answer: str, *, has_run: bool, is_of_part: bool = False
) -> str | None:
    """What the answer to a property rests on, one of those above; None: there is no answer.

    Args:
        p: the property.
        answer: its answer.
        has_run: whether there is a run that shows it.
        is_of_part: whether not all markings were seen.
    """
    if answer == "inconclusive":
        return None
    match p.asked:
        case m.Invariant() | m.Bound():
            # Of `reachable` the answer "yes" is the one that a marking shows.
            is_shown = isinstance(p.asked, m.Invariant) and not p.asked.wanted
            if answer == ("yes" if is_shown else "no"):
                return RUN if has_run else MARKING
            return MARKINGS
        case m.Linear():
            return RUN if answer == "no" and has_run else ARCS
        case m.Branching() if is_of_part:
            return PART
        case _:
            return ARCS


def of_check(name: str, answer: str, why: str | None, *, has_run: bool) -> str | None:
    """What the answer to a check of a supervisor rests on; `name` and `why` as in `control.Check`."""
    if answer == "unknown":
        return None
    if name == "ownership" or why == "structure":
        return NET
    if name in _OF_MARKINGS:
        return MARKINGS if answer == "yes" else RUN if has_run else MARKING
    # That an end can no longer be reached is seen in the graph; the run only shows how to get there.
    is_shown = answer == "no" and has_run and not (name == "non-blocking" and why != "deadlock")
    return RUN if is_shown else ARCS


def complete(found: Exploration) -> Iterator[tuple[str, str]]:
    """For markings, arcs, components: the name, and whether all of them are known, as a clause."""
    seen, of = found.seen, " of the reduced space" * found.is_reduced
    yield (
        "Markings",
        f"complete: {found.nodes:,}{of}"
        if seen.markings
        else f"not complete: {found.nodes:,}{of} were seen",
    )
    missing = "not asked for" if found.complete else "not complete"
    is_counted = seen.arcs or (found.sweep is not None and seen.markings)
    yield "Arcs", f"complete: {found.arcs:,}{of}" if is_counted else missing
    missing = "not preserved by the reduction" if seen.arcs and found.is_reduced else missing
    missing = "not known, since markings were forgotten" if found.sweep is not None else missing
    yield "Components", "complete" if seen.components else missing


def partial(found: Exploration) -> str:
    """One sentence for the head of a report that is not complete, without the reason."""
    if found.seen.markings:
        return (
            "All markings were seen, so bounds, dead markings and dead transitions are those of the whole state space. "
            "Components, home markings, live transitions and fairness need all arcs and are not known."
        )
    return (
        "The report is about the part that was seen: upper bounds may be greater, lower bounds may be smaller, "
        "transitions that were not seen to occur may occur, and there may be further dead markings."
    )
