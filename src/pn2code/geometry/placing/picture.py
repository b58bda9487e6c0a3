"""The placings than which no other one is better in everything (the Pareto front), as a picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib

from pn2code.geometry.placing.search import Candidate

matplotlib.use("Agg")

import matplotlib.pyplot as plt


def draw(front: Sequence[Candidate], here: Candidate, chosen: Candidate | None, path: Path) -> None:
    """Conditioning against clearance, coloured by the margin of the limits; where the arms stand, and the choice."""
    figure, ax = plt.subplots(figsize=(8, 5.5), layout="constrained")
    shown = ax.scatter(
        [c.condition for c in front],
        [1000.0 * c.clearance for c in front],
        c=[math.degrees(c.limit) for c in front],
        cmap="viridis",
        s=26,
        label="no other one is better in everything",
    )
    figure.colorbar(shown, ax=ax, label="least margin of a limit, degrees")
    if here.reach >= 1.0 and math.isfinite(here.clearance):
        ax.plot(
            here.condition,
            1000.0 * here.clearance,
            "s",
            color="black",
            markersize=8,
            label="as they stand",
        )
        if front and here.condition > 3.0 * min(c.condition for c in front):
            ax.set_xscale("log")
    if chosen is not None:
        ax.plot(
            chosen.condition,
            1000.0 * chosen.clearance,
            "*",
            color="#D55E00",
            markersize=16,
            label="chosen, and proved",
        )
    ax.set_xlabel("worst condition number on lines and where joint moves end")
    ax.set_ylabel("least clearance from what stands, mm")
    ax.grid(visible=True, alpha=0.3)
    ax.legend(loc="best", fontsize=9)
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
