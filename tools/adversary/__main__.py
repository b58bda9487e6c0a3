"""`python -m tools.adversary --cells 100 --seed 1`: random cells, verified, then run many times."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path

from tools.adversary.bed import judge


def main() -> int:
    """Runs the campaign; the cells that contradict what was said of them are kept."""
    parser = argparse.ArgumentParser(prog="tools.adversary", description=__doc__)
    parser.add_argument("--cells", type=int, default=1000, help="how many (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the first (default: %(default)s)")
    parser.add_argument("--runs", type=int, default=12, help="of each cell (default: %(default)s)")
    parser.add_argument(
        "--keep", type=Path, default=Path(".adversary"), help="where those go that are wrong"
    )
    options = parser.parse_args()
    count: Counter[str] = Counter()
    for seed in range(options.seed, options.seed + options.cells):
        with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
            verdict = judge(seed, Path(folder), options.runs)
        count.update(verdict.counts)
        for text in verdict.wrong:
            print(f"cell {seed}: {text}", flush=True)
        if verdict.wrong:
            verdict.keep(options.keep / str(seed))
        if (seed - options.seed) % 10 == 9:
            print(f"  {seed - options.seed + 1} cells: {dict(sorted(count.items()))}", flush=True)
    print(f"{options.cells} cells: {dict(sorted(count.items()))}")
    return 1 if count["wrong"] else 0


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
    raise SystemExit(main())
