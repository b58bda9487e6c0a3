"""Many runs of a cell, one after the other: cycle times with their spread, and throughput.

    found = run_cycles(path, options, Plan(cycles=50, warm_up=5), d)        # Cycles; None: it could not start
    found.counted, found.figures()

Programs are built once. Sensors go on from one run to the next: a file is read on, and what is drawn is drawn on, so
that each run sees something else, and one seed gives the same runs again. So do stops.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field
from pathlib import Path
from typing import Any, Generic, TypeVar

from pn2code.base.frozen import frozen
from pn2code.cell.codes import CELL_VALUE
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.emission.write import expect_writable
from pn2code.input_files import folder_of
from pn2code.run.cell import run_once, sensors_of
from pn2code.run.observer import Observer
from pn2code.run.prepare import Prepared, RunOptions, prepare
from pn2code.run.record import RunRecord
from pn2code.run.results import RunResult, summary_of, write_results
from pn2code.run.stops import Rate, Stops

Watcher = TypeVar("Watcher", bound=Observer)
FINISHED = "finished"
DEFAULT_SEED = 1


@frozen
class Plan:
    """How many runs.

    Args:
        cycles: that are counted; warm_up: before them, that are not.
        stops: of robots and devices by name.
    """

    cycles: int
    warm_up: int = 0
    stops: Mapping[str, Rate] = field(default_factory=dict)


@frozen(eq=False)
class Keeping(Generic[Watcher]):
    """What is done with the cycles that are kept, beside their results.

    Args:
        watcher: makes an observer for each run.
        keep: is told of each result that is kept, with its observer and its folder.
    """

    watcher: Callable[[], Watcher]
    keep: Callable[[RunResult, Watcher, Path], None]


@frozen
class Cycle:
    """One run.

    Args:
        number: from 1, the warm-up included; is_counted: it is no part of the warm-up.
        counts: what `[report]` counts.
        stops: how many there were; stopped: s, how long they lasted together.
    """

    number: int
    is_counted: bool
    verdict: str
    reason: str
    final: tuple[str, ...]
    seconds: float
    counts: Mapping[str, int]
    stops: int
    stopped: float

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "cycle": self.number,
            "warm_up": not self.is_counted,
            "verdict": self.verdict,
            "reason": self.reason or None,
            "final": list(self.final),
            "seconds": round(self.seconds, 6),
            "counts": dict(self.counts),
            "stops": self.stops,
            "stopped_s": round(self.stopped, 6),
        }


@frozen
class Spread:
    """Of some numbers: how many, mean, standard deviation (None: of one), least, median and most, and half of the
    95 % confidence interval of the mean (Student's t; None: of one)."""

    count: int
    mean: float
    deviation: float | None
    least: float
    median: float
    most: float
    confidence: float | None

    @staticmethod
    def of(numbers: Sequence[float]) -> Spread | None:
        """None: there are no numbers."""
        if not numbers:
            return None
        ordered, n = sorted(numbers), len(numbers)
        mean = math.fsum(ordered) / n
        middle = (ordered[(n - 1) // 2] + ordered[n // 2]) / 2.0
        if n == 1:
            return Spread(1, mean, None, mean, middle, mean, None)
        from scipy.stats import t

        deviation = math.sqrt(math.fsum((x - mean) ** 2 for x in ordered) / (n - 1))
        half = float(t.ppf(0.975, n - 1)) * deviation / math.sqrt(n)
        return Spread(n, mean, deviation, ordered[0], middle, ordered[-1], half)

    def row(self) -> dict[str, Any]:
        """For programs."""
        return {
            "count": self.count,
            "mean": _rounded(self.mean),
            "std": _rounded(self.deviation),
            "min": _rounded(self.least),
            "median": _rounded(self.median),
            "max": _rounded(self.most),
            "confidence_95": _rounded(self.confidence),
        }


def _rounded(x: float | None) -> float | None:
    return None if x is None else round(x, 6)


@frozen
class Cycles:
    """What came of them; the files are in the output folder."""

    cell: str
    layout: str
    cycles: tuple[Cycle, ...]

    @property
    def counted(self) -> tuple[Cycle, ...]:
        """Those after the warm-up."""
        return tuple(c for c in self.cycles if c.is_counted)

    def endings(self) -> dict[str, Spread]:
        """By final places: the times of the cycles that have come there, in seconds."""
        times: dict[str, list[float]] = {}
        for c in self.counted:
            if c.verdict == FINISHED:
                times.setdefault(", ".join(c.final), []).append(c.seconds)
        found = {place: Spread.of(numbers) for place, numbers in sorted(times.items())}
        return {place: spread for place, spread in found.items() if spread is not None}

    def finished(self) -> Spread | None:
        """The times of all cycles that have come to an end, in seconds; None: none has."""
        return Spread.of([c.seconds for c in self.counted if c.verdict == FINISHED])

    def per_hour(self) -> dict[str, float]:
        """Throughput: cycles that have come to an end, and what `[report]` counts, in an hour of all that was run."""
        seconds = sum(c.seconds for c in self.counted)
        if seconds <= 0.0:
            return {}
        totals = {"cycles": sum(c.verdict == FINISHED for c in self.counted)}
        for c in self.counted:
            for name, n in c.counts.items():
                totals[f"counts.{name}"] = totals.get(f"counts.{name}", 0) + n
        return {name: 3600.0 * n / seconds for name, n in totals.items()}

    def row(self) -> dict[str, Any]:
        """For programs (docs/time.md)."""
        whole = self.finished()
        return {
            "cell": self.cell,
            "layout": self.layout or None,
            "counted": len(self.counted),
            "finished": sum(c.verdict == FINISHED for c in self.counted),
            "seconds": None if whole is None else whole.row(),
            "endings": {place: spread.row() for place, spread in self.endings().items()},
            "per_hour": {name: round(x, 6) for name, x in self.per_hour().items()},
            "stopped_s": round(sum(c.stopped for c in self.counted), 6),
            "cycles": [c.row() for c in self.cycles],
        }


def _far(number: int, count: int, passed: float) -> str:
    """Which cycle begins, how long each one has taken, and about how much longer all of them take."""
    text = f"cycle {number:,} of {count:,}"
    if number == 1:
        return text
    each = passed / (number - 1)
    return f"{text}, {each:.1f} s each, about {each * (count - number + 1):,.0f} s left"


def run_cycles(
    path: Path,
    options: RunOptions,
    plan: Plan,
    d: Diagnostics,
    say: Callable[[str], None] = lambda _text: None,
    keeping: Keeping[Watcher] | None = None,
) -> Cycles | None:
    """Runs the cell so often; None when it could not start.

    The results of the slowest counted cycle are written into the folder `slowest`, those of the first one that does not
    come to its end into `failed`.
    """
    expect_writable(options.out)
    prepared = prepare(path, options, d)
    if prepared is None or not _are_known(plan, prepared, d):
        return None
    _clear(options.out, prepared)
    stops = Stops(plan.stops, DEFAULT_SEED if options.seed is None else options.seed)
    cycles: list[Cycle] = []
    slowest = 0.0
    has_failed = False
    with folder_of(prepared.config, options.input) as inputs:
        sensors = sensors_of(prepared, options, inputs, d)
        if sensors is None:
            return None
        begun, count = time.monotonic(), plan.warm_up + plan.cycles
        for number in range(1, count + 1):
            say(_far(number, count, time.monotonic() - begun))
            watcher = None if keeping is None else keeping.watcher()
            seen: list[Observer] = [] if watcher is None else [watcher]
            record = run_once(prepared, options, inputs, sensors, d, seen, stops)
            if record is None:
                return None
            summary = summary_of(record, prepared)
            made = _cycle(number, number > plan.warm_up, record, summary)
            cycles.append(made)
            folder: Path | None = None
            if made.is_counted and made.verdict == FINISHED and made.seconds > slowest:
                slowest = made.seconds
                folder = options.out / "slowest"
            if made.is_counted and made.verdict != FINISHED and not has_failed:
                has_failed = True
                folder = options.out / "failed"
            if folder is not None:
                _keep(record, summary, prepared, folder)
                if keeping is not None and watcher is not None:
                    keeping.keep(RunResult(record, summary, prepared), watcher, folder)
    return Cycles(prepared.generated.partition.net.name, prepared.config.layout, tuple(cycles))


def _are_known(plan: Plan, prepared: Prepared, d: Diagnostics) -> bool:
    names = [r.name for r in prepared.config.programs]
    for who in plan.stops:
        if who not in names:
            d.error(
                CELL_VALUE,
                f"the cell has no robot or device `{who}` that could stop",
                prepared.config.locator.origin(),
                hint=did_you_mean(who, names, f"known are {', '.join(f'`{n}`' for n in names)}"),
            )
    return not d.has_errors


def _cycle(number: int, is_counted: bool, record: RunRecord, summary: Mapping[str, Any]) -> Cycle:
    lasted = [e["duration"] for e in record.events if e.get("event") == "stand"]
    return Cycle(
        number,
        is_counted,
        record.verdict,
        record.reason,
        record.final,
        record.time,
        summary["counts"],
        len(lasted),
        sum(lasted),
    )


def _clear(out: Path, prepared: Prepared) -> None:
    """What was kept of earlier runs does not stay."""
    name = f"{prepared.generated.partition.net.name}.trace.jsonl"
    for folder in (out / "slowest", out / "failed"):
        for file in (name, "rows.tsv", "messages.tsv", "summary.json", "run.json", "replay.html"):
            (folder / file).unlink(missing_ok=True)
        with suppress(OSError):
            folder.rmdir()


def _keep(record: RunRecord, summary: dict[str, Any], prepared: Prepared, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    write_results(record, summary, prepared, folder)


def table(cycles: Sequence[Cycle]) -> Iterator[str]:
    """The lines of `cycles.tsv`."""
    names = sorted({name for c in cycles for name in c.counts})
    yield "\t".join(
        ("cycle", "warm_up", "verdict", "final", "seconds", "stops", "stopped_s", *names)
    )
    for c in cycles:
        row = c.row()
        values = [
            row["cycle"], "yes" if row["warm_up"] else "no", c.verdict, ", ".join(c.final),
            f"{c.seconds:.6f}", c.stops, f"{c.stopped:.6f}", *(c.counts.get(n, "") for n in names),
        ]  # fmt: skip
        yield "\t".join(map(str, values))
