"""Who runs what in a cell, for those who look at what its programs do."""

from __future__ import annotations

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.division import divided
from pn2code.robot_scripts.translate import lower_robots
from pn2code.verdict.opened import OpenNet


def partition_of(opened: OpenNet, config: CellConfig, d: Diagnostics) -> Partition | None:
    """The net and its owners; None after an error: of programs that `check` refuses nothing is said."""
    partition = divided(opened.flat, config, d)
    if partition is None or lower_robots(partition, config, d) is None or d.has_errors:
        return None
    return partition
