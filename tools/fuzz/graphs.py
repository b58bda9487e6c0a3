"""`./dev fuzz --graphs N`: whole graphs of random nets, compiled and by the token game; failures are made small.

    python -m tools.fuzz.graphs [--graphs 1000] [--seed 0] [--only NET] [--sanitize] [--save FOLDER]
    python -m tools.fuzz.graphs --alone [--graphs 1000] [--seed 0] [--threads 1] [--sanitize] [--save FOLDER]

Compared are all markings, all binding elements, and what is said of the graph: components, home and dead markings,
liveness, fairness, bounds. About fifty nets are compiled together (`helpers.random_unions`), and `--seed` is the
number of the first such file; `--only` looks at one of its nets, without the others. With `--alone` each net is larger
and compiled by itself, and `--seed` is the number of the first net.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.compiled import QUICK
from helpers.explored import SANITIZERS, Explorers, agrees
from helpers.netbuilder import flat
from helpers.random_graphs import WIDTHS, numbered
from helpers.random_unions import Union, union
from helpers.unions import PER_UNION, Outcome, alone, check

ROOT = Path(__file__).resolve().parents[2]
MOST_FAILURES = 10
"""Of unions, after which the rest is left."""


def verdict(explorers: Explorers, text: str, width: int, options: tuple[object, ...]) -> str:
    """What `agrees` says, or how the net differs."""
    try:
        return agrees(explorers, flat(text), *options, width=width)
    except Exception as failure:  # whatever it is, it is to be shown with its net
        return f"differs: {type(failure).__name__}: {failure}"


def kind(said: str) -> str:
    """What is the same of failures with the same cause, as far as one can tell."""
    return re.sub(r"[`'\"(\[{].*?[`'\")\]}]|\d+", "#", " ".join(said.split()))[:80]


def smaller(text: str, said: Callable[[str], str]) -> str:
    """The text with as few lines as possible for the same kind of failure, which `said` tells."""
    wanted = kind(said(text))
    lines = text.splitlines()
    size = max(1, len(lines) // 4)
    while size:
        start = 1
        while start < len(lines):
            fewer = lines[:start] + lines[start + size :]
            if kind(said("\n".join(fewer))) == wanted:
                lines = fewer
            else:
                start += size
        size //= 2
    return "\n".join(lines)


def unions(explorers: Explorers, given: argparse.Namespace) -> int:
    """Compare nets that are compiled together; 1 when one differs."""
    if given.only is not None:
        failures = small(explorers, union(given.seed, PER_UNION), given)
        print(
            f"graphs: net {given.only} of union {given.seed}: {'differs' if failures else 'same'}"
        )
        return failures
    done = Outcome()
    number, failures = given.seed, 0
    while done.nets < given.graphs and failures < MOST_FAILURES:
        one = union(number, PER_UNION)
        number += 1
        try:
            done.add(check(explorers, one))
        except AssertionError as difference:
            print(f"graphs: {difference}", flush=True)
            failures += small(explorers, one, given)
    print(f"graphs: {done}; {failures} differ")
    return int(failures > 0)


def small(explorers: Explorers, one: Union, given: argparse.Namespace) -> int:
    """The nets of a union that fail alone, made small; how many there are."""
    failures = 0
    for net in range(len(one.pages)) if given.only is None else [given.only]:
        why = alone(explorers, one, net)
        if not why:
            continue
        failures += 1
        text = smaller(one.text(net), lambda t: alone_text(explorers, one, t))
        given.save.mkdir(parents=True, exist_ok=True)
        path = given.save / f"union{one.number}net{net}.txt"
        path.write_text(f"{text}\n\n# {why}\n")
        print(f"{text}\n  -> {why[:2000]}\n  saved as {path}", flush=True)
        break  # others are likely to have the same cause
    return max(failures, int(given.only is None))


def alone_text(explorers: Explorers, one: Union, text: str) -> str:
    """What is wrong with a text; "" for nothing."""
    return alone(explorers, Union(one.number, one.style, text, ("",)), 0)


def main() -> int:
    """Compare many graphs; 1 when one differs."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.graphs", description=__doc__)
    parser.add_argument("--graphs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0, help="the first net; further ones follow")
    parser.add_argument("--only", type=int, help="a net of the union --seed")
    parser.add_argument("--alone", action="store_true", help="larger nets, each in its program")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--sanitize", action="store_true", help="compile with sanitizers")
    parser.add_argument("--save", type=Path, default=ROOT / ".fuzz", help="where failures go")
    given = parser.parse_args()
    options = ("--threads", given.threads)
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory(prefix="pn2code-graphs-") as folder:
        flags = SANITIZERS if given.sanitize else QUICK
        explorers = Explorers.open(Path(folder) / "explorers", flags)
        if not given.alone:
            return unions(explorers, given)
        for number in range(given.seed, given.seed + given.graphs):
            text, width = numbered(number), WIDTHS[number % len(WIDTHS)]
            said = verdict(explorers, text, width, options)
            what = kind(said)
            counts[what] += 1
            if not said.startswith("differs") or counts[what] > 1:
                continue
            print(f"graphs: net {number}: {what}", file=sys.stderr, flush=True)
            text = smaller(text, lambda t, w=width: verdict(explorers, t, w, options))  # type: ignore[misc]
            given.save.mkdir(parents=True, exist_ok=True)
            path = given.save / f"graph{number}.txt"
            path.write_text(f"{text}\n\n# {said}\n")
            print(f"{text}\n  -> {said[:2000]}\n  saved as {path}", flush=True)
    print(f"graphs: {dict(counts)}")
    return int(any(what.startswith("differs") for what in counts))


if __name__ == "__main__":
    sys.exit(main())
