"""`./dev misspell`: each key and each name of the examples' cell.toml misspelt, deleted, duplicated, of a wrong type;
and of the files beside it: properties, inputs, what sensors say.

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
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.misspell.beside import beside, verdict
from tools.misspell.judge import Judge, Verdict
from tools.misspell.mutants import mistakes

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(p.parent.name for p in (ROOT / "examples").glob("*/cell.toml"))
RESULTS = ("refused", "no effect", "renamed", "option", "effect", "crash")


@dataclass(frozen=True, slots=True)
class Asked:
    """A mistake in any file of a cell, and how its verdict is had."""

    what: str
    kind: str
    verdict: Callable[[], Verdict]


def all_of(judge: Judge, only_beside: bool) -> Iterator[Asked]:
    """Those in cell.toml, then those in the files beside it."""
    for m in () if only_beside else mistakes(judge.text):
        yield Asked(m.what, m.kind, partial(judge.verdict, m))
    for file, m in beside(judge.room):
        yield Asked(f"{file.name}: {m.what}", m.kind, partial(verdict, judge, file, m))


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="./dev misspell", description=__doc__)
    parser.add_argument("--cells", nargs="*", default=EXAMPLES, help="names; default: all examples")
    parser.add_argument("--only", default="", help="mistakes whose description contains this")
    parser.add_argument(
        "--most", type=int, help="at most so many of each cell, drawn with a fixed seed"
    )
    parser.add_argument("--beside", action="store_true", help="only the files beside cell.toml")
    parser.add_argument("-v", "--verbose", action="store_true", help="print every verdict")
    options = parser.parse_args()
    count: Counter[tuple[str, str, str]] = Counter()
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="pn2code-") as room:
        for cell in options.cells:
            judge = Judge(ROOT / "examples" / cell, Path(room) / cell)
            found = list(all_of(judge, options.beside))
            found = [each for each in found if options.only in each.what]
            if options.most is not None and len(found) > options.most:
                random.Random(cell).shuffle(found)
                found = found[: options.most]
            for each in found:
                found_out = each.verdict()
                count[cell, each.kind, found_out.result] += 1
                wrong += found_out.is_wrong
                if found_out.is_wrong or options.verbose:
                    print(f"{cell}: {each.what}: {found_out.result} ({found_out.why})", flush=True)
            print(f"{cell}: {len(found)} mistakes", file=sys.stderr)
    print(f"\n| cell | mistake | {' | '.join(RESULTS)} |\n|---|---{'|---' * len(RESULTS)}|")
    for cell, kind in sorted({(c, k) for c, k, _ in count}):
        numbers = " | ".join(str(count[cell, kind, r]) for r in RESULTS)
        print(f"| {cell} | {kind} | {numbers} |")
    print(f"\n{sum(count.values())} mistakes, {wrong} unnoticed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
