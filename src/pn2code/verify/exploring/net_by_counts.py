"""A net of which not all markings are counted: what can still be said of all of them.

    known = look(net, storage, limits, options, part, final=places)    # None: nothing
    known.ends, known.never

As for a cell with many parts (`verify.controller.by_counts`) tokens are counted up to a limit only (`counts`), and
transitions are looked at in turns (`turns`); here each transition is an owner of its own, as in a net everything that
is enabled may occur. What holds in all states, and of all steps, holds in all markings, if no run goes on for ever;
that weights show (`ranking`), and a look for a cycle of the transitions for which there are none:

    no exception    none is raised in a state; an occurrence that raises one would be a step of a state
    no endless run  each run comes to a dead marking
    ends            each state in which nothing is enabled has a token in one of the places `final`; so has each dead
                    marking, as its state is dead, too
    never           transitions that occur in no state

Priorities would make transitions depend on each other all over the net, so all have to be the same.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

from pn2code.net.flat import FlatNet
from pn2code.properties.questions import ENDLESS, Questions
from pn2code.verify.exploring.counted import Counted, counted
from pn2code.verify.exploring.elements import NotPossibleError
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.numbers_as_tokens import numbers_as_tokens
from pn2code.verify.exploring.result import Exploration, Known
from pn2code.verify.exploring.smaller_look import explored
from pn2code.verify.exploring.turns import turns

MOST_OWNERS = 250
"""Transitions: each is an owner of its own."""


def _counted(net: FlatNet, storage: Mapping[str, str], final: Collection[int]) -> Counted | None:
    """The limits of a net; None: it is not possible, or there is nothing to count so."""
    if (
        net.timed
        or len(net.transitions) > MOST_OWNERS
        or len({t.priority for t in net.transitions}) > 1
    ):
        return None
    try:
        table = turns(net, range(len(net.transitions)))
    except NotPossibleError:
        return None
    return counted(net, storage, table, set(range(len(net.places))) - set(final))


def _questions(
    net: FlatNet, final: Collection[int], rising: frozenset[int], *, to_the_end: bool
) -> str:
    """Whether each dead state is an end, and whether those that may go on for ever have a cycle."""
    asked = Questions()
    lines = [*(f"owner {t.index} {t.index}" for t in net.transitions), "priorities own"]
    lines += [*(f"instant 0 {i}" for i in sorted(rising)), "instant 1 0"]
    found = asked.line(f"not {asked.line('dead')}")
    for place in sorted(final):
        found = asked.line(f"or {found} {asked.line(f'within {place} 1 -')}")
    asked.asked.append(f"? invariant {found}")
    if rising:
        asked.asked.append(f"? restless 0 {ENDLESS}")
    if to_the_end:
        # It needs the graph: a "no" to the first ends nothing.
        asked.asked.append(f"? restless 1 {ENDLESS}")
    return "".join(f"{line}\n" for line in lines) + asked.text()


def look(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    options: ExploreOptions,
    final: Collection[int],
) -> Known | None:
    """Explores; None: nothing can be said in this way.

    Args:
        net, storage: as for `explore`.
        limits: of the exploration.
        options: who is told of the progress, and who may interrupt.
        final: places one of which is to hold a token in each dead marking.
    """
    # Transitions keep their numbers, and nothing is asked of places but those that are final.
    among = {p.index for p in net.places}.difference(final)
    net = numbers_as_tokens(net, storage, among).net
    made = _counted(net, storage, final)
    if made is None:
        return None
    rising = made.ranking.rising()
    # Where weights show that each run ends, the states are enough; to find their arcs takes as long again.
    found = None if rising else _explored(net, storage, limits, options, made, final, rising)
    if found is None or found.why == "decided":
        found = _explored(net, storage, limits, options, made, final, rising, to_the_end=True)
    if found is None or not found.complete or found.error is not None:
        return None
    ends, *others = found.answers
    if any(row["answer"] != "yes" for row in others[: bool(rising)]):
        return None
    never = tuple(t.index for t in net.transitions if not found.fired[t.index])
    return Known(found.nodes, found.arcs, found.seconds, ends["answer"] == "yes", never)


def _explored(
    net: FlatNet,
    storage: Mapping[str, str],
    limits: Limits,
    options: ExploreOptions,
    made: Counted,
    final: Collection[int],
    rising: frozenset[int],
    *,
    to_the_end: bool = False,
) -> Exploration | None:
    """The states, with their arcs if it is to see them to the end whatever the answers are."""
    own = ExploreOptions(
        turns=made.turns,
        counts=made.counts,
        sizes=made.sizes,
        questions=_questions(net, final, rising, to_the_end=to_the_end),
        stem="counts",
    )
    found = explored(net, storage, limits, options, own, graph=to_the_end)
    if found is None or len(found.answers) != own.questions.count("? "):
        return None
    return found if found.seen.arcs or not to_the_end else None
