"""What tokens that are counted up to a limit say of a cell, held against all of its states.

* Each marking has its state, and each step of the cell is a step from the one to the other (looked at without turns).
* In turns: what occurs, and what other places hold, does so in the states; and what they say is so.
"""

from __future__ import annotations

import json
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller.by_counts import (
    Abstract,
    abstract,
    memory_of_numbers,
    questions,
    with_memory,
    with_tokens,
)
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.exploring.counts import Counts, Limit
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.exploring.turns import Turns

MOST = 100_000
MOST_COMPARED = 2_000
"""Markings of a cell of which each is looked for."""
LEAST = 2
"""Tokens of a place that gets a limit."""


def _smaller(made: Counts) -> Counts:
    return replace(made, limits=tuple(replace(x, most=max(x.most - 1, 0)) for x in made.limits))


def _other_sums(made: Counts) -> Counts:
    return replace(made, relations=tuple(replace(r, total=r.total - 1) for r in made.relations))


WRONG_LIMITS: dict[str, Callable[[Counts], Counts]] = {
    "limits are too small": _smaller,
    "relations are not fulfilled": _other_sums,
}


@dataclass(frozen=True)
class Limited:
    """The net with its limits, which one program explores again and again."""

    plan: Plan
    made: Abstract
    program: Generated
    known: frozenset[int]
    """places that are the same in the net of which this one was made"""
    more_memory: int
    """bytes that a firing may need more in that"""

    @staticmethod
    def of(partition: Partition, plan: Plan) -> Limited | None:
        """Of a cell, whose counters are written as tokens; None: no place gets a limit."""
        cell = with_tokens(partition, plan)
        made = abstract(cell, plan, least=LEAST)
        if made is None:
            return None
        own, count = partition.net.places, len(made.running.net.places)
        is_longer = len(cell.net.places) > len(own)
        known = frozenset(
            p
            for p in range(len(own) if is_longer else count)
            if p >= len(own) or own[p].colset == cell.net.places[p].colset
        )
        more = memory_of_numbers(partition.net, cell.net)
        return Limited(plan, made, Generated(), known, more)

    def judged(self, whole: Exploration, counts: Counter[str]) -> Iterator[str]:
        """What is wrong."""
        found = self._explored(self.made.counts)
        if whole.error is not None:
            return
        if found is None or not found.complete:
            counts["limits are no help"] += 1
            return
        counts["cells with limits"] += 1
        counts["states with limits"] += found.nodes
        yield from (f"limits: {x}" for x in self._differences(found, whole))
        if whole.nodes <= MOST_COMPARED:
            counts["markings that have a state"] += whole.nodes
            yield from self.missing()

    def shown(self, whole: Exploration) -> set[str]:
        """Wrong limits that are noticed."""
        names = set()
        for name, wrong in WRONG_LIMITS.items():
            if whole.error is None and whole.nodes <= MOST_COMPARED:
                names |= {name} if any(self.missing(wrong(self.made.counts))) else set()
        return names

    def missing(self, wrong: Counts | None = None) -> Iterator[str]:
        """Steps of the cell that are none of the states, with other limits if these are given."""
        limits = wrong or self.made.counts
        with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
            markings, states = Path(name) / "markings", Path(name) / "states"
            whole = self._explored(None, markings)
            found = self._explored(limits, states)
            if whole is None or not whole.complete:
                return
            if found is None or found.error is not None:
                yield "limits: an exception"
                return
            if not found.complete:
                return
            names = {self.made.running.net.places[x.place].name: x for x in limits.limits}
            steps = _steps(states, {})
            lacking = _steps(markings, names) - steps
            yield from sorted(f"limits: {step} is no step of the states" for step in lacking)[:3]

    def _explored(self, limits: Counts | None, graph: Path | None = None) -> Exploration | None:
        """In turns; or, where the graph is wanted, without, and without limits if there are none."""
        made = self.made
        table = made.turns if graph is None else (None if limits is None else everyone(made.turns))
        options = ExploreOptions(
            turns=table,
            counts=limits,
            generated=self.program,
            sizes=made.sizes,
            questions=questions(made, self.plan, made.ranking.rising()),
            graph=graph,
            quick=True,
        )
        most = Limits(max_states=MOST, threads=1, traces=0)
        return explore(made.running.net, self.plan.storage, most, Diagnostics(), options)

    def _differences(self, found: Exploration, whole: Exploration) -> Iterator[str]:
        """`whole`: of the same net, with the answers to `control_questions.of_cell`."""
        if found.error is not None:
            yield "an exception"
            return
        if not found.complete:
            return
        limited = {x.place for x in self.made.counts.limits}
        is_fine = all(row["answer"] == "yes" for row in found.answers[1:])
        is_said = all(row["answer"] == "yes" for row in whole.answers[:_FIRST])
        if is_fine and not is_said:
            yield f"they say that all is well: {[row['answer'] for row in whole.answers]}"
        if any(row["answer"] == "no" for row in whole.answers[2:_FIRST]):
            return  # it goes round: nothing is kept
        for t, (mine, its) in enumerate(zip(found.fired, whole.fired, strict=True)):
            if its and not mine:
                yield f"transition {t} occurs"
        for p, (a, b) in enumerate(zip(found.bounds or (), whole.bounds or (), strict=True)):
            if p in self.known - limited and (a.upper < b.upper or a.lower > b.lower):
                yield f"place {p} holds {b.lower} to {b.upper}, not {a.lower} to {a.upper}"
        if whole.dead_count and not found.dead_count:
            yield "there are dead markings"
        mine, its = with_memory(found.arena, self.more_memory) or {}, whole.arena or {}
        if any(mine.get(part, 0) < size for part, size in its.items()):
            yield f"firings need memory: {its}, not {mine}"


def everyone(table: Turns) -> Turns:
    """A table in which everybody comes with everybody: nothing is left for later."""
    everything = tuple(range(len(table.members)))
    return replace(table, members=tuple(replace(m, rivals=everything) for m in table.members))


def _steps(graph: Path, limits: dict[str, Limit]) -> set[tuple[str, str, str]]:
    """The steps of a graph, with tokens counted up to limits: by name of the place."""
    state: dict[int, str] = {}
    found: set[tuple[str, str, str]] = set()
    rows: list[dict[str, Any]] = [
        json.loads(x) for x in graph.read_text(encoding="utf-8").splitlines()
    ]
    for row in rows:
        if "node" in row:
            held = {p: _limited(own, limits.get(p)) for p, own in row["marking"].items()}
            state[row["node"]] = json.dumps(held, sort_keys=True)
    for row in rows:
        if "from" in row:
            found.add((state[row["from"]], row["transition"], state[row["to"]]))
    return found


def _limited(held: list[list[Any]], limit: Limit | None) -> list[list[Any]]:
    if limit is None:
        return sorted(held, key=repr)
    if limit.is_value:
        return [[n, min(value, limit.most)] for n, value in held]
    return sorted(([min(n, limit.most), v] for n, v in held if limit.most > 0), key=repr)


_FIRST = 6
"""Answers of `control_questions.of_cell`: about the end, scripts that stop, and runs that go on for ever."""
