"""`./dev misspell`: each key and each name of the examples' cell.toml misspelt, deleted, duplicated, of a wrong type.

Each mistake must be refused (by `check` or `generate`), or be without effect: the generated files are the same, or the
same but for a name that is chosen there. A wrong type must be refused in any case. Prints those that go unnoticed, and
a table; exit code 1 if there is one.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.misspell.judge import Judge
from tests.misspell.mutants import mistakes

ROOT = Path(__file__).parents[2]
EXAMPLES = ("riveting", "sorting", "shared-zone", "timed")
RESULTS = ("refused", "no effect", "renamed", "option", "effect", "crash")


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="./dev misspell", description=__doc__)
    parser.add_argument("--cells", nargs="*", default=EXAMPLES, help="names; default: all examples")
    parser.add_argument("--only", default="", help="mistakes whose description contains this")
    parser.add_argument(
        "--most", type=int, help="at most so many of each cell, drawn with a fixed seed"
    )
    parser.add_argument("-v", "--verbose", action="store_true", help="print every verdict")
    options = parser.parse_args()
    count: Counter[tuple[str, str, str]] = Counter()
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="pn2code-") as room:
        for cell in options.cells:
            judge = Judge(ROOT / "examples" / cell, Path(room) / cell)
            found = [m for m in mistakes(judge.text) if options.only in m.what]
            if options.most is not None and len(found) > options.most:
                random.Random(cell).shuffle(found)
                found = found[: options.most]
            for mistake in found:
                verdict = judge.verdict(mistake)
                count[cell, mistake.kind, verdict.result] += 1
                wrong += verdict.is_wrong
                if verdict.is_wrong or options.verbose:
                    print(f"{cell}: {mistake.what}: {verdict.result} ({verdict.why})", flush=True)
            print(f"{cell}: {len(found)} mistakes", file=sys.stderr)
    print(f"\n| cell | mistake | {' | '.join(RESULTS)} |\n|---|---{'|---' * len(RESULTS)}|")
    for cell, kind in sorted({(c, k) for c, k, _ in count}):
        numbers = " | ".join(str(count[cell, kind, r]) for r in RESULTS)
        print(f"| {cell} | {kind} | {numbers} |")
    print(f"\n{sum(count.values())} mistakes, {wrong} unnoticed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
