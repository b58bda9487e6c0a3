"""What the cell as it runs says of its files, held against all states of the cell with its medium.

* Where it says that they do no harm, they do none: all states with the medium have to say so, too.
* What occurs in the cell as it runs occurs with its medium, and the other way round, where no script waits for one of
  several messages.
* `FORGETFUL`: versions in which a condition is missing; in some cells they say so although it is not so.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.channel_model import by_cell
from pn2code.channel_model import check as medium
from pn2code.channel_model.compose import compose
from pn2code.channel_model.places import Crashes
from pn2code.channel_model.rules import Rules
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits

MOST = 40_000
Question = Callable[[str], bool]
FORGETFUL: Mapping[str, Question] = {
    "a channel may hold two messages": lambda line: line.endswith(" 0 1"),
    "a run may go on for ever": lambda line: line.startswith("? restless"),
    "the end may be no end": lambda line: line.startswith("? invariant"),
}
"""By name, the questions that are not asked."""
ANY = "programs may send and wait as they like"
"""What is against it in the net is not looked at."""


def judged(
    partition: Partition, storage: Mapping[str, str], counts: Counter[str], shown: set[str] | None
) -> Iterator[str]:
    """What is wrong; `shown` gets the names of `FORGETFUL` that are noticed, if they are tried."""
    limits = Limits(max_states=MOST, threads=1, traces=0, turns_from=None)
    options = ExploreOptions(quick=True)
    found = by_cell.shown(partition, Rules(), storage, limits, options)
    if found is None and shown is None:
        counts["files not of the cell"] += 1
        return
    run = medium.Run(limits, Diagnostics(), options)
    whole = medium.whole(partition, storage, run, Rules())
    counts[f"files: {whole.answer}{' of the cell as well' * (found is not None)}"] += 1
    if whole.answer == "yes":
        yield from _unlike(partition, storage, limits, options, counts)
    if found is not None and whole.answer == "no":
        yield f"the files of the cell: {whole.why} {[e.lines[-1] for e in whole.evidence]}"
    if shown is not None and whole.answer == "no":
        shown.update(_noticed(partition, storage, limits, options))


def _unlike(
    partition: Partition,
    storage: Mapping[str, str],
    limits: Limits,
    options: ExploreOptions,
    counts: Counter[str],
) -> Iterator[str]:
    """Transitions that occur in the cell as it runs, and never with its medium, or only there."""
    running = Running.of(partition)
    if running.meek:
        return
    lines = "".join(f"{x}\n" for x in running.lines(first=True))
    own = replace(options, questions=lines)
    mine = explore(running.net, storage, limits, Diagnostics(), own)
    made = compose(partition, Rules(), Crashes(life_cycle=False))
    own = replace(options, questions=medium._choices(partition))
    its = explore(made.net, storage, limits, Diagnostics(), own)
    if mine is None or its is None or not (mine.complete and its.complete):
        return
    counts["cells of which what occurs is compared with the medium"] += 1
    for t, _ in enumerate(partition.transition_owner):
        if bool(mine.fired[t]) is not bool(its.fired[t]):
            where = "only without" if mine.fired[t] else "only with"
            yield f"`{partition.net.transitions[t].name}` occurs {where} the medium"


def _noticed(
    partition: Partition, storage: Mapping[str, Any], limits: Limits, options: ExploreOptions
) -> Iterator[str]:
    if by_cell.why_not(partition, Rules()):
        if by_cell.looked(partition, storage, limits, options) is not None:
            yield ANY
        return
    rows = by_cell.rows(partition, storage, limits, options)
    for name, is_left_out in FORGETFUL.items():
        if rows and all(is_left_out(line) or answer == "yes" for line, answer in rows):
            yield name
