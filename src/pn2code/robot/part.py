"""One part of a cell, or a tool that robots couple: where it is, who carries it, and what becomes of it."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.robot.commands import Pose
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array


class PartFault(Exception):
    """An action that cannot be: nothing to grip, nothing to release, a place that is taken."""


@frozen(eq=False)
class Part:
    """One part, or a tool that robots couple.

    Args:
        frame: `T_world_part`; `T_tcp_part` while it is carried, `T_plate_part` while it stands on a turntable. The TCP
            is that of `tool` of the robot, the coupling of one that changes tools, whichever it has.
        holder: the robot that carries it, "" if it stands.
        plate: the turntable with which it turns, "left/plate"; "": with none.
        up: of what stands on the part that its holder carries, what was upwards then, in its frame; None: it does not.
    """

    name: str
    kind: PartKind | ToolKind
    frame: Array
    holder: str = ""
    plate: str = ""
    up: Array | None = None

    @property
    def is_tool(self) -> bool:
        """Whether it is a tool, which stands on nothing and on which nothing stands."""
        return isinstance(self.kind, ToolKind)

    @property
    def carrier(self) -> str:
        """The robot that moves it, with its tool or a turntable; "": it stands still."""
        return self.holder or self.plate.partition("/")[0]


@frozen
class PartChange:
    """What has become of a part.

    Args:
        effect: as in `Handling`, or "settles": what it stood on was taken away; part: its name.
        pose: where it is, or was when it left, in the world.
        on: what it stands on now.
        plate: the turntable with which it turns now, and its pose there.
    """

    effect: str
    part: str
    pose: Pose
    on: tuple[str, ...] = ()
    plate: str = ""
    on_plate: Pose | None = None


def carried_to(robot: CellRobot, q: Array, part: Part) -> Array:
    """`T_world_part` of a part that a robot at `q` carries, in its tool or on a turntable."""
    if part.plate:
        return robot.T_world_plate(robot.plate(part.plate), q) @ part.frame
    return robot.T_world_base @ robot.kinematics.forward(q) @ part.frame
