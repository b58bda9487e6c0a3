"""`./dev oracle --nets`: random nets, in packs, before the engine of CPN Tools and before pn2code.

    python -m tools.oracle --nets [--count 1000] [--first 0] [--size 25] [--no-space] [--no-run] [--save FOLDER]

Of each number there are two nets: one whose whole state space is compared node by node and arc by arc, its initial
marking first, and one that goes on for long, of which a random run of the engine is replayed; and the verdict of both.
Net 17 is the same every time. Nets that differ are saved with what the engine said; exit code 1 then.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tools.oracle.chosen import chosen
from tools.oracle.packs import RUN, SPACE, asked
from tools.oracle.totals import Totals


def main(arguments: Sequence[str]) -> int:
    """The exit code: 0 when nothing differs."""
    parser = argparse.ArgumentParser(prog="oracle --nets", description=__doc__)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--size", type=int, default=25, help="of the packs")
    parser.add_argument("--no-space", action="store_true", help="runs only")
    parser.add_argument("--no-run", action="store_true", help="state spaces only")
    parser.add_argument("--save", type=Path)
    a = parser.parse_args(arguments)
    totals = Totals(a.save)
    numbers = range(a.first, a.first + a.count)
    with tempfile.TemporaryDirectory() as folder:
        for at in range(0, a.count, a.size):
            nets = {n: chosen(n) for n in numbers[at : at + a.size]}
            for kind, which in ((SPACE, 0), (RUN, 1)):
                if (a.no_space, a.no_run)[which]:
                    continue
                texts = {n: both[which] for n, both in nets.items()}
                for result in asked(kind, texts, Path(folder)):
                    for n in result.numbers:
                        totals.add(f"{kind.name}{n}", result.path, result.found, [result.said])
            print(f"after net {max(nets)}: {'; '.join(totals.lines())}", flush=True)
    return totals.report()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
