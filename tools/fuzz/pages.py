"""`./dev fuzz --pages N`: random pages of a robot, whose scripts must do what the pages do, and nothing else.

    python -m tools.fuzz.pages [--pages 400] [--seed 0]

A case is a page with its messages (`helpers.random_pages`); its script is compared with it in all states, without a C
compiler. Many pages have no script: they are refused, which is counted.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.random_pages import difference, random_page


def main() -> int:
    """Compare many pages; 1 when one differs."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.pages", description=__doc__)
    parser.add_argument("--pages", type=int, default=400)
    parser.add_argument("--seed", type=int, default=0, help="the first case; further ones follow")
    given = parser.parse_args()
    count: Counter[str] = Counter()
    for seed in range(given.seed, given.seed + given.pages):
        page = random_page(Random(seed))
        with tempfile.TemporaryDirectory(prefix="pn2code-pages-") as folder:
            found = difference(Path(folder), page)
        count["refused" if found is None else "differ" if found else "compared"] += 1
        if found:
            print(f"pages: case {seed}:\n{page.text}\n{dict(page.messages)}\n{found}", flush=True)
    print(f"pages: {given.pages} cases: {dict(sorted(count.items()))}")
    return int(count["differ"] > 0)


if __name__ == "__main__":
    sys.exit(main())
