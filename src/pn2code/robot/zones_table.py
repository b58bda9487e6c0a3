"""`[zones]` of cell.toml: boxes in the room.

zones = read_zones(t)
zones["front"].max_speed        # m/s; None: as fast as may be
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.cell_file.scene import ZONE
from pn2code.robot.commands import Pose
from pn2code.robot.table import Table
from pn2code.robot.table_poses import read_pose


@frozen
class Zone:
    """A box.

    Args:
        pose: of its middle in the world; size: full lengths, m.
        max_speed: m/s, that no point of what moves may exceed in it; None: any.
    """

    name: str
    pose: Pose
    size: tuple[float, float, float]
    max_speed: float | None = None


def read_zones(t: Table) -> dict[str, Zone]:
    """The zones; what is wrong is reported."""
    out = {}
    for name, table in t.named(ZONE):
        x, y, z = table.numbers("size")
        pose = read_pose(table, "pose")
        most = table.number("max_speed") if "max_speed" in table.data else None
        table.done()
        out[name] = Zone(name, pose, (x, y, z), most)
    return out
