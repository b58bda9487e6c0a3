"""Charts of a run as PNG: who does what when (Gantt), and clearances and conditioning over time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

from pn2code.base.frozen import frozen

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.patches import Patch
from matplotlib.ticker import NullLocator

from pn2code.report.activities import activities, busy_seconds
from pn2code.run.record import RunRecord

# Colour-blind safe (Okabe and Ito), one colour a kind in every chart.
COLOURS = {
    "joint": "#0072B2",
    "home": "#56B4E9",
    "linear": "#009E73",
    "external": "#E69F00",
    "tool": "#D55E00",
    "measure": "#CC79A7",
    "wait": "#BBBBBB",
}
_DPI = 110


@frozen
class Limits:
    """What a run warns of.

    Args:
        clearance: below this, m.
        condition: above this.
    """

    clearance: float
    condition: float


def draw(record: RunRecord, robots: tuple[str, ...], limits: Limits, out: Path) -> None:
    """All charts into a folder."""
    gantt(record, robots, out / "gantt.png")
    clearances(record, robots, limits, out / "clearances.png")


def gantt(record: RunRecord, robots: tuple[str, ...], path: Path) -> None:
    """A row for each activity with its time, and one for each robot and device with its utilisation."""
    found = activities(record, robots)
    rows = len(found) + len(robots)
    figure, axes = plt.subplots(figsize=(12, 1.7 + 0.42 * rows), layout="constrained")
    whole = max(record.time, 1e-9)
    labels, says = [], []
    for y, activity in enumerate(found):
        for start, end in activity.intervals:
            # What takes no time is a line.
            axes.barh(y, end - start, left=start, height=0.55, color="#8C8C8C", edgecolor="#8C8C8C")
        times = "" if activity.times == 1 else f"{activity.times} times, "
        labels.append(activity.name)
        says.append(f"{times}{activity.seconds:.1f} s")
    for y, robot in enumerate(robots, start=len(found)):
        for action in (a for a in record.actions if a.robot == robot):
            axes.barh(
                y,
                action.end - action.start,
                left=action.start,
                height=0.7,
                color=COLOURS.get(action.kind, "#000000"),
                edgecolor="white",
                linewidth=0.4,
            )
        labels.append(robot)
        says.append(f"{100 * busy_seconds(record, robot) / whole:.0f} % busy")
    if found and robots:
        axes.axhline(len(found) - 0.5, color="#BBBBBB", lw=0.8)
    axes.set_yticks(range(rows), labels)
    axes.set_ylim(rows - 0.4, -0.6)
    axes.set_xlim(0, whole)
    axes.set_xlabel("simulated time [s]")
    for y, text in enumerate(says):
        axes.annotate(
            text,
            (1.0, y),
            xytext=(6, 0),
            textcoords="offset points",
            xycoords=("axes fraction", "data"),
            va="center",
            fontsize=9,
        )
    used = [k for k in COLOURS if any(a.kind == k for a in record.actions)]
    if used:
        handles = [Patch(color=COLOURS[k], label=k) for k in used]
        figure.legend(handles=handles, ncols=len(used), loc="outside lower center", frameon=False)
    axes.grid(visible=True, axis="x", alpha=0.3)
    axes.set_axisbelow(True)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(left=False)
    _save(figure, path)


def clearances(record: RunRecord, robots: tuple[str, ...], limits: Limits, path: Path) -> None:
    """Clearances in mm and condition numbers over time, both logarithmic, with what is warned of.

    Of a run in which no clearances were measured there are only the condition numbers.
    """
    kinds = [n for n in sorted(record.series) if n.startswith("clearance.")]
    figure, parts = plt.subplots(
        1 + bool(kinds),
        1,
        figsize=(12, 7.0 if kinds else 3.8),
        sharex=True,
        layout="constrained",
        squeeze=False,
    )
    drawn = list(parts[:, 0])
    lower = drawn[-1]
    if kinds:
        _clearances(drawn[0], record, kinds, limits)
    conditions: list[float] = []
    for robot in robots:
        values = record.array(f"condition.{robot}")
        if values.size:
            lower.plot(record.sample_t, values, label=robot)
            conditions += values[np.isfinite(values)].tolist()
    _limit(lower, limits.condition, f"warning above {limits.condition:g}")
    lower.set_ylabel("condition number (1 m)")
    _ticks(lower, [*conditions, limits.condition], least=1.0)
    lower.set_xlabel("simulated time [s]")
    for axes in drawn:
        axes.set_xlim(0, max(record.time, 1e-9))
        axes.grid(visible=True, alpha=0.3)
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=9)
        axes.spines[["top", "right"]].set_visible(False)
    _save(figure, path)


def _clearances(axes: Any, record: RunRecord, kinds: list[str], limits: Limits) -> None:
    shown: list[float] = []
    for number, name in enumerate(kinds):
        values = record.array(name) * 1000
        label = _between(name.removeprefix("clearance."))
        # Robots that stand alike have curves on one another: dashes let both be seen.
        style = "-" if number % 2 == 0 else (0, (6, 4))
        axes.plot(record.sample_t, values, label=label, linestyle=style)
        shown += values[np.isfinite(values)].tolist()
    _limit(axes, limits.clearance * 1000, f"warning below {limits.clearance * 1000:g} mm")
    axes.set_ylabel("clearance [mm]")
    _ticks(axes, [*shown, limits.clearance * 1000], least=1.0)


def _between(name: str) -> str:
    """A kind of clearance in words: "scene.robot1"."""
    kind, _, robot = name.partition(".")
    known = {
        "robots": "between robots",
        "scene": f"{robot} to the scene",
        "self": f"{robot} to itself",
    }
    return known.get(kind, name)


def _limit(axes: Any, value: float, says: str) -> None:
    axes.axhline(value, color="#D55E00", linestyle=":", lw=1.5, label=says)


def _ticks(axes: Any, values: list[float], least: float) -> None:
    """A logarithmic axis around the values with plain numbers: 20, 50, 100, 200."""
    low, high = max(min(values), least), max(*values, 2 * least)
    ticks = [m * 10.0**e for e in range(-3, 7) for m in (1, 2, 5)]
    below = [t for t in ticks if t < low]
    above = [t for t in ticks if t > high]
    lower, upper = max(below[-1], least), above[0] if above else ticks[-1]
    axes.set_yscale("symlog", linthresh=least)
    bottom = 0.0 if min(values) < least else lower
    axes.set_ylim(bottom, upper)
    chosen = [t for t in ticks if lower <= t <= upper]
    if bottom == 0.0:
        chosen = [0.0, *chosen]
    axes.set_yticks(chosen, [f"{t:g}" for t in chosen])
    axes.yaxis.set_minor_locator(NullLocator())


def _save(figure: Any, path: Path) -> None:
    # It is laid out here: `savefig` draws a figure that has a layout twice, the first time for nothing.
    figure.set_dpi(_DPI)
    figure.get_layout_engine().execute(figure)
    figure.set_layout_engine(None)
    # No date and no version inside: the same run gives the same bytes.
    figure.savefig(path, dpi=_DPI, metadata={"Software": None})
    plt.close(figure)
