"""Several simulations of a net, and what their data collectors say together, as CPN Tools' replications do.

    found = replicated(request, 10, play)
    found.collectors[0].statistics["avrg"].half_lengths[95]

Simulation i has the seed of the request and i - 1. Of each data collector, each statistic gives one observation a
simulation: these are independent, however much the values within one simulation depend on each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.monitors.folder import OUTPUT
from pn2code.semantics.game.report import time_text
from pn2code.simulate.confidence import LEVELS, Average
from pn2code.simulate.run import DEFAULT_SEED, Outcome, Request

STATISTICS = ("count", "max", "min", "sum", "avrg")
"""Of a data collector, in the order and by the names of CPN Tools' reports. Timed ones have no sum."""
ENDINGS = ("error", "interrupted")
"""Why no further simulation is begun."""
_WHY = {"finished": "no more enabled transitions", "steps": "steps", "until": "time"}
_HEADER = ("", "avg", *(f"±{level} %" for level in LEVELS), "std", "min", "max")


@frozen
class Collector:
    """A data collector over all simulations.

    Args:
        id, name, timed: as in its row of one simulation.
        statistics: by name.
        simulations: how many gave an observation of each.
        without_values: in how many of these it saw no value. All its statistics are 0 there, and so are the
            observations, as in CPN Tools.
    """

    id: str
    name: str
    timed: bool
    statistics: Mapping[str, Average]
    simulations: int
    without_values: int

    @property
    def note(self) -> str:
        """What is to be known of the averages; "": nothing."""
        if not self.without_values:
            return ""
        return (
            f"In {self.without_values} of {self.simulations} simulations it saw no value: each of its statistics "
            "counts as 0 there, as in CPN Tools."
        )


@frozen
class Replications:
    """Simulations that were made.

    Args:
        wanted: how many were asked for.
        outcomes: of each that was begun; only the last one may have failed or been interrupted.
    """

    wanted: int
    outcomes: tuple[Outcome, ...]

    @property
    def whole(self) -> tuple[Outcome, ...]:
        """Those that came to their end."""
        return tuple(o for o in self.outcomes if o.why not in ENDINGS)

    @property
    def collectors(self) -> tuple[Collector, ...]:
        """What the data collectors say of the simulations that came to their end, in order of the file."""
        rows: dict[str, list[Mapping[str, Any]]] = {}
        for outcome in self.whole:
            for row in outcome.monitors:
                if "count" in row:
                    rows.setdefault(row["id"], []).append(row)
        return tuple(_collector(of_one) for of_one in rows.values())

    def json(self) -> dict[str, Any]:
        """For programs."""
        return {
            "wanted": self.wanted,
            "simulations": [
                {
                    "seed": o.seed,
                    "steps": o.steps,
                    "time": o.final.time if o.final else None,
                    "why": o.why,
                    "monitors": list(o.monitors),
                }
                for o in self.outcomes
            ],
            "collectors": [
                {
                    "id": c.id,
                    "name": c.name,
                    "timed": c.timed,
                    "without_values": c.without_values,
                    "statistics": {name: x.row() for name, x in c.statistics.items()},
                }
                for c in self.collectors
            ],
        }


def _collector(rows: Sequence[Mapping[str, Any]]) -> Collector:
    first = rows[0]
    names = [n for n in STATISTICS if not (first["timed"] and n == "sum")]
    own = {n: [row["avg" if n == "avrg" else n] for row in rows] for n in names}
    return Collector(
        first["id"],
        first["name"],
        first["timed"],
        {n: Average.of(x) for n, x in own.items()},
        len(rows),
        own["count"].count(0),
    )


def replicated(
    request: Request, wanted: int, play: Callable[[Request, int], Outcome]
) -> Replications:
    """Makes the simulations, one after the other, until one fails or is interrupted.

    Args:
        request: the first of them.
        wanted: how many.
        play: makes one; is given its number, from 1.
    """
    seed = DEFAULT_SEED if request.seed is None else request.seed
    made: list[Outcome] = []
    for number in range(1, wanted + 1):
        own = replace(request, seed=(seed + number - 1) % 2**64, output=f"{OUTPUT}/sim_{number}")
        made.append(play(own, number))
        if made[-1].why in ENDINGS:
            break
    return Replications(wanted, tuple(made))


def text(file: str, found: Replications, *, timed: bool) -> str:
    """The report for people: each simulation, then each data collector.

    Args:
        file: of the net.
        found: what was made.
        timed: whether the net has a clock.
    """
    lines = [f"{file}: {len(found.whole)} of {found.wanted} simulations", ""]
    lines += _table(
        [
            ["", "seed", "steps", *(["time"] if timed else []), "ended by"],
            *(simulation(i, o, timed=timed) for i, o in enumerate(found.outcomes, 1)),
        ],
        last=True,
    )
    for c in found.collectors:
        lines += ["", c.name + (" (timed)" if c.timed else "")]
        lines += _table([list(_HEADER), *([n, *numbers(x)] for n, x in c.statistics.items())])
        lines += [f"  {c.note}"] if c.note else []
    if not found.whole:
        lines += ["", "no simulation came to its end, so nothing is known of the data collectors"]
    elif not found.collectors:
        lines += ["", "the net has no data collectors"]
    elif len(found.whole) < 2:
        lines += ["", "nothing is known of confidence: that needs two simulations at least"]
    return "\n".join(lines)


def simulation(number: int, outcome: Outcome, *, timed: bool) -> list[str]:
    """One simulation as a row: number, seed, steps, time if the net is timed, why it ended."""
    why = _WHY.get(outcome.why, outcome.why)
    if outcome.breakpoint is not None:
        why = f"breakpoint {outcome.breakpoint['name']}"
    time = [time_text(outcome.final.time) if outcome.final else "-"] if timed else []
    return [str(number), str(outcome.seed), f"{outcome.steps:,}", *time, why]


def numbers(x: Average) -> list[str]:
    """Average, half lengths, deviation, smallest and largest, for people."""
    halves = [None if x.half_lengths is None else x.half_lengths[level] for level in LEVELS]
    return [number(n) for n in (x.average, *halves, x.std, x.min, x.max)]


def number(x: int | float | None) -> str:
    """A number, for people."""
    if x is None:
        return "-"
    return f"{x:,}" if isinstance(x, int) else f"{x:.6f}"


def _table(rows: Sequence[Sequence[str]], *, last: bool = False) -> list[str]:
    """Columns to the right but the first one, and the last one if so wanted."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    end = len(widths) - 1
    return [
        "  "
        + "  ".join(
            cell.ljust(width) if i == 0 or (last and i == end) else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
