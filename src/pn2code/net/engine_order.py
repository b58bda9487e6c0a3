"""The order in which CPN Tools binds the variables of a transition, and what goes wrong in it.

Its public sources say how: every step has a weight, and it takes the steps of least weight together, from "no variable
has a value" to "all have one" (see `engine_search` for the steps). Trying all values weighs 1,000, matching a token
100, finding one by known components 20, testing an arc 10, a condition 2, an equation 1. In two steps there are
mistakes:

* what finds a token by its components is written as a pattern, which cannot be compiled if it is none;
* an equation does not compare a name that stands for a variable that is there twice, if both have values already. So a
  token whose parts differ is taken, and an equation `p = (i, i)` holds whatever the second part of p is.

Of several orders of the least weight it is not known which it takes.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterator

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Symbol
from pn2code.net import engine_search
from pn2code.net.engine_search import Lookup, Step, Steps
from pn2code.net.engine_tables import Group, Tables


@frozen
class Faults:
    """What may go wrong in a transition.

    Args:
        arcs: the numbers of those that may be written as patterns, and are none.
        is_certain: whether one of them is, whichever order is taken.
        repeated: variables that are twice in a pattern and may be not compared.
    """

    arcs: frozenset[int] = frozenset()
    is_certain: bool = False
    repeated: frozenset[Symbol] = frozenset()


NONE = Faults()


def faults(tables: Tables, group: int, is_small: Callable[[Symbol], bool]) -> Faults:
    """What may go wrong with a group for which there is an order."""
    found = tables.groups[group]
    odd = frozenset(_no_patterns(found))
    compared = set(_compared(found))
    stands = {n for n in found.names if isinstance(n, int)} - compared
    if not odd and not stands:
        return NONE
    made = Steps(tables, found)
    steps: list[Step | Lookup] = [*made.all(is_small)]
    steps += made.lookups
    start = ((1 << (len(found.arcs) + len(found.conditions))) - 1) << found.count
    end = (1 << found.count) - 1
    taken = _cheapest(steps, start, end)
    if taken is None:
        return Faults(odd, False, frozenset(tables.twice[n] for n in stands))
    arcs: set[int] = set()
    repeated: set[int] = set()
    fine: list[tuple[int, Step | Lookup]] = []
    for marking, step in taken:
        if isinstance(step, Lookup) and not step.leaf.is_pattern:
            arcs.add(step.leaf.arc)
            continue
        fine.append((marking, step))
        if isinstance(step, Step) and step.stands and not step.gives & ~step.needs & ~marking:
            repeated |= step.stands & stands
    is_certain = bool(arcs) and not _leads(fine, start, end)
    return Faults(frozenset(arcs), is_certain, frozenset(tables.twice[n] for n in repeated))


def _leads(steps: list[tuple[int, Step | Lookup]], start: int, end: int) -> bool:
    """Whether some of the steps lead from one marking to the other."""
    after: dict[int, list[int | None]] = {}
    for marking, step in steps:
        after.setdefault(marking, []).append(step.after(marking))
    seen, open_ = {start}, [start]
    while open_:
        new = [m for m in after.get(open_.pop(), ()) if m is not None and m not in seen]
        seen.update(new)
        open_ += new
    return end in seen


def _compared(group: Group) -> Iterator[int]:
    """Numbers in a sum of a single arc, which is tested in the end as it is written."""
    for arc in group.arcs:
        if arc.is_sum and len({leaf.arc for leaf in arc.leaves}) == 1:
            for leaf in arc.leaves:
                yield from (n for n in leaf.names() if isinstance(n, int))


def _no_patterns(group: Group) -> Iterator[int]:
    for arc in group.arcs:
        for leaf in arc.leaves:
            if leaf.is_record and not leaf.is_pattern and not leaf.coefficient:
                yield leaf.arc


def _cheapest(
    steps: list[Step | Lookup], start: int, end: int
) -> set[tuple[int, Step | Lookup]] | None:
    """The steps of all orders of the least weight, with the marking before each; None: too many to look at."""
    weights = {start: 0}
    before: dict[int, list[tuple[int, Step | Lookup]]] = {}
    done: set[int] = set()
    queue = [(0, start)]
    while queue:
        weight, marking = heapq.heappop(queue)
        if marking == end:
            break
        if marking in done:
            continue
        done.add(marking)
        if len(done) > engine_search.MOST:
            return None
        for step in steps:
            after = step.after(marking)
            if after is None:
                continue
            new = weight + step.weight
            known = weights.get(after)
            if known is None or new < known:
                weights[after], before[after] = new, [(marking, step)]
                heapq.heappush(queue, (new, after))
            elif new == known:
                before[after].append((marking, step))
    found: set[tuple[int, Step | Lookup]] = set()
    seen, open_ = {end}, [end]
    while open_:
        for marking, step in before.get(open_.pop(), ()):
            found.add((marking, step))
            if marking not in seen:
                seen.add(marking)
                open_.append(marking)
    return found
