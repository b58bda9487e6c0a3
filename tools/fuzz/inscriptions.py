"""`./dev fuzz --inscriptions N`: random CPN ML over the whole library on arcs, in guards, delays and code segments.

    python -m tools.fuzz.inscriptions [--inscriptions 400] [--seed 0] [--sanitize] [--save FOLDER]

Twenty cases are one net (`helpers.random_inscriptions`); `--seed` is the number of the first net. Each case must
compile without a warning and do what the token game does, in walks and, as a net of a union, in the explorer with
all of its graph. What fails is saved alone.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.compiled import QUICK, SANITIZERS, Workshop
from helpers.declarations import culprits
from helpers.explored import Explorers
from helpers.random_inscriptions import Inscriptions
from helpers.unions import Outcome, check

ROOT = Path(__file__).resolve().parents[2]
SIZE = 20


def main() -> int:
    """Compare many cases; 1 when one fails."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.inscriptions", description=__doc__)
    parser.add_argument("--inscriptions", type=int, default=400)
    parser.add_argument("--seed", type=int, default=0, help="the first net; further ones follow")
    parser.add_argument("--sanitize", action="store_true", help="compile with sanitizers")
    parser.add_argument("--save", type=Path, default=ROOT / ".fuzz", help="where failures go")
    given = parser.parse_args()
    failures, graphs = 0, Outcome()
    with tempfile.TemporaryDirectory(prefix="pn2code-inscriptions-") as name:
        folder = Path(name)
        flags = SANITIZERS if given.sanitize else QUICK
        workshop = Workshop.open(folder, flags)
        explorers = Explorers.open(folder / "explorers", flags)
        made = Inscriptions(folder)
        nets = (given.inscriptions + SIZE - 1) // SIZE
        for number in range(given.seed, given.seed + nets):
            one = made.sheet(number, SIZE)
            for case, why in culprits(one, workshop).items():
                failures += 1
                text = one.text(case) if case >= 0 else one.text()
                given.save.mkdir(parents=True, exist_ok=True)
                path = given.save / f"inscription{number if case < 0 else case}.txt"
                path.write_text(f"{text}\n\n# {why}\n")
                what = f"case {case}" if case >= 0 else f"net {number}"
                print(f"inscriptions: {what}: {why[:1500]}\n  saved as {path}", flush=True)
            try:
                graphs.add(check(explorers, made.union(number, SIZE)))
            except AssertionError as difference:
                failures += 1
                print(f"inscriptions: net {number} in the explorer: {difference}", flush=True)
    print(f"inscriptions: {nets * SIZE} cases; {graphs}; {failures} failed")
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
