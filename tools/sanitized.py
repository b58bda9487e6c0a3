"""`./dev sanitized`: every net at hand in the explorer under the sanitizers for addresses and undefined behaviour.

    python -m tools.sanitized [--states 300] [--seconds 5] [--only TEXT] [--every N] [--first N] [--references N]

The nets of the collections and the shipped examples, then as many random nets with references (about 30 in a file).
Each is explored with its places packed into counters and with none packed, breadth first and depth first, with one and
two threads, approximately, with tables in files, and reduced by time where that is possible; runs to dead markings are
written. A graph that is small is compared with that of the token game. Exit code 1 if a net differs, or the sanitizers
say something.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from helpers.explored import SANITIZERS, Explorers, agrees, wide
from helpers.random_references import referring
from helpers.unions import check
from helpers.walks import nets
from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.net.front import load
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.time_reduction import why_not_reducible

ROOT = Path(__file__).resolve().parents[1]
COMPARED = 100
"""Markings of a graph that is compared with the token game's."""
PER_FILE = 30
ENDINGS = ("complete", "approximation", "states", "seconds", "error", "memory", "capacity")
"""Why an exploration may end; anything else is a bug. ("capacity": in another order a place needs more room.)"""


def main() -> int:
    """Explore all nets; one line each on the standard error output."""
    parser = argparse.ArgumentParser(prog="tools.sanitized")
    parser.add_argument("--states", type=int, default=300, help="markings of each net")
    parser.add_argument("--seconds", type=float, default=5.0, help="of each exploration")
    parser.add_argument("--only", default="", help="nets whose path contains this text")
    parser.add_argument("--every", type=int, default=1, help="one net of so many")
    parser.add_argument("--first", type=int, default=0, help="the number of the first one")
    parser.add_argument("--references", type=int, default=300, help="random nets with references")
    given = parser.parse_args()
    shared = Path(os.environ.get("PN2CODE_SHARED", ROOT.parent / "shared"))
    paths = [*nets(shared), *sorted((ROOT / "examples").rglob("*.cpn"))]
    counts: Counter[str] = Counter()
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="pn2code-sanitized-") as folder:
        explorers = Explorers.open(Path(folder) / "explorers", SANITIZERS)
        for path in [p for p in paths if given.only in str(p)][given.first :: given.every]:
            verdict, detail = look(explorers, path, given.states, given.seconds)
            counts[verdict] += 1
            print(f"{verdict:12}{path.name}  {detail[:1500]}", file=sys.stderr, flush=True)
        done = 0
        while done < given.references:
            done += PER_FILE
            verdict = referred(explorers, done // PER_FILE - 1)
            counts[f"references: {verdict}"] += PER_FILE
    print(f"sanitized: {dict(counts)}; {time.monotonic() - began:.0f} s")
    return int(any("differs" in verdict for verdict in counts))


def look(explorers: Explorers, path: Path, states: int, seconds: float) -> tuple[str, str]:
    """What became of a net, and details."""
    d = Diagnostics()
    flat = load(path, d)
    if flat is None:
        return "rejected", ", ".join(sorted({e.code for e in d.errors}))
    try:
        start = Sizes.start(flat, {})
    except GameError as error:
        return "exception", str(error)
    try:
        ends = [explored(explorers, flat, start, w, states, seconds) for w in (1, 0)]
        return "explored", f"{' / '.join(ends)}; {compared(explorers, flat, seconds)}"
    except subprocess.TimeoutExpired:
        return "hangs", f"more than {explorers.seconds:.0f} s"
    except AssertionError as failure:
        text = str(failure)
        return ("unsupported" if text.startswith("[(") else "differs"), text


def explored(
    explorers: Explorers, flat: FlatNet, start: Sizes, width: int, states: int, seconds: float
) -> str:
    """How the explorations of a net end, in words, with counters of that width; 0: no place is packed."""
    limits = ("--max-states", states, "--max-seconds", seconds)
    traces = ("--traces", 3, "--trace-to", explorers.folder / "dead")
    found = explorers.explore(
        flat, *limits, *traces, width=width, sizes=wide(start, width), reads=False
    )
    ends = [found.report["why"]]
    folder = explorers.folder / "net"
    others: list[tuple[object, ...]] = [
        ("--threads", 2, "--order", "dfs"),
        ("--approximate", "hash", "--threads", 2),
        ("--approximate", "bitstate"),
        ("--spill", explorers.folder),
    ]
    if why_not_reducible(flat) is None:
        others.append(("--reduce", "time"))
    for options in others:
        ends.append(explorers.said(folder, *limits, *options).report["why"])
    odd = [end for end in ends if end not in ENDINGS]
    assert not odd, f"ends by {odd}"
    return f"{found.report['nodes']} {Counter(ends).most_common(1)[0][0]}"


def compared(explorers: Explorers, flat: FlatNet, seconds: float) -> str:
    """Whether the graph is that of the token game, in words."""
    try:
        Game(flat, {}, files=Files(None))
        with Deadline.after(max(30.0, 6 * seconds)).enforced():
            return agrees(explorers, flat, "--max-seconds", seconds, nodes=COMPARED)
    except TimeIsOverError:
        return "too slow to be compared"


def referred(explorers: Explorers, number: int) -> str:
    """Whether the random nets of a file are the token game's."""
    try:
        check(explorers, referring(number, PER_FILE))
    except AssertionError as failure:
        print(f"references {number}: {failure}", file=sys.stderr, flush=True)
        return "differs"
    return "same"


if __name__ == "__main__":
    sys.exit(main())
