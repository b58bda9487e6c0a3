"""Which of the reductions that are asked for a net permits."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.verify import time_reduction
from pn2code.verify.codes import REDUCTION_NOT_POSSIBLE
from pn2code.verify.limits import Reduction
from pn2code.verify.time_reduction import Obstacle

OBSTACLES: dict[Reduction, Callable[[FlatNet], Obstacle | None]] = {
    Reduction.TIME: time_reduction.obstacle,
}
"""What looks for the first thing in a net that is in the way of a reduction."""


def possible(net: FlatNet, wanted: Sequence[Reduction], d: Diagnostics) -> tuple[Reduction, ...]:
    """Those that keep the answers for this net; each of the others gives a warning."""
    found: list[Reduction] = []
    for reduction in wanted:
        obstacle = OBSTACLES[reduction](net)
        if obstacle is None:
            found.append(reduction)
            continue
        d.warning(
            REDUCTION_NOT_POSSIBLE,
            f"the reduction `{reduction.value}` is not possible: {obstacle.message}",
            obstacle.at,
            hint="the whole space is explored",
        )
    return tuple(found)
