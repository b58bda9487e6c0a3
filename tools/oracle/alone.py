"""`./dev oracle --alone`: random nets, each asked everything, before the engine of CPN Tools and before pn2code.

    python -m tools.oracle --alone [--count 100] [--first 0] [--jobs 2] [--nodes 400] [--save FOLDER] [--no-space]

Verdict, initial marking, a random run of the engine replayed here, the state space (sizes, dead and home markings,
components; small ones node by node and arc by arc). Net 17 is the same net every time. Nets that differ are saved
with what the engine said; exit code 1 then. Much slower than `--nets`, which asks about many together, and leaves out
some kinds of nets.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random

from tools.oracle import engine
from tools.oracle.totals import Totals, compared
from tools.oracle.writer import rich_net

from helpers.netbuilder import cpn
from helpers.random_nets import random_net

BATCH = 20


def text(number: int) -> str:
    """The net of that number, in the short form."""
    return (rich_net if number % 2 else random_net)(Random(number))


def batches(numbers: range, folder: Path) -> Iterator[list[Path]]:
    """The files of so many nets at a time."""
    for first in range(numbers.start, numbers.stop, BATCH):
        paths = []
        for number in range(first, min(first + BATCH, numbers.stop)):
            path = folder / f"net{number}.cpn"
            path.write_bytes(cpn(text(number)))
            paths.append(path)
        yield paths


def main(arguments: Sequence[str]) -> int:
    """The exit code: 0 when nothing differs."""
    parser = argparse.ArgumentParser(prog="oracle --alone", description=__doc__)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--nodes", type=int, default=400, help="of the engine's state spaces")
    parser.add_argument("--steps", type=int, default=40, help="of the engine's runs")
    parser.add_argument("--no-space", action="store_true", help="no state spaces: much faster")
    parser.add_argument("--save", type=Path)
    a = parser.parse_args(arguments)
    totals = Totals(a.save)
    with tempfile.TemporaryDirectory() as folder:
        for paths in batches(range(a.first, a.first + a.count), Path(folder)):
            said = engine.marking(paths, jobs=a.jobs)
            good = [p for p, s in zip(paths, said, strict=True) if "marking" in s]
            runs = dict(zip(good, engine.run(good, steps=a.steps, jobs=a.jobs), strict=True))
            spaces: dict[Path, engine.Answer] = {}
            if not a.no_space:
                asked = engine.space(good, seconds=20, nodes=a.nodes, graph=True, jobs=a.jobs)
                spaces = dict(zip(good, asked, strict=True))
            for path, first in zip(paths, said, strict=True):
                run, space = runs.get(path), spaces.get(path)
                found = compared(path, first, run, space)
                totals.add(path.stem, path, found, [first, run, space])
    return totals.report()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
