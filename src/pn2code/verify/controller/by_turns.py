"""The cell as it runs where it is large: its programs are looked at in turns (`verify.exploring.turns`).

    looked = by_turns(partition, plan, limits, options, d)
    looked.found, looked.orders      # None: the whole space has to decide

It is looked at in a net that does a little more (`Running.of(loose=True)`), since what a script that stops does to all
others would make each program depend on each. If no script stops there, none does, and the two nets are the same up to
the supervisor's end. What turns keep is proved in `verify.exploring.turns`, for spaces without a cycle; so it is asked

    no cycle           of all steps, in the same way as `restless`: then no run goes on for ever, nor is one longer than
                       the longest one that is seen, and none of the sets of `Moments` is
    no stop            nobody puts a token into `stopped`, nor into `unsure`
    the end            from each state that is seen an end can be reached; so each dead state has one, and they are
                       exactly those of the whole space, in which everything comes to a dead state
    channels, capacity what a place holds is kept
    silence            that nobody waits for others while it owes an answer: its places are a group. Whether the
                       supervisor rests is not asked, so that it is the stronger question
    properties         conditions on all states (`stated`): the places of each are a group; what is not so in a state of
                       this net is looked for in the cell
    messages, poses,
    memory, dead       all that occurs, and what each place holds, is kept
    transitions
    finite, bounded,   the supervisor leads. A run of its firings depends on places that no one else changes, and on
    confluence         messages that it has seen, which nobody changes as long as channels hold one. In each run to a
                       dead state that is explored it finds itself before the same firing with the same places, and
                       there all its steps are explored. So these three are the same, a "no" included

Unless all of these come out well (the order of firing may matter), nothing is said, and the whole space decides.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.partition import SUPERVISOR, Partition
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.silence import Silence
from pn2code.verify.exploring.elements import NotPossibleError
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.turns import Turns, turns


class OutOfReachError(Exception):
    """The machine, or the time given, does not suffice; the text is why, a word of `Exploration`."""


_ENDS = ("processor", "memory", "seconds", "interrupted")
"""After these the whole space, which is larger, is not looked at."""


@frozen
class Looked:
    """What was seen.

    Args:
        running: the net.
        found: its space, with answers to the questions about the cell, and about orders if they are all the same.
        orders: the space of all orders, if these are not; its first answers are those to the questions about them.
        told: the answers to what was asked of states instead of properties, one or more for some of these.
    """

    running: Running
    found: Exploration
    orders: Exploration | None
    told: tuple[Mapping[str, Any], ...] = ()


def loosened(
    partition: Partition, groups: Iterable[Collection[int]] = ()
) -> tuple[Running, Turns] | None:
    """The net, and the table of its turns; None: it is not possible.

    Args:
        partition: the cell.
        groups: more places of which it matters what they hold at the same time.
    """
    running = Running.of(partition, loose=True)
    try:
        return running, table_of(running, [*map(group, running.silences), *groups])
    except NotPossibleError:
        return None


def table_of(running: Running, groups: Sequence[Collection[int]]) -> Turns:
    """The table of a net.

    Raises:
        NotPossibleError: something stands in the way.
    """
    own = running.partition.transition_owner
    return turns(
        running.net,
        running.owners(),
        probes=running.probes,
        firsts=[i for i, o in enumerate(own) if o == SUPERVISOR],
        chosen=[i for i, o in enumerate(own) if o != SUPERVISOR],
        groups=groups,
        leading=SUPERVISOR,
    )


def group(silence: Silence) -> frozenset[int]:
    """The places that the question about a silence mentions."""
    control = {place for place, _ in silence.states}
    ways = [ready for _, ready_there in silence.states for ready in ready_there]
    messages = {p for ready in ways for m in ready.messages for p in m}
    own = {p for ready in ways for p in ready.places}
    answers = {p for pair in silence.answers for p in pair}
    return frozenset({silence.owes, *control, *messages, *own, *answers})


def look(
    made: tuple[Running, Turns],
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    d: Diagnostics,
    *,
    cell: str,
    orders: str,
    is_choiceless: Any,
    properties: int = 0,
) -> Looked | None:
    """Explores in turns; None: not all came out well, or it is too large as well.

    Args:
        made: the net and its table.
        plan, limits: as for `control.examine`.
        options: of the exploration, without what is asked.
        d: gets the errors.
        cell: what is asked of the cell, all of it to be answered with "yes", and then of its orders, if that may be.
        orders: what is asked of all orders.
        is_choiceless: whether what was seen says that all orders are one.
        properties: so many of the first questions about the cell may have any answer.

    Raises:
        OutOfReachError: it could not be seen to its end.
    """
    running, table = made
    own = replace(
        options,
        turns=table,
        sizes=Sizes.start(running.net, plan.storage),
        generated=Generated(),
        quick=False,
    )
    found = _explored(running.net, plan, limits, d, replace(own, questions=cell))
    if found is None or not all_good(found.answers, cell, properties):
        return None
    told = tuple(found.answers[:properties])
    found = replace(found, answers=tuple(found.answers[properties:]))
    if is_choiceless(found):
        return Looked(running, found, None, told)
    own = replace(own, questions=orders, stem="orders")
    other = _explored(running.net, plan, limits, d, own)
    if other is None or not all_good(other.answers, orders):
        return None
    return Looked(running, found, other, told)


def _explored(
    net: FlatNet, plan: Plan, limits: Limits, d: Diagnostics, options: ExploreOptions
) -> Exploration | None:
    """A space that was seen to its end."""
    found = explore(net, plan.storage, limits, d, options)
    if found is not None and not found.complete and found.why in _ENDS:
        raise OutOfReachError(found.why)
    is_whole = found is not None and found.complete and found.seen.arcs and found.error is None
    return found if is_whole else None


ABOUT_ORDERS = ("finite-response", "bounded-response", "confluence")
"""Questions that may be answered with "no", as a part of the space is seen whole."""


def all_good(rows: Sequence[Mapping[str, Any]], questions: str, first: int = 0) -> bool:
    """Whether all that is asked from `first` on has the answer "yes", but for what is asked about orders."""
    asked = [line.split()[1] for line in questions.split("\n") if line.startswith("? ")]
    if len(asked) != len(rows):
        return False
    return all(
        row["answer"] == "yes" or what in ABOUT_ORDERS
        for what, row in [*zip(asked, rows, strict=True)][first:]
    )


def validity(running: Running) -> Iterator[str]:
    """What has to be answered with "yes" in a space of which only the orders are asked."""
    ends = [running.stopped, *([] if running.unsure is None else [running.unsure])]
    yield from (f"? bound {place} 0 0" for place in ends)
    yield from (f"? restless {i} {steps.most}" for i, steps in enumerate(running.moments.sets()))
    yield from (f"? bound {c.place} 0 1" for c in running.partition.channels)
