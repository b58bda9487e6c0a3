"""`python -m tools.reduction_cells --cells 100 [--mutants] [--record FILE]`: what reductions keep, on random cells.

With `--record` each cell is written down when it is done; the same command goes on where it has ended, and the counts
are those of all cells in the file.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does

import pytest
from tools.reduction_cells.asked import WRONG_PROPERTIES
from tools.reduction_cells.bed import MADE, Verdict, judge
from tools.reduction_cells.files import ANY, FORGETFUL
from tools.reduction_cells.limited import WRONG_LIMITS
from tools.reduction_cells.mutants import MUTANTS, NO_GROUPS, RASH

from helpers import delivered_runtime, tiny_compiler
from helpers.compiled import DELIVERED
from pn2code.toolchain import programs

FAMILIES = ("any", *MADE, "mixed")
IN_TURN = ("mixed", "shops", "stations", "mixed", "shops", "peers")
"""Of seeds one after the other."""


def main() -> int:
    """Runs the campaign."""
    parser = argparse.ArgumentParser(prog="tools.reduction_cells", description=__doc__)
    parser.add_argument("--cells", type=int, default=500, help="how many (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the first (default: %(default)s)")
    parser.add_argument("--mutants", action="store_true", help="wrong versions must be noticed")
    parser.add_argument(
        "--medium", type=int, default=4, help="of so many cells that of one (default: %(default)s)"
    )
    parser.add_argument(
        "--family", choices=FAMILIES, default="any", help="of which cells (default: %(default)s)"
    )
    parser.add_argument(
        "--verdicts", action="store_true", help="compare verdicts only, not the spaces as well"
    )
    parser.add_argument("--record", type=Path, help="where what is done is written down")
    parser.add_argument("--seconds", type=float, help="no further cell is begun after that")
    options = parser.parse_args()
    done = dict(_recorded(options.record))
    began = time.monotonic()
    with quick_compiler():
        for seed in range(options.seed, options.seed + options.cells):
            if options.seconds is not None and time.monotonic() - began > options.seconds:
                break
            if seed in done:
                continue
            family = options.family
            if family == "any":
                family = IN_TURN[seed % len(IN_TURN)]
            with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
                done[seed] = judge(
                    seed,
                    Path(folder),
                    mutants=options.mutants,
                    wants_medium=seed % options.medium == 0,
                    family=family,
                    only_verdicts=options.verdicts,
                )
            for text in done[seed].wrong:
                print(f"cell {seed}: {text}", flush=True)
            _record(options.record, seed, done[seed])
    return summary(list(done.values()), mutants=options.mutants)


def summary(verdicts: list[Verdict], *, mutants: bool) -> int:
    """Prints what came of all; the exit code."""
    counts: Counter[str] = Counter()
    shown: Counter[str] = Counter()
    for verdict in verdicts:
        counts.update(verdict.counts)
        shown.update(verdict.shown)
        counts["wrong"] += bool(verdict.wrong)
    print(f"{len(verdicts)} cells")
    for name, count in sorted(counts.items()):
        print(f"  {count:9,} {name}")
    names = (*MUTANTS, *WRONG_LIMITS)
    missed = [name for name in names if not shown[name]] if mutants else []
    for name in (*names, NO_GROUPS, RASH, *WRONG_PROPERTIES, *FORGETFUL, ANY) if mutants else ():
        print(f"  {shown[name]:9,} notice: {name}")  # some take rare cells
    for name in missed:
        print(f"not noticed: {name}")
    return 1 if counts["wrong"] or missed else 0


@contextmanager
def quick_compiler() -> Iterator[None]:
    """Nets are compiled without optimization, as in the tests: the answers are the same."""
    with pytest.MonkeyPatch.context() as changed:
        flags = tuple("-O0" if flag == "-O2" else flag for flag in DELIVERED)
        changed.setattr(programs, "FLAGS", (*flags, *tiny_compiler.use(changed)))
        delivered_runtime.use(changed)
        yield


def _recorded(path: Path | None) -> Iterator[tuple[int, Verdict]]:
    if path is None or not path.exists():
        return
    for line in path.read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        verdict = Verdict(tuple(row["wrong"]), frozenset(row["shown"]), Counter(row["counts"]))
        yield row["seed"], verdict


def _record(path: Path | None, seed: int, verdict: Verdict) -> None:
    if path is None:
        return
    row = {
        "seed": seed,
        "wrong": verdict.wrong,
        "shown": sorted(verdict.shown),
        "counts": dict(verdict.counts),
    }
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")


if __name__ == "__main__":
    raise SystemExit(main())
