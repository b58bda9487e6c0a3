"""What is said of the longest waits between two transitions of a cell (`verify --durations`), next to its runs.

wrong = list(contradictions(measured, random, runs))
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random

from tools.adversary.wander import Pace, Run

from pn2code.timing.doings import NS
from pn2code.timing.look import Measured
from pn2code.timing.search import TIE
from pn2code.timing.waits import Is, longest_wait

PAIRS = 12
"""Pairs of transitions that are looked at."""


def contradictions(
    measured: Measured, random: Random, runs: Sequence[tuple[Pace, Run]]
) -> Iterator[str]:
    """Waits of runs that are longer than it is said that they can be, or do not end."""
    search, anyhow = measured.search, measured.anyhow
    names = [t.name for t in search.graph.partition.net.transitions]
    is_whole = not (search.why or search.faults or search.stuck or search.halts)
    occurred = [
        [names.index(e["transition"]) for e in run.record.events if e.get("transition") in names]
        for _, run in runs
        if run.end == "finished"
    ]
    for _ in range(PAIRS if any(len(x) > 1 for x in occurred) else 0):
        way = random.choice([x for x in occurred if len(x) > 1])
        i, j = sorted(random.sample(range(len(way)), 2))
        first, second = way[i], way[j]
        event, other = _is(measured, first), _is(measured, second)
        of_search = longest_wait(search.successors, event, other, search.ends)
        of_anyhow = longest_wait(anyhow.successors, event, other, anyhow.ends())
        for pace, run in runs:
            if run.end != "finished":
                continue
            longest = _longest(run, names[first], names[second])
            for found, known, paces in (
                (of_search, is_whole, (Pace.PLANNED,)),
                (
                    of_anyhow,
                    is_whole and not anyhow.why and anyhow.adds_up,
                    (Pace.PLANNED, Pace.EARLY),
                ),
            ):
                if not known or found.ns is None or pace not in paces:
                    continue
                if longest is None or longest * NS > found.ns + TIE:
                    yield (
                        f"{pace.value}: {longest} s between {names[first]} and {names[second]}, "
                        f"but it is said to be at most {found.ns / NS}"
                    )


def _is(measured: Measured, transition: int) -> Is:
    elements = measured.search.graph.elements
    return lambda mark: mark >= 0 and elements[mark].transition == transition


def _longest(run: Run, first: str, second: str) -> float | None:
    """The longest wait in a run, s; None: one has no end."""
    longest, since = 0.0, None
    for e in run.record.events:
        if e.get("transition") == second and since is not None:
            longest, since = max(longest, e["t"] - since), None
        if e.get("transition") == first and since is None:
            since = e["t"]
    return None if since is not None else longest
