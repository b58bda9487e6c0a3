"""Random properties of a cell: what is said where tokens are counted up to a limit, held against all states."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from random import Random

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.properties import meaning as m
from pn2code.verdict.asked import gather
from pn2code.verdict.opened import OpenNet
from pn2code.verify.controller.by_counts import abstract, questions
from pn2code.verify.controller.control_types import Control, Plan
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.stated import Stated, ways
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits

Change = Callable[[Stated], Stated]
WRONG_PROPERTIES: dict[str, Change] = {
    "what a property looks at has limits": lambda x: replace(x, exact=frozenset()),
    "what a property looks at is no group": lambda x: replace(x, places=frozenset()),
}
LEAST = 2
"""Tokens of a place that gets a limit."""
MOST_STATES = 100_000
MOST = 8
"""Properties of a cell."""


def properties(r: Random, opened: OpenNet, partition: Partition) -> m.Properties:
    """Some of a cell, most of which say something of single states."""
    net = partition.net
    places = [f'"{p.name}"' for p in net.places]
    fired = [f'"{t.name}"' for t in net.transitions]
    finals = ", ".join(places[p] for p in partition.final_places)

    def place() -> str:
        return r.choice(places)

    def condition() -> str:
        return f"tokens({place()}) {r.choice(['=', '>=', '<='])} {r.randint(0, 2)}"

    channels = {c.place for c in partition.channels}
    own = [x for p, x in enumerate(places) if partition.place_owner[p] == 0 and p not in channels]

    def mine() -> str:
        return f"tokens({r.choice(own)}) {r.choice(['=', '>=', '<='])} {r.randint(0, 2)}"

    kinds = (
        lambda: f"mutex {', '.join(r.sample(places, 2))}",
        lambda: f"bound {place()} <= {r.randint(0, 3)}",
        lambda: f"bound {r.randint(0, 1)} <= {place()}",
        lambda: f"never {condition()} && {condition()}",
        lambda: f"always {condition()} || tokens({place()}, {place()}) <= 1",
        lambda: f"reachable tokens({place()}) = 1 && tokens({place()}) >= 1",
        lambda: f"never tokens({place()}) = {r.randint(0, 1)} && enabled({r.choice(fired)})",
        lambda: f"always dead -> {condition()}",
        lambda: f"deadlock free except tokens({finals}) >= 1 && {condition()}",
        lambda: f"ctl AF {condition()}",
        lambda: f"ctl AG EF {condition()}",
        lambda: f"ltl F {condition()}",
        lambda: f"ctl AG ({condition()} -> AF {condition()})",
        lambda: f"ctl {r.choice(['AG AF', 'EG', 'EF AG', 'AG EX', 'AF AG'])} {condition()}",
        lambda: f"ctl {r.choice('AE')}[{condition()} U {condition()}]",
        lambda: f"ltl G F {condition()}",
        lambda: f"every {condition()} is followed by {condition()}",
        lambda: f"every fires({r.choice(fired)}) is followed by {condition()}",
        lambda: f"every fires({r.choice(fired)}) is followed by {condition()} within 1 firings",
        lambda: f"ltl ({mine()}) U ({mine()})",
        lambda: f"ltl G ({mine()} -> ({mine()}) U ({mine()} || {mine()}))",
        lambda: f"ltl F ({mine()} && G {mine()})",
        lambda: f"every {mine()} is followed by {mine()}",
        lambda: f"ltl X {condition()}",
    )
    texts = [r.choice(kinds)() for _ in range(MOST)]
    return gather(opened, texts, None, Diagnostics(), found=False).plain


def of_part(
    properties: m.Properties, part: Control, whole: Control, counts: Counter[str]
) -> Iterator[str]:
    """What a part of the states, and searches for runs, say otherwise than all states."""
    if part.found is not None and not part.found.complete:
        for p, mine, its in zip(properties.properties, part.answers, whole.answers, strict=False):
            counts["properties asked of a part"] += 1
            counts["properties that a part decides"] += mine["answer"] != "unknown"
            if mine["answer"] not in (its["answer"], "unknown"):
                yield f"property `{p.holds}`: a part says {mine['answer']}, the whole {its['answer']}"


def of_states(properties: m.Properties, partition: Partition) -> m.Properties:
    """Those that are conditions on states."""
    kept = (p for p in properties.properties if ways(p, 0, properties, partition))
    return replace(properties, properties=tuple(kept))


def in_turns(
    properties: m.Properties, whole_properties: m.Properties, turned: Control, whole: Control
) -> Iterator[str]:
    """What is said in turns otherwise than of all states."""
    told = dict(zip(whole_properties.properties, whole.answers, strict=False))
    for p, mine in zip(properties.properties, turned.answers, strict=False):
        if mine["answer"] not in (told[p]["answer"], "unknown"):
            yield f"property `{p.holds}`: {mine['answer']} in turns, {told[p]['answer']} in all"


@frozen
class OfStates:
    """The properties of a cell that each hold in all of its states, where tokens are counted up to a limit."""

    properties: m.Properties
    holding: tuple[int, ...]
    of_paths: int = 0
    """how many formulas about paths are among them"""

    @staticmethod
    def of(
        asked: m.Properties, partition: Partition, plan: Plan, change: Change = lambda x: x
    ) -> OfStates | None:
        """Of properties, or wrong versions of them; None: nothing is said."""
        over = Running.of(partition, loose=True).over
        known = [
            (i, change(x))
            for i, p in enumerate(asked.properties)
            for x in ways(p, over, asked, partition)
        ]
        made = abstract(partition, plan, (), [x for _, x in known], least=LEAST)
        if made is None:
            return None
        own = replace(plan, properties=asked)
        lines = questions(made, own, made.ranking.rising())
        options = ExploreOptions(
            turns=made.turns,
            counts=made.counts,
            sizes=made.sizes,
            questions=lines,
            predicates=asked.predicates,
            quick=True,
        )
        limits = Limits(max_states=MOST_STATES, threads=1, traces=0)
        found = explore(made.running.net, plan.storage, limits, Diagnostics(), options)
        if found is None or not found.complete or found.error is not None:
            return None
        said = found.answers
        about, others = said[1 : 1 + len(known)], said[1 + len(known) :]
        if len(said) != lines.count("\n? ") or any(row["answer"] != "yes" for row in others):
            return None
        holding = {i for (i, x), row in zip(known, about, strict=True) if x.holds(row)}
        paths = {
            i for (i, x), row in zip(known, about, strict=True) if x.is_of_paths and x.holds(row)
        }
        return OfStates(asked, tuple(sorted(holding)), len(paths))

    def judged(self, whole: Control, counts: Counter[str]) -> Iterator[str]:
        """What is wrong: `whole` are all states of the cell, of which the same is asked."""
        counts["properties"] += len(self.properties.properties)
        counts["properties that hold with limits"] += len(self.holding)
        counts["formulas about paths that hold with limits"] += self.of_paths
        yield from self.wrong(whole)

    def wrong(self, whole: Control) -> Iterator[str]:
        """What does not hold in all states of the cell."""
        for i in self.holding:
            p = self.properties.properties[i]
            if whole.answers[i]["answer"] not in (Stated.row(p)["answer"], "unknown"):
                yield f"property `{p.holds}` does not hold"
