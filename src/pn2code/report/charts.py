"""Charts of a run as PNG: who does what when (Gantt), and clearances and conditioning over time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.patches import Patch

from pn2code.run.record import RunRecord

# Colour-blind safe (Okabe and Ito), one colour a kind in every chart.
COLOURS = {
    "joint": "#0072B2",
    "home": "#56B4E9",
    "linear": "#009E73",
    "tool": "#D55E00",
    "measure": "#CC79A7",
    "wait": "#BBBBBB",
}


def draw(record: RunRecord, robots: tuple[str, ...], out: Path) -> None:
    """All charts into a folder."""
    gantt(record, robots, out / "gantt.png")
    clearances(record, robots, out / "clearances.png")


def gantt(record: RunRecord, robots: tuple[str, ...], path: Path) -> None:
    """Bars per robot and the supervisor's activities above them."""
    figure, axes = plt.subplots(figsize=(12, 1.6 + 0.7 * len(robots)), layout="constrained")
    rows = list(robots)
    for activity_number, activity in enumerate(record.activities):
        shade = "#EEEEEE" if activity_number % 2 else "#DDDDDD"
        axes.axvspan(activity.start, activity.end, color=shade, lw=0)
        width = activity.end - activity.start
        if width > 0.02 * max(record.time, 1e-9):
            axes.text(
                activity.start + width / 2, len(rows) - 0.35, activity.name, ha="center", fontsize=9
            )
    for action in record.actions:
        y = len(rows) - 1 - rows.index(action.robot)
        axes.barh(
            y,
            action.end - action.start,
            left=action.start,
            height=0.6,
            color=COLOURS.get(action.kind, "#000000"),
            edgecolor="white",
            linewidth=0.4,
        )
    axes.set_yticks(range(len(rows)), list(reversed(rows)))
    axes.set_ylim(-0.6, len(rows) - 0.1)
    axes.set_xlim(0, max(record.time, 1e-9))
    axes.set_xlabel("simulated time [s]")
    used = [k for k in COLOURS if any(a.kind == k for a in record.actions)]
    axes.legend(
        handles=[Patch(color=COLOURS[k], label=k) for k in used],
        ncols=len(used),
        loc="upper center",
        bbox_to_anchor=(0.5, -0.28),
        frameon=False,
    )
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(left=False)
    _save(figure, path)


def clearances(record: RunRecord, robots: tuple[str, ...], path: Path) -> None:
    """Clearances (mm, logarithmic above 1 mm) and condition numbers over time."""
    figure, (upper, lower) = plt.subplots(
        2, 1, figsize=(12, 6.5), sharex=True, layout="constrained"
    )
    drawn = False
    for name in sorted(record.series):
        if name.startswith("clearance."):
            upper.plot(
                record.sample_t, record.array(name) * 1000, label=name.removeprefix("clearance.")
            )
            drawn = True
    upper.set_ylabel("clearance [mm]")
    upper.set_yscale("symlog", linthresh=10.0)
    upper.grid(visible=True, alpha=0.3)
    if drawn:
        upper.legend(ncols=3, frameon=False, fontsize=9)
    for robot in robots:
        values = record.array(f"condition.{robot}")
        if values.size:
            lower.plot(record.sample_t, values, label=robot)
    lower.set_ylabel("condition number (1 m)")
    lower.set_yscale("log")
    lower.set_xlabel("simulated time [s]")
    lower.grid(visible=True, which="both", alpha=0.3)
    lower.legend(frameon=False)
    for axes in (upper, lower):
        for number, activity in enumerate(record.activities):
            if number % 2:
                axes.axvspan(activity.start, activity.end, color="#F2F2F2", lw=0)
        axes.spines[["top", "right"]].set_visible(False)
    _save(figure, path)


def _save(figure: Any, path: Path) -> None:
    # No date and no version inside: the same run gives the same bytes.
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
