"""Parts while a cell runs: what actions do to them, and whether what is put down lies on something.

    keeper = PartKeeper(cell, backend)
    keeper.begin()                                             # the parts of the start
    keeper.handle("robot1", handling, T_world_tcp)             # PartChange; PartFault if it cannot be

Only a backend that measures distances can say what a part rests on and whether it overlaps something.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from pn2code.robot.backend import Backend
from pn2code.robot.commands import Handling
from pn2code.robot.parts import PartChange, PartFault, Parts
from pn2code.robot.robot_cell import PART_CONTACT, RobotCell
from pn2code.robot.transforms import Array, describe

REST_GAP = 0.005
"""m: a part that is released may fall so far."""
_SEARCHED = 0.5


@dataclass(slots=True)
class PartKeeper:
    """The parts of a run, and the backend that shows them."""

    cell: RobotCell
    backend: Backend
    parts: Parts = field(init=False)

    def __post_init__(self) -> None:
        """The parts of the start; nothing is shown yet."""
        self.parts = Parts(self.cell)

    def begin(self) -> None:
        """Shows the parts of the start. PartFault if one overlaps something."""
        for part in self.parts.present.values():
            self.backend.set_part(part)
        for name in self.parts.present:
            self._expect_apart(name, f"part `{name}`, as `[parts.{name.split('.')[0]}]` places it,")

    def handle(self, who: str, handling: Handling, tcp: Array | None) -> PartChange:
        """Does to a part what an action does at its end; `tcp`: `T_world_tcp` of a robot.

        Raises PartFault when it is not possible.
        """
        change = self.parts.handle(who, handling, tcp)
        part = self.parts.present.get(change.part)
        if part is None:
            self.backend.remove_part(change.part)
            return change
        self.backend.set_part(part)
        if change.effect == "releases":
            self._expect_apart(part.name, f"`{who}` releases `{part.name}`, which")
            self._expect_rest(who, part.name, change)
        elif change.effect == "creates":
            self._expect_apart(
                part.name, f"`{who}` puts `{part.name}` at `{handling.place}`, which"
            )
        return change

    def _expect_apart(self, name: str, who: str) -> None:
        around = self.backend.around(name, 0.0)
        if around and around[0].distance < -PART_CONTACT:
            depth = -1000.0 * around[0].distance
            raise PartFault(f"{who} is {depth:.1f} mm deep in `{around[0].name}`")

    def _expect_rest(self, who: str, name: str, change: PartChange) -> None:
        around = self.backend.around(name, _SEARCHED)
        if around is None:
            return
        below = [b for b in around if b.is_below]
        if below and below[0].distance <= REST_GAP:
            return
        under = (
            f"`{below[0].name}`, the nearest thing below it, is {1000.0 * below[0].distance:.1f} mm away"
            if below
            else f"there is nothing below it within {1000.0 * _SEARCHED:g} mm"
        )
        raise PartFault(
            f"`{who}` releases `{name}` in the air: {under} (at most {1000.0 * REST_GAP:g} mm), "
            f"part at {describe(change.pose)}"
        )
