"""What happened in a run, as plain data: the engine fills it, the reports read it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pn2code.base.frozen import frozen, record
from pn2code.robot.backend import Clearance
from pn2code.robot.monitor import Verdict
from pn2code.robot.part import PartChange

FloatArray = npt.NDArray[np.float64]

NEAR = 0.12
"""m: clearances below this are kept with their points, to be shown."""
SAME, STILL = 5e-5, 0.005
"""m: a gap is noted anew when it has changed by more than the first, or one of its ends has moved by the second."""
APART = 1.0
"""m: the distance of a gap that is no longer near, whatever it is."""


@frozen
class ActionRecord:
    """One command of a robot, done or cut short.

    Args:
        robot: its name.
        kind: one of `command_words.KINDS`.
        label: what a chart writes: the tool action, or the kind.
        start, end: seconds.
        line: line of the script.
        transition: name of the net transition that the line implements, "" if none.
        activity: the supervisor's activity that ordered it, "" if none.
    """

    robot: str
    kind: str
    label: str
    start: float
    end: float
    line: int
    transition: str
    activity: str


@frozen
class MessageRecord:
    """A message consumed by its reader: time, channel name, scalars."""

    t: float
    channel: str
    values: tuple[float | int | str | bool, ...]


@frozen
class PartRecord:
    """What has become of a part: time (s), robot or device, what it did."""

    t: float
    robot: str
    change: PartChange


@frozen
class ActivityRecord:
    """One activity of the supervisor: from its first to its last firing before the next activity begins."""

    name: str
    start: float
    end: float


@frozen
class BrokenZone:
    """Something was faster in a zone than may be there: when, which link, how fast (m/s), and the point of it (m)."""

    zone: str
    t: float
    link: str
    speed: float
    point: tuple[float, float, float]

    def described(self) -> dict[str, Any]:
        """For `summary.json` and the replay page, whose clock may end at this very moment: it is not rounded."""
        return {
            "t": self.t,
            "link": self.link,
            "speed": round(self.speed, 6),
            "point": [round(v, 6) for v in self.point],
        }


@frozen
class Interference:
    """What a person at the page has done to the run, in words."""

    t: float
    robot: str
    text: str


@frozen
class RunWarning:
    """Something that a person should look at, though the run went on."""

    t: float
    robot: str
    text: str


@record
class RunRecord:
    """A whole run.

    Args:
        verdict: "finished", "stopped" (somebody stopped the cell safely) or "failed" (a collision,
        an unreachable pose, ...).
        reason: why, when not finished.
        final: the final places that hold a token at the end, when finished.
        failed: those of them that mean that the cell has failed.
        time: simulated seconds.
        events: lines of the merged trace after the header.
        header: the header line of the merged trace.
        series: sampled quantities: name -> array of the length of `sample_t`; names are e.g. "clearance.robots",
            "clearance.scene.robot1" (m), "condition.robot2", "margin.robot1" (rad).
        near: see below; accuracy: deviation -> greatest value in mm.
    """

    cell: str
    layout: str
    backend: str
    verdict: str = "failed"
    reason: str = ""
    final: tuple[str, ...] = ()
    failed: tuple[str, ...] = ()
    time: float = 0.0
    wall: float = 0.0
    header: dict[str, Any] = field(default_factory=dict)
    events: list[dict[str, Any]] = field(default_factory=list)
    actions: list[ActionRecord] = field(default_factory=list)
    messages: list[MessageRecord] = field(default_factory=list)
    traffic: list[tuple[str, MessageRecord]] = field(default_factory=list)
    """what was "taken" and "written" by robots and devices, in order"""
    parts: list[PartRecord] = field(default_factory=list)
    activities: list[ActivityRecord] = field(default_factory=list)
    warnings: list[RunWarning] = field(default_factory=list)
    by_hand: list[Interference] = field(default_factory=list)
    """what a person has chosen or done"""
    sample_t: list[float] = field(default_factory=list)
    series: dict[str, list[float]] = field(default_factory=dict)
    accuracy: dict[str, float] = field(default_factory=dict)
    pictures: dict[str, list[str]] = field(default_factory=dict)
    """of each picture that was taken, by the name of its file: the moments that look like it"""
    too_fast: BrokenZone | None = None
    """what has stopped the cell, when that was a zone"""
    near: dict[tuple[str, str], tuple[float, float]] = field(default_factory=dict)
    """pairs of parts that came closer than the scene's warning distance: least distance (m) and when"""
    least: dict[str, Clearance] = field(default_factory=dict)
    """of each series of clearances the nearest two things, where they were nearest first"""
    gaps: list[tuple[float, Clearance]] = field(default_factory=list)
    """which parts are closer than `NEAR` from when on, until the next note of the pair; `APART` ends it"""
    _standing: dict[tuple[str, str], Clearance] = field(default_factory=dict)

    def sample(self, verdict: Verdict) -> None:
        """Adds one instant to the series."""
        self.sample_t.append(verdict.t)
        arms = [s for s in verdict.samples if not s.is_device]
        nearest: dict[str, float] = {}
        for gap in verdict.clearances or ():
            if gap.counts:
                name = f"clearance.{gap.kind}" + ("" if gap.kind == "robots" else f".{gap.robot}")
                nearest[name] = min(nearest.get(name, np.inf), gap.distance)
                if name not in self.least or gap.distance < self.least[name].distance:
                    self.least[name] = gap
        if verdict.clearances is not None:
            names = ["clearance.robots"]
            names += [f"clearance.{k}.{s.robot}" for s in arms for k in ("scene", "self")]
            for name in names:
                # Not measured beyond the monitor's search distance: a gap in the curve.
                self.series.setdefault(name, []).append(nearest.get(name, np.nan))
        for seen in arms:
            self.series.setdefault(f"condition.{seen.robot}", []).append(
                seen.conditioning.condition
            )
            self.series.setdefault(f"elbow.{seen.robot}", []).append(seen.conditioning.elbow)
            self.series.setdefault(f"wrist.{seen.robot}", []).append(seen.conditioning.wrist)
            self.series.setdefault(f"margin.{seen.robot}", []).append(seen.limit_margin)
        devices = {s.robot for s in verdict.samples if s.is_device}
        # What a device is fixed to is always near.
        self._note_gaps(
            verdict.t,
            [
                gap
                for gap in (*(verdict.clearances or ()), *verdict.warnings)
                if gap.kind == "robots" or gap.robot not in devices or gap.distance < 0.0
            ],
        )
        for gap in verdict.warnings:
            key = (gap.a, gap.b)
            if gap.distance < self.near.get(key, (np.inf, 0.0))[0]:
                self.near[key] = (gap.distance, verdict.t)

    def _note_gaps(self, t: float, measured: Collection[Clearance]) -> None:
        """Keeps what is near, and what is in the way, when it begins, changes and ends."""
        near: dict[tuple[str, str], Clearance] = {}
        for gap in measured:
            if gap.counts and gap.distance <= NEAR:
                pair = (gap.a, gap.b)
                if pair not in near or gap.distance < near[pair].distance:
                    near[pair] = gap
        for pair in [pair for pair in self._standing if pair not in near]:
            self.gaps.append((t, replace(self._standing.pop(pair), distance=APART)))
        for pair, gap in near.items():
            last = self._standing.get(pair)
            if last is None or not _is_same(last, gap):
                self._standing[pair] = gap
                self.gaps.append((t, gap))

    def note_error(self, what: str, metres: float) -> None:
        """Keeps the greatest deviation of a kind, in mm."""
        self.accuracy[what] = max(self.accuracy.get(what, 0.0), metres * 1000.0)

    def array(self, name: str) -> FloatArray:
        """A series as an array; empty if it was not sampled."""
        return np.asarray(self.series.get(name, []), dtype=np.float64)


def _is_same(one: Clearance, two: Clearance) -> bool:
    """Whether nobody who looks sees that it is another one."""
    ends = zip((*one.point, *one.other), (*two.point, *two.other), strict=True)
    return abs(one.distance - two.distance) <= SAME and all(abs(a - b) <= STILL for a, b in ends)


def row_values(messages: list[MessageRecord], channel: str) -> list[tuple[float, ...]]:
    """The messages of one channel as rows of numbers, in order."""
    return [
        tuple(float(v) for v in m.values if not isinstance(v, str))
        for m in messages
        if m.channel == channel
    ]


def merged_rows(
    messages: list[MessageRecord], channels: tuple[str, ...]
) -> list[tuple[float, ...]]:
    """Row k: the k-th message of each channel, side by side; as many rows as the shortest channel has."""
    columns = [row_values(messages, c) for c in channels]
    return [tuple(v for part in row for v in part) for row in zip(*columns, strict=False)]


def fixed4(value: float) -> str:
    """Four decimals, never a negative zero."""
    text = f"{value:.4f}"
    return "0.0000" if text == "-0.0000" else text


def summary_counts(
    record: RunRecord, count: Mapping[str, str], occurrences: Mapping[str, Collection[str]]
) -> dict[str, int]:
    """How often each counted tool action was completed, and each counted transition occurred.

    Args:
        record: the run.
        count: label -> tool action.
        occurrences: label -> the whole paths of the transitions that are counted together.
    """
    names = Counter(e["transition"] for e in record.events if "transition" in e)
    return {
        label: sum(a.kind == "tool" and a.label == action for a in record.actions)
        for label, action in count.items()
    } | {label: sum(names[path] for path in set(paths)) for label, paths in occurrences.items()}
