"""Parts that clamps hold: a part in a clamp that is not open cannot be taken away.

    for part, frame in taken_along(robot, q, parts, plates): ...
    for held in holding(cell, kind, T_world_part): held.device, held.clamp
    held.gap(q)                     # m, where the device stands at q

A clamp says where a part is that it holds (`holds`, a place). It holds that part as long as its gap is less than the
greatest one. What the jaws touch is another matter, which distances tell.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from pn2code.base.frozen import frozen
from pn2code.robot.external import Clamp
from pn2code.robot.parts import Part, carried_to
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import CellRobot, RobotCell
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

    def words(self, who: str, part: str, q: Array) -> str:
        """That it cannot, for people."""
        gap, most = 1000.0 * self.gap(q), 1000.0 * self.clamp.axis.upper
        return (
            f"`{who}` pulls `{part}` out of `{self.name}`, which holds it: its gap is {gap:.1f} mm, and it lets go at "
            f"{most:.1f} mm"
        )


def holding(cell: RobotCell, kind: PartKind, T_world_part: Array) -> Iterator[Held]:
    """The clamps in which a part is, whether they are open or not."""
    for device in cell.devices:
        for clamp in device.axes.clamps:
            if clamp.place:
                spot = matrix_of(cell.places[clamp.place])
                if difference(T_world_part, spot)[0] <= kind.tolerance:
                    yield Held(device, clamp)


def taken_along(
    robot: CellRobot, q: Array, parts: Iterable[Part], plates: Collection[str]
) -> Iterator[tuple[Part, Array]]:
    """What a robot or device that begins to move at `q` takes along, and where that is, `T_world_part`.

    That is what its tool holds, and what stands on those of its turntables or belts (`plates`) that move.
    """
    for part in parts:
        if part.holder == robot.name or part.plate in plates:
            yield part, carried_to(robot, q, part)
