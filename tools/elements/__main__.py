"""`./dev elements`: each element of the examples' nets changed or removed, one at a time.

The change must show: `check` or `generate` refuses the net or says something else, or the program of whoever it
concerns is another one (of a robot's page: its script; the supervisor's C is not enough). Prints those that show
nowhere, and a table; exit code 1 if there is one that is not known to be without effect.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.elements.changes import changes
from tools.elements.judge import Judge

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(p.parent.name for p in (ROOT / "examples").glob("*/cell.toml"))
WHERE = ("refused", "program", "drawing", "check", "nowhere")


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="./dev elements", description=__doc__)
    parser.add_argument("--cells", nargs="*", default=EXAMPLES, help="names; default: all examples")
    parser.add_argument(
        "--most", type=int, help="at most so many of each cell, drawn with a fixed seed"
    )
    parser.add_argument("-v", "--verbose", action="store_true", help="print every change")
    options = parser.parse_args()
    count: Counter[tuple[str, str]] = Counter()
    with tempfile.TemporaryDirectory(prefix="pn2code-") as room:
        for cell in options.cells:
            judge = Judge(ROOT / "examples" / cell, Path(room) / cell)
            found = list(changes(judge.data))
            if options.most is not None and len(found) > options.most:
                random.Random(cell).shuffle(found)
                found = found[: options.most]
            for change in found:
                shown = judge.shown(change)
                count[cell, shown.where] += 1
                if options.verbose or shown.where == "nowhere":
                    print(f"{cell}: {change.what}: {shown.where} ({shown.detail})", flush=True)
    print(f"\n| cell | {' | '.join(WHERE)} |\n|---{'|---' * len(WHERE)}|")
    for cell in options.cells:
        print(f"| {cell} | {' | '.join(str(count[cell, w]) for w in WHERE)} |")
    return 1 if any(count[cell, "nowhere"] for cell in options.cells) else 0


if __name__ == "__main__":
    sys.exit(main())
