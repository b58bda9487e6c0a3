"""Nets explored as a whole, and by a sweep that forgets as soon as it can: the same is said, or the sweep refuses.

    python -m tools.swept --nets 300 [--seed 0] [--sanitize]     # at random
    python -m tools.swept [--states 20000] NET_OR_FOLDER ...     # of collections

Each net is swept by its own measure, and by weights at random, which are wrong most of the time. Exit code 1 if
something else is said than without.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import typer

from helpers.compiled import QUICK
from helpers.concurrent_nets import concurrent
from helpers.explored import SANITIZERS, Explorers
from helpers.netbuilder import flat
from helpers.random_nets import random_net
from helpers.swept import compare, random_weights
from pn2code.cli.nets import open_net
from pn2code.cli.options import Format
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import GameError


def main() -> int:
    """A line for each net that differs, and how many did not."""
    parser = argparse.ArgumentParser(prog="tools.swept")
    parser.add_argument("--nets", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--states", type=int, default=3000)
    parser.add_argument("--sanitize", action="store_true")
    parser.add_argument("folders", nargs="*", type=Path)
    given = parser.parse_args()
    said: Counter[str] = Counter()
    with tempfile.TemporaryDirectory(prefix="pn2code-") as folder:
        explorers = Explorers.open(Path(folder) / "x", SANITIZERS if given.sanitize else QUICK)
        for number, (name, net) in enumerate(_nets(given)):
            try:
                for what, how in _looked(explorers, net, Random(given.seed + number), given.states):
                    said[f"{how}: {what}"] += 1
            except AssertionError as problem:
                said["DIFFERENT"] += 1
                print(f"WRONG {name}: {str(problem)[:500]}", flush=True)
            except GameError as error:
                said["no initial marking"] += 1
                print(f"{name}: {error.message}", flush=True)
    for what, count in sorted(said.items()):
        print(f"{count:6} {what}")
    return 1 if said["DIFFERENT"] else 0


def _looked(explorers: Explorers, net: FlatNet, r: Random, most: int) -> Iterator[tuple[str, str]]:
    """What came of each way to sweep the net."""
    has_classes = net.timed and not net.real_time
    for options in ((), ("--reduce", "time"))[: 1 + has_classes]:
        time = f" {' '.join(options)}" if options else ""
        yield compare(explorers, net, *options, most=most), f"its measure{time}"
        weights = random_weights(net, r)
        yield compare(explorers, net, *options, weights=weights, most=most), f"random{time}"


def _nets(given: argparse.Namespace) -> Iterator[tuple[str, FlatNet]]:
    for seed in range(given.seed, given.seed + given.nets):
        yield f"seed {seed}", flat(concurrent(seed, 2) if seed % 2 else random_net(Random(seed)))
    for folder in given.folders:
        for path in [folder] if folder.is_file() else sorted(folder.rglob("*.cpn")):
            try:
                yield str(path), open_net(path, {}, Format.FULL).flat
            except (SystemExit, typer.Exit):
                continue


if __name__ == "__main__":
    sys.exit(main())
