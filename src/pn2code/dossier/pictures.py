"""The charts and pictures of a run, for the first page and for paper, on which no replay page can be seen."""

from __future__ import annotations

from pathlib import Path

_CHARTS = {"gantt.png": "who does what when", "clearances.png": "clearances and conditioning"}


def pictures(out: Path, run: str) -> list[tuple[str, str]]:
    """File, as seen from the folder of the report, and what it shows: charts first, then the cell.

    Args:
        out: the folder of the report.
        run: the folder of the run in it.
    """
    found = [
        (f"{run}/{name}", what) for name, what in _CHARTS.items() if (out / run / name).is_file()
    ]
    views = sorted((out / run).glob("picture-*.png"))
    return found + [
        (f"{run}/{v.name}", f"the cell, {v.stem.removeprefix('picture-')}") for v in views
    ]
