"""`./dev fuzz --expressions N`: random CPN ML over the whole library, in compiled code and in the reference evaluator.

    python -m tools.fuzz.expressions [--expressions 20000] [--seed 1] [--sanitize]

Forty expressions are compiled together (`helpers.compiled_expressions`); `--seed` decides all of them.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.compiled import QUICK, SANITIZERS, Workshop
from helpers.compiled_expressions import PER_NET, Expressions, differing

AT_ONCE = 50
"""Nets after which the declarations are made anew: they only grow."""


def main() -> int:
    """Compare many expressions; 1 when one differs."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.expressions", description=__doc__)
    parser.add_argument("--expressions", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sanitize", action="store_true", help="compile with sanitizers")
    given = parser.parse_args()
    done = failures = full = 0
    with tempfile.TemporaryDirectory(prefix="pn2code-expressions-") as name:
        folder = Path(name)
        workshop = Workshop.open(folder, SANITIZERS if given.sanitize else QUICK)
        made = Expressions(given.seed, folder)
        while done < given.expressions:
            if done and done % (AT_ONCE * PER_NET) == 0:
                made = Expressions(given.seed + done, folder)
            some = made.some(PER_NET)
            for one, said in differing(made, some, workshop):
                failures += 1
                print(
                    f"expressions: {one.text}\n  evaluated {one.expected[:600]}\n  compiled  {said[:1500]}",
                    flush=True,
                )
            done += len(some)
            full, made.full = full + made.full, 0
    print(f"expressions: {done}, {full} without enough memory, {failures} differ")
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
