"""`python -m tools.reduction_cells --cells 100 --seed 1 [--mutants]`: what turns keep, on random cells."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does

from tools.reduction_cells.bed import judge
from tools.reduction_cells.files import ANY, FORGETFUL
from tools.reduction_cells.limited import WRONG_LIMITS
from tools.reduction_cells.mutants import MUTANTS, NO_GROUPS, RASH


def main() -> int:
    """Runs the campaign."""
    parser = argparse.ArgumentParser(prog="tools.reduction_cells", description=__doc__)
    parser.add_argument("--cells", type=int, default=500, help="how many (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the first (default: %(default)s)")
    parser.add_argument("--mutants", action="store_true", help="wrong versions must be noticed")
    parser.add_argument(
        "--medium", type=int, default=4, help="of so many cells that of one (default: %(default)s)"
    )
    options = parser.parse_args()
    counts: Counter[str] = Counter()
    shown: Counter[str] = Counter()
    for seed in range(options.seed, options.seed + options.cells):
        with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
            wants_medium = seed % options.medium == 0
            verdict = judge(seed, Path(folder), mutants=options.mutants, wants_medium=wants_medium)
        counts.update(verdict.counts)
        shown.update(verdict.shown)
        counts["wrong"] += bool(verdict.wrong)
        for text in verdict.wrong:
            print(f"cell {seed}: {text}", flush=True)
        if (seed - options.seed) % 10 == 9:
            print(f"  {seed - options.seed + 1}: {dict(sorted(counts.items()))}", flush=True)
            if options.mutants:
                print(f"  mutants shown: {dict(sorted(shown.items()))}", flush=True)
    print(f"{options.cells} cells: {dict(sorted(counts.items()))}")
    names = (*MUTANTS, *WRONG_LIMITS)
    missed = [name for name in names if not shown[name]] if options.mutants else []
    for name in (NO_GROUPS, RASH, *FORGETFUL, ANY) if options.mutants else ():
        print(f"{name}: noticed in {shown[name]} cells")  # it takes rare cells
    for name in missed:
        print(f"not noticed: {name}")
    return 1 if counts["wrong"] or missed else 0


if __name__ == "__main__":
    raise SystemExit(main())
