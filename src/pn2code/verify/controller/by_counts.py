"""The cell as it runs where it is very large: in turns, with tokens counted up to a limit (`verify.exploring.counts`).

    seen = look(partition, plan, limits, options, part=part, order=rows)     # None: something else has to decide
    seen.looked.found, seen.said, seen.asked

A state stands for many markings, so what is asked is whether all states are as they should be, and the rest is shown by
weights of places (`verify.exploring.ranking`):

    the end            no run goes on for ever (weights, and no cycle among the steps for which there are none); each
                       state in which nothing can happen has an end. So does each dead marking, and each marking leads
                       to one
    no stop            no state has a token in `stopped`, nor in `unsure`
    moments            `Moments`: weights limit how many transitions of robots follow each other
    channels, capacity no state has more tokens there; of a place with a limit the structure of the net has to say it
    silence            as in turns: its places have no limits
    messages, poses,   what single places hold in a state, and what single steps need, is no less than what they hold
    memory             and need in a marking
    finite, bounded    weights limit how many firings follow each other
    confluence         a "no" is that of a part of the whole space, in which all firings of a cycle are there; a "yes"
                       is said where the supervisor never has a choice in any state, or any two firings commute
                       (`diamonds`)
    dead transitions   what occurs in no state never occurs; of all others a run in the whole space, or in turns, is
                       known
    properties         conditions on all states (`stated`): the places of each are a group, and have no limits, so each
                       marking has a state with the same tokens there. What is not so in a state has to be known from
                       the part of the whole space; else it is left open (`Seen.has_open`)

All else has to come out so; if it does not nothing is said.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.partition import SUPERVISOR, Partition
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.properties.questions import ENDLESS, Questions
from pn2code.verify.controller import diamonds
from pn2code.verify.controller.by_turns import Looked, group, loosened
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.controller.kept_silence import kept_silence
from pn2code.verify.controller.left_over import nothing_left
from pn2code.verify.controller.running import Running, chunks
from pn2code.verify.controller.stated import Stated, ways
from pn2code.verify.exploring.counted import MOST_STATES, SOON, counted
from pn2code.verify.exploring.counts import LEAST_TOKENS, Counts
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import REACHED, Limits, Order
from pn2code.verify.exploring.numbers_as_tokens import numbers_as_tokens
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.ranking import Ranking
from pn2code.verify.exploring.result import Bounds, Exploration
from pn2code.verify.exploring.turns import Turns

CUT_SHORT = (*REACHED, "processor", "interrupted")
"""Why not all states of a cell were explored, but as many as could be."""
WITNESSES = 60_000
"""States among which transitions are looked for that occur."""
YES: Mapping[str, Any] = {"answer": "yes", "value": None, "trace": None, "loop": None, "why": None}
"""A row as the explorer gives it."""


@frozen
class Seen:
    """What was seen.

    Args:
        looked: the net and its states.
        said: what follows of the questions about the cell, in the order of `control_questions.of_cell`.
        asked: the same of those about its orders.
        answers: what is said of properties, in their order.
        others: the numbers of properties that are about the closed net alone.
        is_quiet: whether nothing is left for the supervisor where nothing can happen any more (`left_over`).
    """

    looked: Looked
    said: tuple[Mapping[str, Any], ...]
    asked: tuple[Mapping[str, Any], ...]
    answers: tuple[Mapping[str, Any], ...]
    is_quiet: bool
    others: frozenset[int] = frozenset()

    @property
    def has_open(self) -> bool:
        """Whether all states have to be explored for a property."""
        return any(
            row["answer"] == "unknown" and i not in self.others
            for i, row in enumerate(self.answers)
        )

    def with_more(self, whole: Exploration) -> Seen | None:
        """With what a larger part of the whole space says of open properties; None: that is all that is asked.

        Args:
            whole: of the cell, as much as could be explored.
        """
        told = [{**row, "part": True} for row in whole.answers[: len(self.answers)]]
        if whole.why not in CUT_SHORT or len(told) < len(self.answers):
            return None
        if self.looked.running.meek and any(row.get("trace") for row in told):
            return None  # whether scripts can do so is looked for in the whole net
        # What the part said that was seen before is said again, and runs have been written again.
        rows = zip(self.answers, told, strict=True)
        merged = tuple(
            a if b["answer"] == "unknown" and a["answer"] != "unknown" else b for a, b in rows
        )
        return replace(self, answers=merged)


@frozen
class Abstract:
    """A net, what is counted in it up to a limit, and how it is explored."""

    running: Running
    counts: Counts
    turns: Turns
    ranking: Ranking
    sizes: Sizes
    properties: tuple[Stated, ...] = ()
    """what is asked of all states besides"""


def abstract(
    partition: Partition,
    plan: Plan,
    kept: Sequence[int] = (),
    properties: Sequence[Stated] = (),
    *,
    least: int = LEAST_TOKENS,
    demanded: Mapping[int, int] = MappingProxyType({}),
) -> Abstract | None:
    """The net of turns with its limits; None: there is nothing to count so.

    Args:
        partition: the cell.
        plan: what is asked.
        kept: more places of which all tokens count.
        properties: conditions on its states, those of `plan` that are not known.
        least, demanded: as for `counts`.
    """
    loose = loosened(partition, [x.places for x in properties])
    if loose is None or not partition.final_places:
        return None
    running, table = loose
    own = {p.index for p in partition.net.places}
    open_ = {p for p, most in plan.capacities.items() if plan.bounds.get(p, most + 1) > most}
    asked = {p for s in running.silences for p in group(s)} | open_ | set(kept)
    asked |= {p for x in properties for p in x.exact}
    free = own - asked - {c.place for c in partition.channels}
    made = counted(
        running.net,
        plan.storage,
        table,
        free,
        never=running.probes,
        least=least,
        demanded=demanded,
    )
    if made is None:
        return None
    return Abstract(running, made.counts, made.turns, made.ranking, made.sizes, tuple(properties))


def with_tokens(
    partition: Partition,
    plan: Plan,
    kept: Sequence[int] = (),
    properties: Sequence[Stated] = (),
) -> Partition:
    """The cell with those counters of its supervisor as tokens of which nothing is asked (`numbers_as_tokens`)."""
    others = {*kept, *plan.capacities, *partition.final_places}
    others |= {c.place for c in partition.channels} | {x.place for x in partition.inputs}
    others |= {place for p in plan.properties.predicates for _, place in p.places}
    others |= {place for x in properties for place in (*x.places, *x.exact)}
    for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True):
        if owner != SUPERVISOR:
            others |= {a.place for a in t.arcs}
    among = {p.index for p in partition.net.places} - others
    made = numbers_as_tokens(partition.net, plan.storage, among)
    owners = (*partition.place_owner, *[SUPERVISOR] * made.added)
    return replace(partition, net=made.net, place_owner=owners)


MOVED = 256
"""Bytes that a firing may need to take and put a number, and not for packed tokens: two moves with values."""


def memory_of_numbers(net: FlatNet, written: FlatNet) -> int:
    """So many bytes more than with counters as tokens a firing may need with the numbers of the net.

    Where several bindings are looked at, there is room for twice as much, as there is for places that are packed
    otherwise in what is deployed (`arena`).
    """
    counters = {p.index for p in net.places if p.colset != written.places[p.index].colset}
    touched = (len(counters & {a.place for a in t.arcs}) for t in net.transitions)
    return MOVED * max(touched, default=0)


def with_memory(arena: Mapping[str, int] | None, more: int) -> Mapping[str, int] | None:
    """What firings need, if they need any, with so much more."""
    if arena is None or not arena["firing"]:
        return arena
    return {**arena, "firing": arena["firing"] + more}


def look(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    *,
    part: Exploration,
    order: Sequence[Mapping[str, Any]],
    in_order: str,
) -> Seen | None:
    """Explores; None: not all comes out well, or cannot be known in this way.

    Args:
        partition: the cell.
        plan, limits: as for `control.examine`.
        options: of the exploration, without what is asked.
        part: a part of the whole space of the cell.
        order: what is known of all orders from a part of their space.
        in_order: questions about orders, which are answered where the supervisor never has a choice.
    """
    known = part.answers[: len(plan.properties.properties)]
    properties = _open_properties(partition, plan, known)
    made, more_memory = None, 0
    if properties is not None:
        net = partition.net
        partition = with_tokens(partition, plan, options.whole, [x for _, x in properties])
        more_memory = memory_of_numbers(net, partition.net)
        properties = _open_properties(partition, plan, known) or []
        made = abstract(partition, plan, options.whole, [x for _, x in properties])
    if made is None or properties is None:
        return None
    running = made.running
    if running.meek and any(row["trace"] for row in known):
        return None  # whether scripts can do so is looked for in the whole net
    lengths = _lengths(partition, plan, made)
    if lengths is None:
        return None
    rising = made.ranking.rising()
    is_certain = is_decided(order)
    own = replace(
        options,
        turns=made.turns,
        counts=made.counts,
        sizes=made.sizes,
        generated=Generated(),
        traces=None,
        evidence=None,
        bindings=(),
        questions=questions(made, plan, rising) + ("" if is_certain else in_order),
        stem="counts",
        quick=True,
        first_states=SOON,
    )
    most = min(limits.max_states or MOST_STATES, MOST_STATES)
    limits = replace(limits, max_states=most, traces=0)
    d = Diagnostics()  # what is wrong with this net the whole space tells
    found = explore(running.net, plan.storage, limits, d, own)
    if found is None or not found.complete or found.error is not None:
        return None
    count = sum(line.startswith("? ") for line in own.questions.split("\n"))
    if len(found.answers) != count:
        return None
    rows = [*(found.answers if is_certain else found.answers[: count - in_order.count("? ")])]
    quiet, *rows = rows
    if any(row["answer"] != "yes" for row in rows[len(properties) :]):
        return None
    if not is_certain:
        is_choiceless = found.seen.arcs and found.answers[len(rows) + 1]["answer"] != "unknown"
        if not is_choiceless and not _all_commute(partition, plan, limits, own, made):
            return None
    if not _all_occur(partition, plan, limits, own, made, found, part):
        return None
    confluence = order[CONFLUENCE:] if is_certain else (YES, YES)
    longest, firings = lengths
    asked = (YES, {**YES, "value": firings}, *confluence)
    said = _said(partition, plan, made, found, rows, longest)
    found = replace(found, arena=with_memory(found.arena, more_memory))
    looked = Looked(running, _bounded(found, made, plan), None)
    told: dict[int, Mapping[str, Any]] = {i: {**row, "part": True} for i, row in enumerate(known)}
    for (i, x), row in zip(properties, rows, strict=False):
        if x.holds(row):
            told[i] = x.row(plan.properties.properties[i])
    rows_of = tuple(told[i] for i in sorted(told))
    others = frozenset(i for i, p in enumerate(plan.properties.properties) if p.of_net)
    return Seen(looked, said, asked, rows_of, quiet["answer"] == "yes", others)


def _all_commute(
    partition: Partition, plan: Plan, limits: Limits, options: ExploreOptions, made: Abstract
) -> bool:
    """Whether the order in which the supervisor fires does not matter (`diamonds`)."""
    firings = [i for i, o in enumerate(partition.transition_owner) if o == SUPERVISOR]
    channels = [c.place for c in partition.channels]
    pairs = diamonds.undecided(made.running.net, plan.storage, firings, channels)
    if not pairs:
        return pairs is not None
    # The states in which it takes any of its firings.
    alone: Abstract | None = replace(made, properties=())
    more, limited = diamonds.demanded(pairs), {x.place: x.most for x in made.counts.limits}
    if any(n > limited.get(p, n) for p, n in more.items()):
        alone = abstract(partition, plan, options.whole, demanded=more)
    if alone is None:
        return False
    lines = questions(alone, plan, alone.ranking.rising(), first=False, apart=pairs)
    own = replace(
        options,
        turns=alone.turns,
        counts=alone.counts,
        sizes=alone.sizes,
        generated=options.generated if alone.sizes is made.sizes else Generated(),
        questions=lines,
        stem="orders",
    )
    found = explore(alone.running.net, plan.storage, limits, Diagnostics(), own)
    is_seen = found is not None and found.complete and found.error is None
    if found is None or not is_seen or len(found.answers) != lines.count("\n? "):
        return False
    return all(row["answer"] == "yes" for row in found.answers[1:])


def _open_properties(
    partition: Partition, plan: Plan, known: Sequence[Mapping[str, Any]]
) -> list[tuple[int, Stated]] | None:
    """Those that states may tell and a part of the whole space does not, by number; None: it was not asked."""
    properties = plan.properties.properties
    if len(known) < len(properties):
        return None
    left = [i for i in range(len(properties)) if known[i]["answer"] == "unknown"]
    over = Running.of(partition, loose=True).over if left else 0
    found: list[tuple[int, Stated]] = []
    for i in left:
        found += ((i, x) for x in ways(properties[i], over, plan.properties, partition))
    return found


CONFLUENCE = 2
"""The first question about orders that weights do not answer."""


def is_decided(order: Sequence[Mapping[str, Any]]) -> bool:
    """Whether a part of the space of all orders shows that the order of firings matters."""
    return len(order) > CONFLUENCE and order[CONFLUENCE]["answer"] == "no"


def questions(
    made: Abstract,
    plan: Plan,
    rising: frozenset[int],
    *,
    first: bool = True,
    apart: diamonds.Pairs = (),
) -> str:
    """All but the first have to be answered with "yes"; in front are those that `_said` leaves out, and properties.

    Args:
        made, plan: what is looked at, and what is asked.
        rising: transitions of which weights do not show that they occur only so often.
        first: whether the supervisor takes the first of its binding elements; else it takes any.
        apart: transitions that are never enabled together.
    """
    running, partition = made.running, made.running.partition
    lines = [x for x in running.lines(first=first) if not x.startswith("instant ")]
    asked = Questions()
    asked.asked.append(f"? invariant {nothing_left(asked, running)}")
    for x in made.properties:
        x.ask(asked)
    if rising:
        lines += chunks("instant 0", sorted(rising))
        asked.asked.append(f"? restless 0 {ENDLESS}")
    end = asked.line(f"within {running.over} 1 -")
    going = asked.line(f"not {asked.line('dead')}")
    asked.asked += [
        f"? invariant {asked.line(f'or {going} {end}')}",
        f"? bound {running.stopped} 0 0",
        *(f"? invariant {kept_silence(asked, s, None)}" for s in running.silences),
        *(f"? bound {c.place} 0 1" for c in partition.channels),
        *(
            f"? bound {place} 0 {most}"
            for place, most in plan.capacities.items()
            if place not in made.counts.limited
        ),
        *([] if running.unsure is None else [f"? bound {running.unsure} 0 0"]),
    ]
    diamonds.ask(asked, apart)
    return "".join(f"{line}\n" for line in lines) + asked.text()


def _said(
    partition: Partition,
    plan: Plan,
    made: Abstract,
    found: Exploration,
    rows: Sequence[Mapping[str, Any]],
    longest: Sequence[int],
) -> tuple[Mapping[str, Any], ...]:
    """The answers as `control_questions.of_cell` asks for them."""
    _, stops, *others = rows[len(rows) - _asked(made, plan) :]
    silences, channels = len(made.running.silences), len(partition.channels)
    left = iter(others[silences + channels :])
    declared: Iterator[Mapping[str, Any]] = (
        {**YES, "value": plan.bounds[p], "why": "structure"}
        if p in made.counts.limited
        else next(left)
        for p in plan.capacities
    )
    return (
        {**YES, "value": found.nodes},
        stops,
        *({**YES, "value": n} for n in longest),
        *others[: silences + channels],
        *declared,
        *left,
    )


def _asked(made: Abstract, plan: Plan) -> int:
    """How many questions there are but for that about cycles."""
    running = made.running
    declared = sum(p not in made.counts.limited for p in plan.capacities)
    count = 2 + len(running.silences) + len(running.partition.channels) + declared
    return count + (running.unsure is not None)


def _lengths(
    partition: Partition, plan: Plan, made: Abstract
) -> tuple[tuple[int, ...], int] | None:
    """Most transitions of robots in each of `Moments.sets`, and most firings in a cycle; None: not few enough."""
    owners = partition.transition_owner
    robots = {i for i, o in enumerate(owners) if o != SUPERVISOR}
    firings = {i for i, o in enumerate(owners) if o == SUPERVISOR}
    found: list[int] = []
    for steps in made.running.moments.sets():
        longest = made.ranking.longest(set(steps.transitions), robots)
        if longest is None or longest > steps.most:
            return None
        found.append(longest)
    most = made.ranking.longest(firings, firings)
    if most is None or most > plan.firings:
        return None
    return tuple(found), most


def _all_occur(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    made: Abstract,
    found: Exploration,
    part: Exploration,
) -> bool:
    """Whether each transition that occurs in a state is known to occur in a marking."""
    count = len(partition.transition_owner)
    some = {i for i in range(count) if found.fired[i] > 0}
    some -= {i for i in range(count) if part.fired[i] > 0}
    if not some:
        return True
    lines = "".join(f"{x}\n" for x in made.running.lines(first=True))
    own = replace(options, counts=None, questions=lines, stem="witnesses")
    deep = replace(limits, max_states=WITNESSES, order=Order.DEPTH, graph=False, threads=1)
    run = explore(made.running.net, plan.storage, deep, Diagnostics(), own)
    return run is not None and run.error is None and all(run.fired[i] > 0 for i in some)


def _bounded(found: Exploration, made: Abstract, plan: Plan) -> Exploration:
    """With what the structure proves of places that have a limit."""
    if found.bounds is None:
        return found
    limited = made.counts.limited | {x.place for x in made.counts.limits}

    def own(place: int, b: Bounds) -> Bounds:
        most = made.ranking.upper[place] if place in limited else b.upper
        return Bounds(0, most, None, None) if place in limited else b

    return replace(found, bounds=tuple(own(p, b) for p, b in enumerate(found.bounds)))
