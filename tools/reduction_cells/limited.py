"""What tokens that are counted up to a limit say of a cell, held against all of its states."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller.by_counts import Abstract, abstract, questions
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.exploring.counts import Counts
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated
from pn2code.verify.exploring.result import Exploration

MOST = 100_000
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

    @staticmethod
    def of(partition: Partition, plan: Plan) -> Limited | None:
        """Of a cell; None: no place gets a limit."""
        made = abstract(partition, plan, least=LEAST)
        return None if made is None else Limited(plan, made, Generated())

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

    def shown(self, whole: Exploration) -> set[str]:
        """Wrong limits that are noticed."""
        names = set()
        for name, wrong in WRONG_LIMITS.items():
            found = self._explored(wrong(self.made.counts))
            if whole.error is None and (found is None or any(self._differences(found, whole))):
                names.add(name)
        return names

    def _explored(self, limits: Counts) -> Exploration | None:
        made = self.made
        options = ExploreOptions(
            turns=made.turns,
            counts=limits,
            generated=self.program,
            sizes=made.sizes,
            questions=questions(made, self.plan, made.ranking.rising()),
            quick=True,
        )
        most = Limits(max_states=MOST, threads=1, traces=0)
        return explore(made.running.net, self.plan.storage, most, Diagnostics(), options)

    def _differences(self, found: Exploration, whole: Exploration) -> Iterator[str]:
        """`whole`: of the same net, with the answers to `control.of_cell`."""
        if found.error is not None:
            yield "an exception"
            return
        if not found.complete:
            return
        limited = {x.place for x in self.made.counts.limits}
        is_fine = all(row["answer"] == "yes" for row in found.answers)
        is_said = all(row["answer"] == "yes" for row in whole.answers[:_FIRST])
        if is_fine and not is_said:
            yield f"they say that all is well: {[row['answer'] for row in whole.answers]}"
        if any(row["answer"] == "no" for row in whole.answers[2:_FIRST]):
            return  # it goes round: nothing is kept
        for t, (mine, its) in enumerate(zip(found.fired, whole.fired, strict=True)):
            if its and not mine:
                yield f"transition {t} occurs"
        for p, (a, b) in enumerate(zip(found.bounds or (), whole.bounds or (), strict=True)):
            if p not in limited and (a.upper < b.upper or a.lower > b.lower):
                yield f"place {p} holds {b.lower} to {b.upper}, not {a.lower} to {a.upper}"
        if whole.dead_count and not found.dead_count:
            yield "there are dead markings"


_FIRST = 6
"""Answers of `control.of_cell`: about the end, scripts that stop, and runs that go on for ever."""
