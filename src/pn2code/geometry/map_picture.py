"""The map of bases as a picture: three panels with the same axes."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np

from pn2code.geometry.reach_map import Map, Task
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array

matplotlib.use("Agg")

import matplotlib.pyplot as plt

MOST_CONDITION = 100.0
"""Of the colours."""


def draw(found: Map, task: Task, cell: RobotCell, name: str, path: Path) -> None:
    """Writes the picture: reach, conditioning and limits over the places of the base, with the arms as they stand."""
    side = round(len(found.bases) ** 0.5)
    x, y = (found.bases[:, i].reshape(side, side) for i in (0, 1))
    whole = (found.reach >= 1.0).reshape(side, side)
    panels = (
        ("part of the task that is reached, %", 100.0 * found.reach, 0.0, 100.0, "viridis"),
        (
            "worst condition number (all is reached)",
            np.where(found.reach >= 1.0, np.minimum(found.condition, MOST_CONDITION), np.nan),
            None,
            None,
            "viridis_r",
        ),
        (
            "least margin of a limit, degrees (all is reached)",
            np.where(found.reach >= 1.0, np.degrees(found.limit), np.nan),
            0.0,
            None,
            "viridis",
        ),
    )
    figure, axes = plt.subplots(1, 3, figsize=(15, 5), layout="constrained")
    for ax, (title, values, low, high, colours) in zip(axes, panels, strict=True):
        grid: Array = values.reshape(side, side)
        shown = ax.pcolormesh(x, y, grid, vmin=low, vmax=high, cmap=colours, shading="nearest")
        figure.colorbar(shown, ax=ax, shrink=0.8)
        if whole.any() and not whole.all():
            ax.contour(x, y, whole.astype(float), levels=[0.5], colors="#D55E00", linewidths=1.2)
        ax.plot(*task.poses[:, :2, 3].T, ".", color="#CC79A7", markersize=4)
        for robot in cell.robots:
            mark = "*" if robot.name == name else "s"
            ax.plot(robot.base.x, robot.base.y, mark, color="black", markersize=9)
            ax.annotate(
                robot.name, (robot.base.x, robot.base.y), xytext=(6, 6), textcoords="offset points"
            )
        ax.set_xlim(x.min(), x.max())
        ax.set_ylim(y.min(), y.max())
        ax.set_title(title, fontsize=10)
        ax.set_xlabel("x of the base, m")
        ax.set_aspect("equal")
    axes[0].set_ylabel("y of the base, m")
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
