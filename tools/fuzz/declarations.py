"""`./dev fuzz --declarations N`: every type at every position, in random declarations and inscriptions.

    python -m tools.fuzz.declarations [--declarations 1815] [--seed 0] [--save FOLDER]

Each case must be accepted, compile without a warning (with the sanitizers, and optimized), and do what the token game
does. Sixty cases are one net; `--seed` is the number of the first net. What fails is saved alone.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.declarations import culprits, workshops
from helpers.random_declarations import CASES, sheet

ROOT = Path(__file__).resolve().parents[2]
SIZE = 60


def main() -> int:
    """Compare many cases; 1 when one fails."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.declarations", description=__doc__)
    parser.add_argument("--declarations", type=int, default=CASES)
    parser.add_argument("--seed", type=int, default=0, help="the first net; further ones follow")
    parser.add_argument("--save", type=Path, default=ROOT / ".fuzz", help="where failures go")
    given = parser.parse_args()
    failures = 0
    with tempfile.TemporaryDirectory(prefix="pn2code-declarations-") as folder:
        shops = workshops(Path(folder))
        nets = (given.declarations + SIZE - 1) // SIZE
        for number in range(given.seed, given.seed + nets):
            one = sheet(number, SIZE)
            about = {c.number: c.about for c in one.cases}
            for case, why in culprits(one, shops[number % len(shops)]).items():
                failures += 1
                text = one.text(case) if case >= 0 else one.text()
                given.save.mkdir(parents=True, exist_ok=True)
                path = given.save / f"declaration{number if case < 0 else case}.txt"
                path.write_text(f"{text}\n\n# {why}\n")
                what = about.get(case, f"net {number}")
                print(
                    f"declarations: case {case} ({what}): {why[:600]}\n  saved as {path}",
                    flush=True,
                )
    print(f"declarations: {nets * SIZE} cases, {failures} failed")
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
