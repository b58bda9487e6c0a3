"""What happened in a run beside the net: who did what when, messages, curves, and moments to look at.

described = describe(record, partition, config, limit)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import PurePath
from typing import Any

import numpy as np

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.cell.scalars import message_scalars
from pn2code.channels.scalars import format_scalars
from pn2code.replay.arrays import packed_reals
from pn2code.run.record import ActionRecord, MessageRecord, RunRecord

Json = dict[str, Any]

LEAST_M = 1e-4
"""By how much a clearance may be wrong in a curve, however small it is."""


def describe(record: RunRecord, partition: Partition, config: CellConfig, near: float) -> Json:
    """Parties, their bars, messages, events, curves.

    Args:
        record: the run.
        partition, config: its cell.
        near: what is warned of as a small clearance, m.
    """
    return {
        "parties": [{"name": o.name, "kind": o.kind.value} for o in partition.owners],
        "owners": list(partition.transition_owner),
        "bars": bars(record.actions, partition),
        "activities": [{"name": a.name, "start": a.start, "end": a.end} for a in record.activities],
        "messages": messages(record.traffic, partition),
        "events": _events(record),
        "curves": _curves(record, config, near),
    }


def bars(actions: Iterable[ActionRecord], partition: Partition) -> list[Json]:
    """Commands of robots, done or cut short."""
    transition = {t.name: t.index for t in partition.net.transitions}
    party = {o.name: o.index for o in partition.owners}
    return [
        {
            "party": party[a.robot],
            "kind": a.kind,
            "label": a.label,
            "start": a.start,
            "end": a.end,
            "line": a.line,
            "transition": transition.get(a.transition, -1),
            "activity": a.activity,
        }
        for a in actions
    ]


def messages(traffic: Iterable[tuple[str, MessageRecord]], partition: Partition) -> list[Json]:
    """What robots and devices have taken and written."""
    channels = {PurePath(c.file).stem: c for c in partition.channels}
    rows = []
    for what, m in traffic:
        channel = channels[m.channel]
        scalars = message_scalars(partition.net.places[channel.place].colset) or ()
        text = format_scalars(scalars, m.values) or " ".join(map(str, m.values))
        rows.append(
            {
                "t": m.t,
                "channel": m.channel,
                "place": channel.place,
                "from": channel.writer,
                "to": channel.reader,
                "what": what,
                "text": text,
            }
        )
    return rows


def _events(record: RunRecord) -> list[Json]:
    rows: list[Json] = [
        {"t": w.t, "kind": "warning", "party": w.robot, "text": w.text} for w in record.warnings
    ]
    for line in record.events:
        if (note := noted(line)) is not None:
            rows.append(note)
        elif line.get("event") == "end":
            good = record.verdict == "finished" and not record.failed
            text = record.reason or ", ".join(record.final) or record.verdict
            kind = "end" if good else "fault"
            rows.append({"t": line["t"], "kind": kind, "party": "", "text": text})
    return sorted(rows, key=lambda row: float(row["t"]))


def noted(line: Mapping[str, Any]) -> Json | None:
    """A line of a trace as an event of a robot or device; None: it is none."""
    match line.get("event"):
        case "sense":
            text = f"sensor {line['sensor']}: {line['value']}{_chosen(line)}"
            return {"t": line["t"], "kind": "sense", "party": line["robot"], "text": text}
        case "hold":
            text = f"stands from here on{_chosen(line)}"
            return {"t": line["t"], "kind": "stand", "party": line["robot"], "text": text}
        case "stand":
            began = f" since {line['t'] - line['duration']:.2f} s" if _chosen(line) else ""
            text = f"stands for {line['duration']:.2f} s{began}{_chosen(line)}"
            return {"t": line["t"], "kind": "stand", "party": line["robot"], "text": text}
        case "message":
            late = f" by {line['seconds']:g} s" if "seconds" in line else ""
            text = f"message {line['channel']}: {line['fate']}{late}{_chosen(line)}"
            return {"t": line["t"], "kind": "stand", "party": line["robot"], "text": text}
        case "part":
            text = f"{line['effect']} {line['part']}"
            return {"t": line["t"], "kind": "part", "party": line["robot"], "text": text}
    return None


def _chosen(line: Mapping[str, Any]) -> str:
    return f", chosen by a {line['by']}" if "by" in line else ""


def _curves(record: RunRecord, config: CellConfig, near: float) -> list[Json]:
    rows = []
    for name in sorted(record.series):
        kind, _, of = name.partition(".")
        if kind not in ("clearance", "condition"):
            continue
        values = record.array(name)
        if not np.isfinite(values).any():
            continue
        limit = near if kind == "clearance" else config.report.warn_condition
        t, v = thinned(np.asarray(record.sample_t), values, LEAST_M if kind == "clearance" else 0.0)
        rows.append(
            {
                "kind": kind,
                "of": of,
                "unit": "m" if kind == "clearance" else "",
                "limit": limit,
                "t": packed_reals(t, double=True),
                "v": packed_reals(v),
            }
        )
    return rows


def thinned(t: Any, v: Any, least: float, share: float = 2e-3) -> tuple[Any, Any]:
    """The samples without those that lie between their neighbours, as far as anybody sees it.

    A page writes the values beside its charts, whose axes are logarithmic: so it is a share of each value, or `least`,
    by which what is left may be wrong there, however large others are.
    """
    if len(t) < 3:
        return t, v
    tolerance = np.maximum(share * np.abs(v), max(least, 1e-12))
    keep, last = [0], 0
    low, high = -np.inf, np.inf
    for i in range(1, len(t)):
        span = t[i] - t[last]
        is_odd = not (np.isfinite(v[i]) and np.isfinite(v[last])) or span <= 0
        slope = 0.0 if is_odd else (v[i] - v[last]) / span
        if is_odd or not low <= slope <= high:
            if keep[-1] != i - 1:
                keep.append(i - 1)
            last = i - 1
            span = t[i] - t[last]
            low, high = -np.inf, np.inf
            if not (np.isfinite(v[i]) and np.isfinite(v[last])) or span <= 0:
                keep.append(i)
                last = i
                continue
        low = max(low, (v[i] - tolerance[i] - v[last]) / span)
        high = min(high, (v[i] + tolerance[i] - v[last]) / span)
    if keep[-1] != len(t) - 1:
        keep.append(len(t) - 1)
    return t[keep], v[keep]
