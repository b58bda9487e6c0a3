"""`./dev fuzz --scripts N`: CPN ML that raises exceptions, on pages of robots: their scripts must do the same.

    python -m tools.fuzz.scripts [--scripts 400] [--seed 0]

A case is an expression at one place of a page (`helpers.script_forms`), compared for all values of its variables.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.script_forms import SITES, difference, random_form


def main() -> int:
    """Compare many cases; 1 when one fails."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.scripts", description=__doc__)
    parser.add_argument("--scripts", type=int, default=400)
    parser.add_argument("--seed", type=int, default=0, help="the first case; further ones follow")
    given = parser.parse_args()
    failures = 0
    for seed in range(given.seed, given.seed + given.scripts):
        random = Random(seed)
        site, form = random.choice(SITES), random_form(random, random.choice([2, 3, 4]))
        with tempfile.TemporaryDirectory(prefix="pn2code-scripts-") as folder:
            found = difference(Path(folder), site, form)
        if found:
            failures += 1
            print(f"scripts: case {seed}, {site}: {form}\n{found}", flush=True)
    print(f"scripts: {given.scripts} cases; {failures} failed")
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
