"""Searches for a run that shows an answer, in a cell of which not all states can be seen.

    rows = hunt(properties, rows, lines, limits, options, explored)     # what was open in `rows` may be known now

Breadth first, the part of a large space that can be seen holds no run to its end. So runs are looked for depth first,
a few times: with successors in the order in which they are found, the other way round, and by chance, where each search
is about as long as a few runs. What a formula is false of tells where to look:

    ctl AF p, ltl F p                     states of p are not gone on from: each run that comes to its end, or back to
                                          a state, has none of them; the search ends where a run does
    ctl AG EF p, AG AF p, ltl G F p       the search ends at an end that is none of p
    (p implies AF q) and the like,        the same of q
    every e is followed by q
    all else                              so many states

Something is known to be false without a run where the time was over before its run could be written (`shownless`): a
search for this one comes first, and has a part of the time.

What has been found is not said because of this: the explorer answers what is so in the part of the space that was seen,
whatever the rest is like (cnative/src/explore/query/explore_ctl.c), with a run, and the token game plays the run.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pn2code.properties import meaning as m
from pn2code.properties.questions import Questions
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits, Order
from pn2code.verify.exploring.result import Exploration

STATES = 60_000
"""States of a search."""
FURTHER = 14
"""Searches by chance, each of so many runs to the end as there are in `RUNS`."""
RUNS = 3
LEAST = 2_000
"""States of these."""
RUN_PART = 0.5
"""Of the time that is left, what the search for a run may take of something that is known already."""

Explored = Callable[[Limits, ExploreOptions], Exploration | None]


def hunt(
    properties: Sequence[m.Asked],
    rows: Sequence[Mapping[str, Any]],
    lines: str,
    limits: Limits,
    options: ExploreOptions,
    explored: Explored,
    failing: Collection[int] = (),
) -> tuple[Mapping[str, Any], ...]:
    """The rows, of which some that were open have an answer, and some that were not have a run.

    Args:
        properties: what is asked.
        rows: what is known.
        lines: what the explorer has to know of programs, in front of each question.
        limits, options: of an exploration.
        explored: explores.
        failing: the numbers of those for which a run is wanted if it is known that they fail.
    """
    found = list(rows)
    for i in failing:
        row, own = rows[i], _asking(properties[i], i, lines, options)
        if is_shownless(row):
            part = replace(limits, deadline=limits.deadline.share(RUN_PART))
            said = _searched(part, own, explored)
            if said is not None and said["answer"] == row["answer"] and said.get("trace"):
                found[i] = {**said, "part": True}
    for i, (asked, row) in enumerate(zip(properties, rows, strict=True)):
        # Of a part it is not known what is fair.
        is_fair = isinstance(asked, m.Linear) and bool(asked.fair)
        if row["answer"] == "unknown" and not is_fair:
            said = _searched(limits, _asking(asked, i, lines, options), explored)
            found[i] = row if said is None else {**said, "part": True}
    return tuple(found)


def is_shownless(row: Mapping[str, Any]) -> bool:
    """Whether something is known that a run would show, and the run is not."""
    return row["answer"] == "no" and not row.get("trace")


def _asking(asked: m.Asked, number: int, lines: str, options: ExploreOptions) -> ExploreOptions:
    return replace(options, questions=lines + question(asked), stem=f"hunt-{number}", traces=None)


def _searched(
    limits: Limits, options: ExploreOptions, explored: Explored
) -> Mapping[str, Any] | None:
    """What the first search says that says something."""
    most = min(limits.max_states or STATES, STATES)
    states = most
    for order in range(2 + FURTHER):
        if limits.deadline.is_over():
            return None
        own = replace(limits, max_states=states, order=Order.DEPTH, threads=1, traces=0, graph=True)
        more = replace(options, shuffle=order, quick=True, first_states=STATES)
        seen = explored(own, more)
        if seen is None or seen.error is not None or len(seen.answers) != 1:
            return None
        if seen.answers[0]["answer"] != "unknown":
            return seen.answers[0]
        if order > 0:
            states = min(most, max(LEAST, RUNS * seen.depth))
    return None


def question(asked: m.Asked) -> str:
    """The lines for the explorer: what is asked, and where to look."""
    made = Questions()
    made.ask(asked)
    avoided, sought = _aim(asked)
    if avoided is not None and _is_plain(avoided):
        made.asked.insert(0, f"avoid {made.item(avoided)}")
    if sought is not None:
        made.asked.insert(0, f"seek {made.item(sought)}")
    return made.text()


def _aim(asked: m.Asked) -> tuple[m.Formula | None, m.Formula | None]:
    """What is avoided, and at which ends a search is over."""
    match asked:
        case m.Branching(m.Op("AF", (p,))) | m.Linear(m.Op("F", (p,))) if m.is_of_nodes(p):
            return p, m.negation(p)
        case m.Branching(formula) | m.Linear(formula):
            return None, _awaited(formula)
        case m.Response(_, second) if m.is_of_nodes(second):
            return None, m.negation(second)
        case _:
            return None, None


def _awaited(f: m.Formula) -> m.Formula | None:
    """What an end has to be, so that what is awaited there has not come to pass."""
    wanted = [p for p in _goals(f) if m.is_of_nodes(p)]
    return m.disjunction(*map(m.negation, wanted)) if wanted else None


def _goals(f: m.Formula) -> Iterator[m.Formula]:
    if isinstance(f, m.Atom):
        return
    if f.operator in ("AF", "EF", "F", "AU", "EU", "U"):
        yield f.parts[-1]
    for part in f.parts:
        yield from _goals(part)


def _is_plain(f: m.Formula) -> bool:
    """Whether it is known of a state before what can occur in it."""
    return all(a.kind in ("true", "pred", "initial") for a in m.atoms(f))
