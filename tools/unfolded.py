"""`python -m tools.unfolded --nets 500`: what the unfolded net tells of random nets, next to all of their markings.

Sizes, dead markings, dead transitions, bounds, and the answers to random properties (with their runs) are compared with
what an independent judge finds in the whole graph (`pn2code.properties.judge`). Nets are made from the numbers
`--seed`, `--seed` + 1, ...; what differs is printed with its number as it is found. Exit code 1 if anything differs.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from helpers import netbuilder
from helpers.unfoldable_nets import properties_of, unfoldable_net
from helpers.unfolded_compared import differences
from pn2code.diagnostics import Diagnostics
from pn2code.properties.judge import TooManyNodesError
from pn2code.semantics.game.errors import GameError
from pn2code.verdict.asked import gather
from pn2code.verdict.opened import read
from pn2code.verdict.unfolded.askable import why_not

PROPERTIES = 6
MOST_NODES = 1_500


def main() -> int:
    """All nets."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--nets", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=10.0, help="for a net")
    wanted = parser.parse_args()
    seen: Counter[str] = Counter()
    wrong = 0
    for seed in range(wanted.seed, wanted.seed + wanted.nets):
        r = random.Random(seed)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            path = netbuilder.write(unfoldable_net(r), folder / "net.cpn")
            opened = read(path, {}, Diagnostics())
            if opened is None or why_not(opened.flat):
                seen["not asked"] += 1
                continue
            texts = properties_of(r, opened.flat, PROPERTIES)
            asked = gather(opened, texts, None, Diagnostics(), found=False)
            try:
                for what in differences(
                    opened, asked, folder, seen, most=MOST_NODES, seconds=wanted.seconds
                ):
                    wrong += 1
                    print(f"{seed}: {what}", flush=True)
            except TooManyNodesError:
                seen["too large"] += 1
            except GameError:
                seen["raises"] += 1
    print(", ".join(f"{what} {count}" for what, count in sorted(seen.items())))
    print(f"{wrong} differ")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
