"""Parts that clamps hold: a part in a clamp that is not open cannot be taken away, and a clamp closes on a part.

    for part, frame in taken_along(robot, q, parts, plates): ...
    for held in holding(cell, kind, T_world_part): held.device, held.clamp
    held.gap(q)                     # m, where the device stands at q
    for clamp in closing(device, before, after): nearest(cell, clamp, [(part, T_world_part), ...])

A clamp says where a part is that it holds (`holds`, a place). It holds that part as long as its gap is less than the
greatest one. What the jaws touch is another matter, which distances tell.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator

from pn2code.base.frozen import frozen
from pn2code.robot.commands import Command, MoveExternal
from pn2code.robot.external import Clamp
from pn2code.robot.part import Part, carried_to
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, difference, matrix_of

SAME = 1e-6
"""m: so much less than open is open."""


@frozen(eq=False)
class Held:
    """A clamp in which a part is."""

    device: CellRobot
    clamp: Clamp

    @property
    def name(self) -> str:
        """As in messages."""
        return f"{self.device.name}/{self.clamp.axis.name}"

    def gap(self, q: Array) -> float:
        """Between its jaws, m."""
        return float(sum(q[self.device.index(jaw)] for jaw in self.clamp.jaws))

    def holds(self, q: Array) -> bool:
        """Whether the part can be taken away."""
        return self.gap(q) < self.clamp.axis.upper - SAME

    def is_at(self, cell: RobotCell, kind: PartKind | ToolKind, T_world_part: Array) -> bool:
        """Whether a part is where the clamp holds one."""
        spot = matrix_of(cell.places[self.clamp.place])
        return difference(T_world_part, spot)[0] <= kind.tolerance

    def words(self, who: str, part: str, q: Array, does: str = "pulls") -> str:
        """That it cannot, for people."""
        gap, most = 1000.0 * self.gap(q), 1000.0 * self.clamp.axis.upper
        return (
            f"`{who}` {does} `{part}` out of `{self.name}`, which holds it: its gap is {gap:.1f} mm, and it lets go at "
            f"{most:.1f} mm"
        )


def holding(cell: RobotCell, kind: PartKind | ToolKind, T_world_part: Array) -> Iterator[Held]:
    """The clamps in which a part is, whether they are open or not."""
    for device in cell.devices:
        for clamp in device.axes.clamps:
            if clamp.place:
                held = Held(device, clamp)
                if held.is_at(cell, kind, T_world_part):
                    yield held


def taken_along(
    robot: CellRobot, q: Array, parts: Iterable[Part], plates: Collection[str]
) -> Iterator[tuple[Part, Array]]:
    """What a robot or device that begins to move at `q` takes along, and where that is, `T_world_part`.

    That is what its tool holds, but not the tool itself, and what stands on those of its turntables or belts (`plates`)
    that move.
    """
    for part in parts:
        if (part.holder == robot.name and not part.is_tool) or part.plate in plates:
            yield part, carried_to(robot, q, part)


def closed_on(
    cell: RobotCell,
    held: Held,
    robot: CellRobot,
    way: tuple[Array, Array],
    going: tuple[Iterable[Part], Collection[str]],
) -> str:
    """That a clamp has closed on a part with which a robot is on its way, for people; "": it has not.

    One that may be empty only lets nothing out that was in it before.

    Args:
        way: where the robot stood when it began, and where it is now.
        going: the parts of the cell, and the robot's turntables and belts that move.
    """
    for part, frame in taken_along(robot, way[0], *going):
        places = [carried_to(robot, way[1], part)]
        if held.clamp.may_be_empty:
            places.append(frame)
        if all(held.is_at(cell, part.kind, x) for x in places):
            return f"`{held.name}` closes on `{part.name}` while `{robot.name}` takes that along"
    return ""


@frozen(eq=False)
class Near:
    """The part that is nearest to where a clamp holds one; None: there is none. off: m, by how much it is too far."""

    part: Part | None
    off: float


def closes(device: CellRobot, command: Command) -> bool:
    """Whether a command may close a clamp that must not be empty."""
    if not isinstance(command, MoveExternal):
        return False
    told = {a.axis for a in command.along}
    return any(c.axis.name in told for c in device.axes.clamps if c.place and not c.may_be_empty)


def shut(device: CellRobot, before: Array, after: Array) -> Iterator[Held]:
    """The clamps that a move closes, of which it is known where the part is that they hold."""
    for clamp in device.axes.clamps:
        held = Held(device, clamp)
        is_closing = held.gap(after) < held.gap(before) - SAME
        if clamp.place and is_closing and held.holds(after):
            yield held


def closing(device: CellRobot, before: Array, after: Array) -> Iterator[Held]:
    """Those of them that must not be empty then."""
    return (held for held in shut(device, before, after) if not held.clamp.may_be_empty)


def nearest(cell: RobotCell, held: Held, parts: Iterable[tuple[Part, Array]]) -> Near:
    """The part that a clamp closes on, if it is not too far, of parts with their frames in the world."""
    spot = matrix_of(cell.places[held.clamp.place])
    offs = [(difference(frame, spot)[0] - p.kind.tolerance, p) for p, frame in parts]
    off, part = min(offs, key=lambda x: x[0], default=(math.inf, None))
    return Near(part, off)


def on_nothing(held: Held, near: Near) -> str:
    """That a clamp closes and there is no part, for people."""
    text = f"`{held.name}` closes on nothing: no part is at `{held.clamp.place}`"
    if near.part is None:
        return text
    away = 1000.0 * (near.off + near.part.kind.tolerance)
    held_by = f" in the tool of `{near.part.holder}`," if near.part.holder else ""
    return f"{text}; the nearest, `{near.part.name}`,{held_by} is {away:.1f} mm away"
