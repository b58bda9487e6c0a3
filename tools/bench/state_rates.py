"""Explorations that have no peer: nets with strings and lists, and two threads; part of `./dev bench --states`.

The protocols of the collection are explored up to a number of states, or completely where they have fewer (those with
too few to measure are left out). Beside two threads stand two explorations of one thread at the same time: what these
lose to each other, memory and processors take, not the explorer.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

MOST_STATES = 400_000
FEWEST_STATES = 100_000
AIM = 300_000
FOLDERS = (
    "SimpleProtocol",
    "ProtocolWithTimer",
    "HierarchicalProtocol",
    "RingProtocol",
    "TimedProtocol",
)


def start(net: Path, *options: str) -> subprocess.Popen[str]:
    """An exploration that has begun."""
    command = [sys.executable, "-m", "pn2code", "verify", str(net), "--json", "--no-graph"]
    command += ["--most-traces", "0", *options]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)


def figures(exploration: subprocess.Popen[str]) -> dict[str, Any]:
    """What it has found, complete or not."""
    said, _ = exploration.communicate()
    if exploration.returncode not in (0, 3):
        raise SystemExit(f"bench: {exploration.args}: code {exploration.returncode}")
    found: dict[str, Any] = json.loads(said)
    return found


def protocols(shared: Path, repeat: int) -> Iterator[Sequence[str]]:
    """A row for each protocol: name, states, arcs of each, states/s, bytes/state."""
    nets = sorted(p for name in FOLDERS for p in shared.glob(f"corpus/nets/**/{name}/*.cpn"))
    newest = {net.stem: net for net in nets}
    for name, net in newest.items():
        options = ("--threads", "1", "--max-states", str(MOST_STATES))
        runs = [figures(start(net, *options)) for _ in range(repeat)]
        best = min(runs, key=lambda run: run["seconds"])
        if best["nodes"] >= FEWEST_STATES:
            yield (
                name,
                f"{best['nodes']:,}{'' if best['complete'] else ' of more'}",
                f"{best['arcs'] / best['nodes']:.1f}",
                f"{best['states_per_second']:,.0f}",
                f"{best['bytes_per_state']:.1f}",
                f"{AIM:,}",
            )


def threads(net: Path, repeat: int) -> tuple[float, float, float]:
    """Seconds of exploration with one thread, with two, and of two explorations at once with one thread each."""
    one, two, both = [], [], []
    for _ in range(repeat):
        one.append(figures(start(net, "--threads", "1"))["seconds"])
        two.append(figures(start(net, "--threads", "2"))["seconds"])
        at_once = [start(net, "--threads", "1"), start(net, "--threads", "1")]
        both.append(max(figures(e)["seconds"] for e in at_once))
    return min(one), min(two), min(both)


def print_rates(shared: Path, repeat: int) -> None:
    """Prints both."""
    print(
        "\n| net with strings or lists | states | arcs a state | states/s | bytes a state | target |"
    )
    print("|---|---|---|---|---|---|")
    for row in protocols(shared, repeat):
        print("| " + " | ".join(row) + " |")
    net = shared / "bench/phil14.cpn"
    if net.exists():
        one, two, both = threads(net, repeat)
        print(
            f"\nPhilosophers 14: one thread {one:.2f} s, two threads {two:.2f} s, {one / two:.2f} times as fast "
            f"(target 1.7); two explorations at once {both:.2f} s each, {2 * one / both:.2f} times the throughput "
            "of one."
        )
