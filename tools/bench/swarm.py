"""`./dev bench --swarm`: a swarm by one worker and by two, measured in turn, and a model of many more.

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
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pn2code.cli.nets import open_net
from pn2code.cli.options import Format, parse_values
from pn2code.diagnostics import Diagnostics, render
from pn2code.verify.exploring import programs
from pn2code.verify.exploring.explore import ExploreOptions
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


@dataclass(frozen=True, slots=True)
class Measured:
    """One swarm: seconds until the workers were there, of the searches, and of this process while they ran."""

    start: float
    wall: float
    serial: float
    report: dict[str, Any]


def once(workers: int, searches: int, states: int, program: Path, made: Generated) -> Measured:
    """One swarm with workers of its own."""
    opened = open_net(NET, parse_values(VALUES), Format.FULL)
    d = Diagnostics()
    with Cluster(workers) as pool:
        began = time.perf_counter()
        assert pool.start(d), render.report(d)
        ready = time.perf_counter()
        used = time.process_time()
        assert made.sizes is not None
        found = searching.search(
            opened.flat,
            program,
            made,
            ["--arena", str(made.sizes.memory >> 20)],
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


def measure(repeat: int) -> int:
    """Prints both tables; 1 if the answers differ."""
    opened = open_net(NET, parse_values(VALUES), Format.FULL)
    d = Diagnostics()
    made = Generated()
    sizes = Sizes.start(opened.flat, opened.storage)
    with programs.program(opened.flat, opened.storage, sizes, d, made=made) as program:
        assert program is not None, render.report(d)
        load = os.getloadavg()[0]
        found: dict[int, list[Measured]] = {1: [], 2: []}
        for _ in range(repeat):
            for workers, own in found.items():
                own.append(once(workers, SEARCHES, STATES, program, made))
        tiny = [once(1, TINY, 1, program, made) for _ in range(repeat)]
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
    return int(not is_same)
