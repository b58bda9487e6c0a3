"""The summary of a run: `summary.json` for programs, a page of text for people."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from pn2code.base.clearance_words import figure
from pn2code.base.conditioning import condition_text
from pn2code.cell.config import ReportConfig
from pn2code.report.activities import activities, busy_seconds
from pn2code.run.command_words import KINDS
from pn2code.run.record import RunRecord, merged_rows, summary_counts

MOST_PARTS = 12
"""on one screen"""
MOST_BY_HAND = 12
MOST_NUMBERS = 12
"""in one line"""


def summarise(
    record: RunRecord,
    report: ReportConfig,
    robots: tuple[str, ...],
    occurrences: Mapping[str, Collection[str]],
) -> dict[str, Any]:
    """All the figures, as JSON-able data. Lengths in m, times in s, angles in degrees.

    Args:
        record: the run.
        report: what the cell wants to know of it.
        robots: the names of robots and devices.
        occurrences: label -> the whole paths of the transitions that `report.occurrences` means.
    """
    totals = [
        {
            "name": activity.name,
            "times": activity.times,
            "start": round(activity.intervals[0][0], 6),
            "end": round(activity.intervals[-1][1], 6),
            "seconds": round(activity.seconds, 6),
            "busy": {robot: round(busy, 6) for robot, busy in activity.busy.items()},
            "intervals": [[round(t, 6) for t in interval] for interval in activity.intervals],
        }
        for activity in activities(record, robots)
    ]
    per_robot = {
        robot: {
            **{
                kind: round(
                    sum(
                        a.end - a.start
                        for a in record.actions
                        if (a.robot, a.kind) == (robot, kind)
                    ),
                    6,
                )
                for kind in KINDS
            },
            "commands": sum(a.robot == robot for a in record.actions),
            "busy": round(busy_seconds(record, robot), 6),
            "utilisation": round(busy_seconds(record, robot) / max(record.time, 1e-9), 4),
        }
        for robot in robots
    }
    return {
        "cell": record.cell,
        "layout": record.layout,
        "backend": record.backend,
        "verdict": record.verdict,
        "reason": record.reason,
        "final": list(record.final),
        "failed": list(record.failed),
        "cycle_seconds": round(record.time, 6),
        "rows": len(merged_rows(record.messages, report.rows)) if report.rows else 0,
        "counts": summary_counts(record, dict(report.count), occurrences),
        "activities": totals,
        "robots": per_robot,
        "clearances": minima(record),
        "conditioning": _conditioning(record, robots, dict(report.count)),
        "accuracy": record.accuracy,
        "pictures": record.pictures,
        **({"parts": _parts(record)} if record.parts else {}),
        **(
            {"zones": {record.too_fast.zone: record.too_fast.described()}}
            if record.too_fast
            else {}
        ),
        **(
            {
                "by_hand": [
                    {"t": round(h.t, 6), "robot": h.robot, "text": h.text} for h in record.by_hand
                ]
            }
            if record.by_hand
            else {}
        ),
        "warnings": [
            {"t": round(w.t, 6), "robot": w.robot, "text": w.text} for w in record.warnings
        ],
    }


def _parts(record: RunRecord) -> dict[str, list[dict[str, Any]]]:
    """Of each part what has become of it: when, by whom, and where it was then (m, degrees)."""
    out: dict[str, list[dict[str, Any]]] = {}
    for entry in record.parts:
        p = entry.change.pose
        out.setdefault(entry.change.part, []).append(
            {
                "t": round(entry.t, 6),
                "robot": entry.robot,
                "effect": entry.change.effect,
                "at": [round(v, 6) for v in (p.x, p.y, p.z)],
                "turned": [round(math.degrees(v), 4) for v in (p.rx, p.ry, p.rz)],
                **({"on": list(entry.change.on)} if entry.change.on else {}),
            }
        )
    return dict(sorted(out.items()))


def _on(change: dict[str, Any]) -> str:
    """What a part has been put on, in words."""
    return f" on {' and '.join(change['on'])}" if "on" in change else ""


def minima(record: RunRecord) -> dict[str, Any]:
    """The least clearances: how much (m), when, and between which two things."""
    out: dict[str, Any] = {}
    for name in sorted(record.series):
        if not name.startswith("clearance."):
            continue
        values = record.array(name)
        if values.size and np.isfinite(values).any():
            i, least = int(np.nanargmin(values)), record.least.get(name)
            out[name.removeprefix("clearance.")] = {
                "m": round(float(values[i]), 9),
                "t": round(record.sample_t[i], 6),
                **({"between": [least.a, least.b]} if least is not None else {}),
            }
    return out


def _conditioning(
    record: RunRecord, robots: tuple[str, ...], count: dict[str, str]
) -> dict[str, Any]:
    """Per robot: the worst condition number of the run, and at each counted action."""
    out: dict[str, Any] = {}
    times = np.asarray(record.sample_t)
    for robot in robots:
        values = record.array(f"condition.{robot}")
        if not values.size:
            continue
        i = int(np.argmax(values))
        entry: dict[str, Any] = {
            "worst": round(float(values[i]), 4),
            "t": round(record.sample_t[i], 6),
        }
        for label, action in count.items():
            at = [a.start for a in record.actions if a.kind == "tool" and a.label == action]
            entry[f"at_{label}"] = [
                round(float(values[int(np.argmin(np.abs(times - t)))]), 4) for t in at
            ]
        out[robot] = entry
    return out


def _counted(entry: dict[str, Any]) -> str:
    """Condition numbers at the actions that are counted, by the labels of cell.toml."""
    out = ""
    for key, values in entry.items():
        label = key.removeprefix("at_")
        if label != key and values:
            shown = " ".join(condition_text(v, 1) for v in values[:MOST_NUMBERS])
            more = " ..." if len(values) > MOST_NUMBERS else ""
            out += f"; at {label}: {shown}{more}"
    return out


def page(summary: dict[str, Any]) -> RenderableType:
    """The summary for a terminal."""
    good = summary["verdict"] == "finished" and not summary["failed"]
    head = Text()
    head.append(
        " finished " if good else f" {summary['verdict']} ",
        "bold reverse green" if good else "bold reverse red",
    )
    head.append(f"  {summary['cell']}")
    if summary["layout"]:
        head.append(f", layout {summary['layout']}")
    head.append(f", backend {summary['backend']}")
    if summary["final"]:
        head.append(f", ended in {', '.join(p.rpartition('.')[2] for p in summary['final'])}")
    if summary["failed"]:
        why = [x for x in summary["failed"] if x not in summary["final"]]
        head.append(f", a failure{': ' if why else ''}{'; '.join(why)}", "red")
    if summary["reason"]:
        head.append(f"\n{summary['reason']}", "red")

    facts = Table(box=None, show_header=False, pad_edge=False)
    facts.add_column(style="bold")
    facts.add_column()
    facts.add_row("cycle time", f"{summary['cycle_seconds']:.2f} s (simulated)")
    if summary["rows"]:
        facts.add_row("rows sent", str(summary["rows"]))
    for label, number in summary["counts"].items():
        facts.add_row(label, str(number))
    for name, entry in summary["clearances"].items():
        facts.add_row(f"least clearance, {name}", figure(entry))
    for robot, entry in summary["conditioning"].items():
        facts.add_row(
            f"condition number, {robot}",
            f"worst {condition_text(entry['worst'], 1)} at {entry['t']:.2f} s{_counted(entry)}",
        )
    for part, changes in list(summary.get("parts", {}).items())[:MOST_PARTS]:
        told = (f"{c['robot']} {c['effect']} it{_on(c)} at {c['t']:.2f} s" for c in changes)
        facts.add_row(f"part {part}", ", ".join(told))
    if len(summary.get("parts", {})) > MOST_PARTS:
        facts.add_row("further parts", f"{len(summary['parts']) - MOST_PARTS}, see summary.json")
    for name, value in summary["accuracy"].items():
        facts.add_row(name, f"{value:.2e} mm")

    by_hand = summary.get("by_hand", [])
    for h in by_hand[:MOST_BY_HAND]:
        facts.add_row("by a person", f"{h['robot']}: {h['text']} ({h['t']:.2f} s)")
    if len(by_hand) > MOST_BY_HAND:
        facts.add_row("", f"{len(by_hand) - MOST_BY_HAND} more, see summary.json")

    parts: list[RenderableType] = [head, "", facts, _times(summary)]
    parts += [
        Text(f"warning at {w['t']:.2f} s, {w['robot']}: {w['text']}", "yellow")
        for w in summary["warnings"]
    ]
    return Group(*parts)


MOST_COLUMNS = 4
"""Robots and devices that stand side by side in a table on the screen."""


def _times(summary: Mapping[str, Any]) -> Table:
    """How long activities took, and how long each robot and device worked."""
    # A supervisor of one page has no activities.
    kinds = ("times", "seconds") if summary["activities"] else ()
    times = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    # Of a narrow terminal other columns are broken, but not this word.
    times.add_column("activity" if kinds else "", min_width=len("utilisation"), overflow="fold")
    for kind in kinds:
        times.add_column(kind, justify="right")
    robots = list(summary["robots"])
    shares = [f"{100 * entry['utilisation']:.0f} %" for entry in summary["robots"].values()]
    if len(robots) > MOST_COLUMNS:
        return _by_robot(times, summary, dict(zip(robots, shares, strict=True)))
    for robot in robots:
        times.add_column(f"{robot} busy", justify="right")
    for entry in summary["activities"]:
        times.add_row(
            entry["name"],
            str(entry["times"]),
            f"{entry['seconds']:.2f}",
            *(f"{entry['busy'][robot]:.2f}" for robot in robots),
        )
    times.add_section()
    times.add_row("utilisation", *("" for _ in kinds), *shares)
    return times


def _by_robot(times: Table, summary: Mapping[str, Any], shares: Mapping[str, str]) -> Table:
    """The same with a row for each robot; how long each worked for an activity is in summary.json."""
    if not summary["activities"]:
        times.add_column("utilisation", justify="right")
        for robot, share in shares.items():
            times.add_row(robot, share)
        return times
    for entry in summary["activities"]:
        times.add_row(entry["name"], str(entry["times"]), f"{entry['seconds']:.2f}")
    times.add_section()
    for robot, share in shares.items():
        times.add_row(f"{robot} busy", "", share)
    return times
