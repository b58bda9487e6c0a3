"""The performance report as a page: what CPN Tools writes as `PerfReport.html` and `PerfReportIID.html`.

of_one(net, outcome)         # one simulation: the data collectors
of_several(net, found)       # several: averages with their confidence intervals
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pn2code.net.flat import FlatNet
from pn2code.semantics.game.report import time_text
from pn2code.simulate.confidence import LEVELS
from pn2code.simulate.replications import Replications, number, numbers, simulation
from pn2code.simulate.run import Outcome
from pn2code.verify.report import html

_TIMED = ("count", "avg", "min", "max")
_UNTIMED = ("count", "sum", "avg", "min", "max")
_TITLES = {"count": "Count", "sum": "Sum", "avg": "Avrg", "min": "Min", "max": "Max"}


def of_one(net: FlatNet, outcome: Outcome) -> str:
    """The page of one simulation."""
    rows = [row for row in outcome.monitors if "count" in row]
    tables = [
        _collected("Timed statistics", _TIMED, [r for r in rows if r["timed"]]),
        _collected("Untimed statistics", _UNTIMED, [r for r in rows if not r["timed"]]),
    ]
    time = f", model time {time_text(outcome.final.time)}" if net.timed and outcome.final else ""
    return _page(
        net,
        title="simulation performance",
        head=f"{outcome.steps:,} steps{time}, seed {outcome.seed}",
        note="The values within one simulation may depend on each other, so nothing is said of confidence: "
        "simulate several times (--replications).",
        tables=[t for t in tables if t["rows"]],
    )


def of_several(net: FlatNet, found: Replications) -> str:
    """The page of several simulations."""
    head = ["", "Avrg", *(f"{level} % half length" for level in LEVELS), "StD", "Min", "Max"]
    tables: list[Mapping[str, Any]] = [
        {
            "title": c.name + (" (timed)" if c.timed else ""),
            "head": head,
            "rows": [[n, *numbers(x)] for n, x in c.statistics.items()],
            "note": c.note,
        }
        for c in found.collectors
    ]
    made = {
        "title": "Simulations",
        "head": ["", "Seed", "Steps", *(["Model time"] if net.timed else []), "Ended by"],
        "rows": [simulation(i, o, timed=net.timed) for i, o in enumerate(found.outcomes, 1)],
        "note": "",
    }
    return _page(
        net,
        title="performance",
        head=f"{len(found.whole)} of {found.wanted} simulations",
        note="Each simulation gives one observation of each statistic. The mean lies within a half length of the "
        "average, with so many per cent.",
        tables=[*tables, made],
    )


def _page(
    net: FlatNet, *, title: str, head: str, note: str, tables: Sequence[Mapping[str, Any]]
) -> str:
    return html.page(
        "performance.html.j2",
        ("report.css",),
        title=f"{net.name}: {title}",
        file=net.file,
        head=head,
        note=note,
        tables=tables,
    )


def _collected(
    title: str, columns: Sequence[str], rows: Sequence[Mapping[str, Any]]
) -> Mapping[str, Any]:
    return {
        "title": title,
        "head": ["", *(_TITLES[c] for c in columns)],
        "rows": [[row["name"], *(number(row[c]) for c in columns)] for row in rows],
        "note": "",
    }
