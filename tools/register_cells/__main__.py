"""`python -m tools.register_cells --cells 300`: random cells with registers, asked in several ways, and run."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does

import pytest
from tools.reduction_cells.__main__ import quick_compiler
from tools.register_cells.bed import judge


def main() -> int:
    """Runs the campaign; the cells of which something is wrong are kept."""
    parser = argparse.ArgumentParser(prog="tools.register_cells", description=__doc__)
    parser.add_argument("--cells", type=int, default=300, help="how many (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the first (default: %(default)s)")
    parser.add_argument("--runs", type=int, default=40, help="of each cell (default: %(default)s)")
    parser.add_argument(
        "--keep", type=Path, default=Path(".registers"), help="where those go that are wrong"
    )
    options = parser.parse_args()
    count: Counter[str] = Counter()
    with quick_compiler(), pytest.MonkeyPatch.context() as changed:
        changed.setenv("CFLAGS", "-O0")  # the programs are built once for few runs
        for seed in range(options.seed, options.seed + options.cells):
            with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
                verdict = judge(seed, Path(folder), options.runs)
            count.update(verdict.counts)
            for text in verdict.wrong:
                print(f"cell {seed}: {text}", flush=True)
            if verdict.wrong:
                verdict.keep(options.keep / str(seed))
            if (seed - options.seed) % 10 == 9:
                print(f"  {dict(sorted(count.items()))}", flush=True)
    for name, number in sorted(count.items()):
        print(f"  {number:9,} {name}")
    return 1 if count["wrong"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
