"""`python -m tools.combinations --cells 100 [--family shapes] [--ways 12] [--runs 4]`: all reductions and options.

Each random net or cell is asked in several ways, drawn from all combinations of reductions, limits and options. A yes
next to a no is a contradiction; so is an answer that the token game, or a run, shows to be false.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does

import pytest
from tools.combinations.bed import judge, keep
from tools.combinations.subjects import CELLS, FAMILIES, NETS
from tools.reduction_cells.__main__ import quick_compiler

ANY, ANY_CELL, ANY_NET = "any", "cells", "nets"
GROUPS = {
    ANY: FAMILIES,
    ANY_CELL: tuple(CELLS),
    ANY_NET: tuple(NETS),
}


def main() -> int:
    """Runs the campaign; what is wrong is kept."""
    parser = argparse.ArgumentParser(prog="tools.combinations", description=__doc__)
    parser.add_argument("--cells", type=int, default=100, help="how many (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the first (default: %(default)s)")
    parser.add_argument(
        "--ways", type=int, default=12, help="in which each is asked (default: %(default)s)"
    )
    parser.add_argument(
        "--runs", type=int, default=0, help="of the programs of each cell (default: %(default)s)"
    )
    parser.add_argument(
        "--family",
        choices=(*GROUPS, *FAMILIES),
        default=ANY,
        help="of which (default: any in turn)",
    )
    parser.add_argument(
        "--keep", type=Path, default=Path(".combinations"), help="where those go that are wrong"
    )
    options = parser.parse_args()
    families = GROUPS.get(options.family, (options.family,))
    count: Counter[str] = Counter()
    with quick_compiler(), pytest.MonkeyPatch.context() as changed:
        changed.setenv("CFLAGS", "-O0")  # the programs are built once for few runs
        for seed in range(options.seed, options.seed + options.cells):
            family = families[seed % len(families)]
            with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
                folder = Path(name)
                found = judge(family, seed, folder, number=options.ways, runs=options.runs)
                count.update(found.counts)
                for text in found.wrong:
                    print(f"{family} {seed}: {text}", flush=True)
                if found.wrong:
                    keep(folder, options.keep / f"{family}-{seed}", found)
            if (seed - options.seed) % 10 == 9:
                print(f"  {dict(sorted(count.items()))}", flush=True)
    for name, number in sorted(count.items()):
        print(f"  {number:9,} {name}")
    return 1 if count["wrong"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
