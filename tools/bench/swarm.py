"""`./dev bench --swarm`: a swarm by one worker and by two, measured in turn, and a model of many more; then how much
swarms of a net that can be explored see of it, next to what they estimate.

The model is no measurement. Searches depend on nothing but their number, so W workers do ceil(N / W) of them one after
the other; what one process does for each of them (the scheduler, the command that merges what they say) is not divided:

    T(W) = start + N * serial + ceil(N / W) * (search + around)

`start`: until the workers are there. `serial`: processor time of the command for a search, in which the scheduler runs
as well. `search`: what a search takes; `around`: what a worker needs to begin one and to say what it has found.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pn2code.cli.nets import open_net
from pn2code.cli.options import Format, parse_values
from pn2code.diagnostics import Diagnostics, render
from pn2code.verdict.opened import OpenNet
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.swarm import searching
from pn2code.verify.swarm.cluster import Cluster
from pn2code.verify.swarm.pool import Swarm

NET, VALUES = Path("examples/philosophers/philosophers.cpn"), ("n=20",)
SEARCHES, STATES = 16, 1_000_000
TINY = 200
"""Searches that look at one marking: what is left is what is around a search."""
MODELLED, LONG_S = 10_000, 60.0
WORKERS = (1, 2, 10, 100, 1_000)
SMALL = ("n=14",)
PARTS = ((4, 10), (16, 100), (16, 10), (64, 20), (16, 3))
"""Searches, and into how many parts of all markings: each looks at one of them at most."""


@dataclass(frozen=True, slots=True)
class Compiled:
    """A net, and what it was compiled from and to."""

    opened: OpenNet
    made: Generated
    program: Path


@contextmanager
def compiled(values: tuple[str, ...]) -> Iterator[Compiled]:
    """The net with these values."""
    opened = open_net(NET, parse_values(list(values)), Format.FULL)
    d = Diagnostics()
    made = Generated()
    sizes = Sizes.start(opened.flat, opened.storage)
    with programs.program(opened.flat, opened.storage, sizes, d, made=made) as program:
        assert program is not None, render.report(d)
        yield Compiled(opened, made, program)


@dataclass(frozen=True, slots=True)
class Measured:
    """One swarm: seconds until the workers were there, of the searches, and of this process while they ran."""

    start: float
    wall: float
    serial: float
    report: dict[str, Any]


def once(net: Compiled, workers: int, searches: int, states: int) -> Measured:
    """One swarm with workers of its own."""
    d = Diagnostics()
    with Cluster(workers) as pool:
        began = time.perf_counter()
        assert pool.start(d), render.report(d)
        ready = time.perf_counter()
        used = time.process_time()
        assert net.made.sizes is not None
        found = searching.search(
            net.opened.flat,
            net.program,
            net.made,
            ["--arena", str(net.made.sizes.memory >> 20)],
            ExploreOptions(),
            Limits(max_states=states),
            Swarm(searches, pool),
            d,
        )
        assert found is not None, render.report(d)
        done = time.perf_counter()
        spent = time.process_time() - used
    return Measured(ready - began, done - ready, spent, found)


def stable(report: dict[str, Any]) -> dict[str, Any]:
    """Without what depends on the clock and on who did it."""
    kept = {k: v for k, v in report.items() if k not in ("seconds", "peak_mib")}
    return {**kept, "swarm": {**report["swarm"], "workers": 0}}


def modelled(searches: int, workers: int, start: float, serial: float, search: float) -> float:
    """Seconds, by the model; `search` with what is around it."""
    return start + searches * serial + math.ceil(searches / workers) * search


def seen() -> None:
    """How much is seen, and what is estimated."""
    with compiled(SMALL) as net:
        d = Diagnostics()
        whole = explore(net.opened.flat, net.opened.storage, Limits(graph=False), d)
        assert whole is not None and whole.complete, render.report(d)
        print(f"\nphilosophers {SMALL[0]}: {whole.nodes:,} markings\n")
        print(
            "| searches | of so many markings | looked at | estimated: there are, or more | said: seen, or less |"
        )
        print("|---|---|---|---|---|")
        for searches, part in PARTS:
            states = whole.nodes // part
            own = once(net, min(2, os.cpu_count() or 1), searches, states).report["swarm"]
            looked, total = own["markings"] / whole.nodes, own["estimated_total"] / whole.nodes
            print(
                f"| {searches} | {states:,} | {looked:.1%} | {total:.1%} | {own['estimated_coverage']:.1%} |"
            )


def measure(repeat: int) -> int:
    """Prints all tables; 1 if the answers differ."""
    load = os.getloadavg()[0]
    with compiled(VALUES) as net:
        found: dict[int, list[Measured]] = {1: [], 2: []}
        for _ in range(repeat):
            for workers, own in found.items():
                own.append(once(net, workers, SEARCHES, STATES))
        tiny = [once(net, 1, TINY, 1) for _ in range(repeat)]
    reports = [stable(one.report) for own in found.values() for one in own]
    is_same = all(r == reports[0] for r in reports)
    print(f"{os.cpu_count()} cores; load at the start {load:.1f}")
    print(f"\nphilosophers {VALUES[0]}, {SEARCHES} searches of {STATES:,} markings at most")
    print("\n| workers | s, least | s, all | workers ready after, s | answers |")
    print("|---|---|---|---|---|")
    best = {w: min(own, key=lambda m: m.wall) for w, own in found.items()}
    for workers, own in found.items():
        walls = ", ".join(f"{m.wall:.2f}" for m in own)
        start = min(m.start for m in own)
        same = "the same" if is_same else "**differ**"
        print(f"| {workers} | {best[workers].wall:.2f} | {walls} | {start:.2f} | {same} |")
    print(f"\nTwo workers are {best[1].wall / best[2].wall:.2f} times as fast as one.")
    small = min(tiny, key=lambda m: m.wall)
    serial = small.serial / TINY
    around = max(small.wall / TINY - serial, 0.0)
    start = min(m.start for m in found[1])
    print(
        f"Per search: {serial * 1e3:.1f} ms of the command and its scheduler, {around * 1e3:.0f} ms around a search."
    )
    print(
        f"\nModel, not measured: {MODELLED:,} searches of {LONG_S:.0f} s each, on processors of their own\n"
    )
    print("| workers | s | times one worker | of the ideal |")
    print("|---|---|---|---|")
    alone = modelled(MODELLED, 1, start, serial, LONG_S + around)
    for workers in WORKERS:
        seconds = modelled(MODELLED, workers, start, serial, LONG_S + around)
        times = alone / seconds
        print(f"| {workers:,} | {seconds:,.0f} | {times:,.1f} | {times / workers:.1%} |")
    seen()
    return int(not is_same)
