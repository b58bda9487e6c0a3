"""What is said of a closed net whose tokens are counted up to a limit, held against all of its markings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.properties.questions import ENDLESS, Questions
from pn2code.verdict.opened import OpenNet
from pn2code.verify.exploring import net_by_counts
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits

MOST = 40_000


def judged(opened: OpenNet, partition: Partition, counts: Counter[str]) -> Iterator[str]:
    """What is wrong."""
    limits = Limits(max_states=MOST, threads=1, traces=0)
    options = ExploreOptions(quick=True)
    known = net_by_counts.look(opened.flat, opened.storage, limits, options, partition.final_places)
    if known is None:
        counts["closed nets not counted"] += 1
        return
    whole = explore(
        opened.flat,
        opened.storage,
        limits,
        Diagnostics(),
        ExploreOptions(quick=True, questions=_questions(partition)),
    )
    if whole is None or not whole.complete:
        counts["closed nets too large"] += 1
        return
    counts["closed nets counted"] += 1
    if whole.error is not None:
        yield f"closed net: an exception: {whole.error}"
        return
    ends, restless = (row["answer"] for row in whole.answers)
    if known.ends and ends != "yes":
        yield "closed net: a dead marking is no end"
    if restless != "yes":
        yield "closed net: a run goes on for ever"
    wrong = set(known.never) - set(whole.dead_transitions())
    if wrong:
        yield f"closed net: transitions {sorted(wrong)} occur"


def _questions(partition: Partition) -> str:
    asked = Questions()
    lines = [f"owner {t.index} {t.index}" for t in partition.net.transitions]
    lines += ["priorities own", *(f"instant 0 {t.index}" for t in partition.net.transitions)]
    found = asked.line(f"not {asked.line('dead')}")
    for place in sorted(partition.final_places):
        found = asked.line(f"or {found} {asked.line(f'within {place} 1 -')}")
    asked.asked += [f"? invariant {found}", f"? restless 0 {ENDLESS}"]
    return "".join(f"{line}\n" for line in lines) + asked.text()
