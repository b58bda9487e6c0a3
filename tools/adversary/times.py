"""What `pn2code time` says of the cycles of a cell, next to its runs: a bound that a run breaks is a false answer.

python -m tools.adversary.times --cells 200 --seed 0      # in tests/; random cells
"""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

from tools.adversary import bed, waits, wander
from tools.adversary.cells import random_cell
from tools.adversary.wander import Built, Pace, Run

from pn2code.diagnostics import Diagnostics
from pn2code.timing.answers import Cycle
from pn2code.timing.look import Measured, look
from pn2code.verdict.opened import read, with_inputs
from pn2code.verify.exploring.limits import Limits

FINISHED = "finished"


def cycle_of(folder: Path, measured: list[Measured] | None = None) -> Cycle | None:
    """What is said of the cycles of a cell; None: nothing.

    Args:
        measured: gets all that was gone through.
    """
    d = Diagnostics()
    opened = read(folder, {}, d)
    if opened is None:
        return None
    seen = [] if measured is None else measured
    found = look(with_inputs(opened, d), None, Limits(), None, d, measured=seen.append)
    return found.layouts[0].cycle if found is not None and found.layouts else None


def contradictions(cycle: Cycle, runs: Iterator[tuple[Pace, Run]]) -> Iterator[str]:
    """What runs say against it."""
    said = cycle.row()
    by_place = {tuple(e["final"]): e for e in said["endings"]}
    for pace, run in runs:
        time = run.record.time
        if run.end != FINISHED:
            if pace is Pace.PLANNED and not cycle.why and not said["others"]:
                yield f"each run comes to its end, but one does not: {run.end}, {run.why}"
            continue
        if pace is Pace.PLANNED and not cycle.why:
            ending = by_place.get(tuple(sorted(run.record.final)))
            if ending is None:
                yield f"no run ends in {run.record.final}, but one does"
                continue
            if ending["least_s"] is not None and time < ending["least_s"]:
                yield f"a run takes {time}, less than {ending['least_s']}"
            if ending["most_s"] is not None and time > ending["most_s"]:
                yield f"a run takes {time}, more than {ending['most_s']}"
        least, most = said["at_least_s"], said["at_most_s"]
        if pace in (Pace.PLANNED, Pace.LATE) and least is not None and time < least:
            yield f"{pace.value}: a run takes {time}, less than {least}"
        if pace in (Pace.PLANNED, Pace.EARLY) and most is not None and time > most:
            yield f"{pace.value}: a run takes {time}, more than {most}"


def runs_of(built: Built, count: int) -> Iterator[tuple[Pace, Run]]:
    """Runs of each pace."""
    for pace in (Pace.PLANNED, Pace.LATE, Pace.EARLY):
        for seed in range(count):
            yield pace, wander.run(built, seed, pace=pace)


def judge(seed: int, folder: Path, count: int) -> tuple[list[str], Counter[str]]:
    """What is wrong of a random cell, and what was known of it."""
    bed.write(random_cell(Random(seed)), folder)
    measured: list[Measured] = []
    cycle = cycle_of(folder, measured)
    if cycle is None:
        return [], Counter(["nothing known"])
    counts: Counter[str] = Counter()
    counts[f"not known: {cycle.why[:40]}" if cycle.why else "known"] += 1
    if not cycle.why:
        counts["no upper bound" if cycle.repeats else "bounded"] += 1
        counts["a choice of times"] += any(
            e.least is not None and e.most is not None and e.most > e.least for e in cycle.endings
        )
    if not cycle.endings and cycle.at_least is None:
        return [], counts
    built = wander.prepare(folder, Diagnostics())
    if built is None:
        return [], Counter(["refused"])
    made = list(runs_of(built, count))
    counts.update(f"{pace.value} {run.end}" for pace, run in made)
    wrong = list(contradictions(cycle, iter(made)))
    return [*wrong, *waits.contradictions(measured[0], Random(seed), made)], counts


def main() -> None:
    """Judges many."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cells", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--say", action="store_true", help="what is known of each cell")
    options = parser.parse_args()
    counts: Counter[str] = Counter()
    for seed in range(options.seed, options.seed + options.cells):
        with tempfile.TemporaryDirectory() as folder:
            wrong, found = judge(seed, Path(folder), options.runs)
        counts += found
        for line in wrong:
            print(f"{seed}: {line}", flush=True)
        counts["wrong"] += bool(wrong)
        if options.say:
            print(f"{seed}: {', '.join(sorted(found))}", flush=True)
    for name, count in sorted(counts.items()):
        print(f"{count:6} {name}")


if __name__ == "__main__":
    main()
