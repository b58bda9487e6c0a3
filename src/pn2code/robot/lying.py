"""Whether a part that has been put down overlaps nothing.

    overlap(backend, "box.1")        # Trouble("is 3.0 mm deep in `table` (at most 1 mm)", margin=-0.002) or None

Only a backend that measures distances can say so; of another one the answer is None.
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.robot.backend import Backend
from pn2code.robot.digits import told_apart
from pn2code.robot.robot_cell import PART_CONTACT


@frozen
class Trouble:
    """What is wrong with where a part is.

    Args:
        text: a clause.
        margin: m, negative: by how much it is wrong; else it is so near to being wrong as was asked for.
    """

    text: str
    margin: float


def overlap(backend: Backend, name: str, within: float = 0.0) -> Trouble | None:
    """What a part is in; with `within` (m) also what it is so nearly in."""
    around = backend.around(name, within)
    if not around:
        return None
    margin = around[0].distance + PART_CONTACT
    if margin >= within:
        return None
    depth, most = -1000.0 * around[0].distance, 1000.0 * PART_CONTACT
    shown, _ = told_apart(depth, most)
    return Trouble(f"is {shown} mm deep in `{around[0].name}` (at most {most:g} mm)", margin)
