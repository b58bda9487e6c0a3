"""`./dev fuzz --graphs N`: whole graphs of random nets, compiled and by the token game; failures are made small.

    python -m tests.fuzz.graphs [--graphs 1000] [--seed 0] [--threads 1] [--sanitize] [--save FOLDER]

Compared are all markings, all binding elements, and what is said of the graph: components, home and dead markings,
liveness, fairness, bounds.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # as pytest does: the tests' helpers

from helpers.explored import QUICK, SANITIZERS, Explorers, agrees
from helpers.netbuilder import flat
from helpers.random_graphs import WIDTHS, numbered

ROOT = Path(__file__).resolve().parents[2]


def verdict(explorers: Explorers, text: str, width: int, options: tuple[object, ...]) -> str:
    """What `agrees` says, or how the net differs."""
    try:
        return agrees(explorers, flat(text), *options, width=width)
    except Exception as failure:  # whatever it is, it is to be shown with its net
        return f"differs: {type(failure).__name__}: {failure}"


def kind(said: str) -> str:
    """What is the same of failures with the same cause, as far as one can tell."""
    return re.sub(r"[`'\"(\[{].*?[`'\")\]}]|\d+", "#", " ".join(said.split()))[:80]


def smaller(explorers: Explorers, text: str, width: int, options: tuple[object, ...]) -> str:
    """The text with as few lines as possible for the same kind of failure."""
    wanted = kind(verdict(explorers, text, width, options))
    lines = text.splitlines()
    size = max(1, len(lines) // 4)
    while size:
        start = 1
        while start < len(lines):
            fewer = lines[:start] + lines[start + size :]
            if kind(verdict(explorers, "\n".join(fewer), width, options)) == wanted:
                lines = fewer
            else:
                start += size
        size //= 2
    return "\n".join(lines)


def main() -> int:
    """Compare many graphs; 1 when one differs."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz.graphs", description=__doc__)
    parser.add_argument("--graphs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0, help="the first net; further ones follow")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--sanitize", action="store_true", help="compile with sanitizers")
    parser.add_argument("--save", type=Path, default=ROOT / ".fuzz", help="where failures go")
    given = parser.parse_args()
    options = ("--threads", given.threads)
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory(prefix="pn2code-graphs-") as folder:
        flags = SANITIZERS if given.sanitize else QUICK
        explorers = Explorers.open(Path(folder) / "explorers", flags)
        for number in range(given.seed, given.seed + given.graphs):
            text, width = numbered(number), WIDTHS[number % len(WIDTHS)]
            said = verdict(explorers, text, width, options)
            what = kind(said)
            counts[what] += 1
            if not said.startswith("differs") or counts[what] > 1:
                continue
            print(f"graphs: net {number}: {what}", file=sys.stderr, flush=True)
            text = smaller(explorers, text, width, options)
            given.save.mkdir(parents=True, exist_ok=True)
            path = given.save / f"graph{number}.txt"
            path.write_text(f"{text}\n\n# {said}\n")
            print(f"{text}\n  -> {said[:2000]}\n  saved as {path}", flush=True)
    print(f"graphs: {dict(counts)}")
    return int(any(what.startswith("differs") for what in counts))


if __name__ == "__main__":
    sys.exit(main())
