"""What the run-time monitor costs: `./supervisor.traced --dry-run` without and with it, in turn, in one run.

A dry run plays the whole cell in memory: nothing else takes time, so the ratio is the largest there can be. In a cell
a cycle is mostly waiting for robots; what it costs there is the time for a firing.
"""

from __future__ import annotations

import re
import resource
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from tests.helpers.netbuilder import cpn
from tools.bench import measures as m

CELLS = ("riveting", "sorting", "shared-zone", "timed")
ALONE = (("ten philosophers", m.TABLE), ("a protocol with strings", m.PROTOCOL))
"""Nets without a cell, over which the supervisor goes on for ever."""
FIRINGS = 20_000
RUNS = 40
"""Of a cell, for one sample: a single one takes milliseconds."""


@dataclass(frozen=True, slots=True)
class Cost:
    """Processor time of runs of a net.

    Args:
        name: of the cell or net.
        places: how many the net has.
        firings: of a run.
        without, with_it: s, of so many `runs`; one a repetition.
        nothing: s, of so many processes that only start and end.
        runs: of one sample.
    """

    name: str
    places: int
    firings: int
    without: Sequence[float]
    with_it: Sequence[float]
    nothing: Sequence[float]
    runs: int

    def cells(self) -> list[str]:
        """What stands in the columns: the least of all repetitions, without what starting a process takes."""
        own = [max(min(k) - min(self.nothing), 1e-9) for k in (self.without, self.with_it)]
        plain, watched = (1e6 * k / self.runs / self.firings for k in own)
        ratios = [b / a for a, b in zip(self.without, self.with_it, strict=True)]
        return [
            self.name,
            f"{self.places}",
            f"{self.firings:,}",
            f"{plain:.2f}",
            f"{watched:.2f}",
            f"{watched / plain:.1f}",
            f"{1e3 * min(self.without) / self.runs:.1f}",
            f"{1e3 * min(self.with_it) / self.runs:.1f}",
            f"{median(ratios):.2f} ({min(ratios):.2f} .. {max(ratios):.2f})",
        ]


HEAD = (
    "net", "places", "firings", "us a firing", "monitored", "times", "ms a run", "monitored", "times",
)  # fmt: skip


def costs(bench: m.Bench) -> list[Cost]:
    """Of all cells and nets."""
    found = []
    for name in CELLS:
        source = m.ROOT / "examples" / name
        found.append(_cost(bench, name, source, ("--input", str(source)), RUNS))
    for name, text in ALONE:
        net = bench.fresh().with_suffix(".cpn")
        net.write_bytes(cpn(text))
        found.append(_cost(bench, name, net, ("--max-firings", str(FIRINGS)), 1))
    return found


def _cost(bench: m.Bench, name: str, source: Path, options: tuple[str, ...], runs: int) -> Cost:
    print(f"bench: monitor, {name}", file=sys.stderr)
    folder = bench.fresh()
    bench.pn2code("generate", source, "-o", folder)
    bench.timed("make", "-s", "-j2", "supervisor.traced", "monitor", cwd=folder)
    programs = [str(folder / program) for program in ("supervisor.traced", "supervisor.monitor")]
    trace = folder / "run.trace.jsonl"
    seen = []
    for program in programs:
        _run([program, "--dry-run", *options, "--trace", str(trace)])
        seen.append([line for line in trace.read_text().splitlines() if '"transition"' in line])
    assert seen[0] == seen[1], f"{name}: the monitor has changed the run"
    places = re.search(r"\.place_count = (\d+)U", (folder / "net.c").read_text())
    assert places is not None
    commands = [[program, "--dry-run", "--quiet", *options] for program in programs]
    commands.append([programs[0], "--version"])
    samples: list[list[float]] = [[], [], []]
    for _ in range(bench.many):
        for command, own in zip(commands, samples, strict=True):
            own.append(_work(command, runs))
    return Cost(name, int(places[1]), len(seen[0]), *samples, runs=runs)


def _run(command: Sequence[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    # Without a cell it says that it ended after so many firings, which is what is wanted.
    assert done.returncode == 0 or "firings" in done.stderr, f"{command}:\n{done.stderr}"


def _work(command: Sequence[str], runs: int) -> float:
    """Processor time of so many runs, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for _ in range(runs):
        subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(bench: m.Bench) -> int:
    """Measure and print the table."""
    found = costs(bench)
    print("| " + " | ".join(HEAD) + " |")
    print("|---" * len(HEAD) + "|")
    for cost in found:
        print("| " + " | ".join(cost.cells()) + " |")
    return 0
