"""What is said of a cell whose space was not looked in: what the net shows, or the closed net's space does."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from pn2code.base.deadline import NEVER
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller.control_answers import (
    Keeper,
    can_more,
    capacities_check,
    channels_check,
    known,
    unknown,
)
from pn2code.verify.controller.control_messages import formats, memory
from pn2code.verify.controller.control_types import (
    BLOCKING,
    BOUNDED,
    CONFLUENT,
    FINITE,
    Control,
    Plan,
)
from pn2code.verify.controller.ownership import ownership
from pn2code.verify.controller.poses import Poses
from pn2code.verify.controller.reach_check import reach, told_poses
from pn2code.verify.exploring.result import Exploration

NO_BOUNDS: Mapping[int, int] = MappingProxyType({})


def not_looked(
    why: str,
    partition: Partition,
    capacities: Mapping[int, int] | None = None,
    closed: Exploration | None = None,
    poses: Poses | None = None,
    bounds: Mapping[int, int] = NO_BOUNDS,
) -> Control:
    """When there is no space of the cell to look in."""
    nothing = {"answer": "unknown", "why": why}
    checks = [unknown(name, nothing) for name in (FINITE, BOUNDED, CONFLUENT, BLOCKING)]
    declared = capacities or {}
    open_rows = [nothing] * (len(partition.channels) + len(declared))
    rows = [*known(partition, declared, open_rows, closed, bounds)]
    keep = Keeper(Plan(), None)
    if partition.channels:
        checks.append(channels_check(partition, rows[: len(partition.channels)], keep))
    if declared:
        checks.append(capacities_check(partition, declared, rows[len(partition.channels) :], keep))
    seen = closed if closed is not None and can_more(partition) else None
    checks += formats(partition, seen, Plan(), Diagnostics(), why)
    checks.append(memory(seen, why, of_cell=False))
    checks += reach(told_poses(poses, seen, NEVER), partition, seen, None, keep, why)
    return Control(partition, (*checks, ownership(partition)), None, why=why)
