"""Cells whose supervisor sets registers, see `tools.register_cells`."""

from __future__ import annotations

from random import Random

from tools.register_cells.cells import random_cell


def registers(r: Random) -> tuple[str, str]:
    """A net and its cell."""
    cell = random_cell(r)
    return cell.net, cell.toml
