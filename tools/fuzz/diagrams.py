"""`./dev fuzz --diagrams N`: decision diagrams under the sanitizers, next to the whole graphs of random nets.

    python -m tools.fuzz.diagrams [--diagrams 2000] [--seed 0]

Compared are the numbers of markings and arcs, bounds, dead markings, reachability and formulas of CTL. `--seed` is the
number of the first net; a net whose graph is too large is left out, and counts as none. Exit code 1 if one differs.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from itertools import count
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.diagram_cases import case, difference, questions, sanitized_engine


def main() -> int:
    """Compare; 1 when a net differs."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.diagrams", description=__doc__)
    parser.add_argument("--diagrams", type=int, default=2000, help="nets")
    parser.add_argument("--seed", type=int, default=0, help="of the first one")
    options = parser.parse_args()
    compared, differ = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        program = sanitized_engine(Path(folder))
        for seed in count(options.seed):
            if compared == options.diagrams:
                break
            made = case(seed)
            if made is None:
                continue
            compared += 1
            said = difference(program, made, *questions(made))
            if said:
                differ += 1
                print(f"net {seed}: {said}\n{made.tables} {made.order}", flush=True)
    print(f"diagrams: {compared} nets compared, {differ} differ")
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main())
