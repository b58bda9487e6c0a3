"""Parts while a cell runs: what actions do to them, and whether what is put down overlaps something.

    keeper = PartKeeper(cell, backend)
    keeper.begin()                                             # the parts of the start
    keeper.handle("robot1", handling, T_world_tcp)             # PartChange; PartFault if it cannot be

Only a backend that measures distances can say whether a part overlaps something.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from pn2code.robot.backend import Backend
from pn2code.robot.commands import Handling
from pn2code.robot.lying import overlap
from pn2code.robot.part import Part, PartChange, PartFault
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array


@dataclass(slots=True)
class PartKeeper:
    """The parts of a run, and the backend that shows them."""

    cell: RobotCell
    backend: Backend
    parts: Parts = field(init=False)
    _shown: dict[str, Part] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """The parts of the start; nothing is shown yet."""
        self.parts = Parts(self.cell)

    def begin(self) -> None:
        """Shows the parts of the start. PartFault if one overlaps something."""
        self._show_changed()
        for name in self.parts.present:
            what = f"part `{name}`, as `[parts.{name.split('.')[0]}]` places it,"
            if self.parts.present[name].is_tool:
                what = f"tool `{name}`, at its `rack`,"
            if not self.parts.present[name].holder:
                self._expect_apart(name, what)

    def handle(self, who: str, handling: Handling, tcp: Array | None) -> PartChange:
        """Does to a part what an action does at its end; `tcp`: `T_world_tcp` of a robot.

        Raises PartFault when it is not possible.
        """
        change = self.parts.handle(who, handling, tcp)
        part = self.parts.present.get(change.part)
        if part is None:
            self.backend.remove_part(change.part)
        self._show_changed()
        if part is None:
            return change
        if change.effect == "releases":
            self._expect_apart(part.name, f"`{who}` releases `{part.name}`, which")
            for rider in self.parts.settled:
                if rider.effect == "releases":
                    does = f"`{who}` releases `{part.name}` with `{rider.part}` on it, which"
                    self._expect_apart(rider.part, does)
        elif change.effect == "uncouples":
            self._expect_apart(part.name, f"`{who}` uncouples tool `{part.name}`, which")
        elif change.effect == "creates":
            self._expect_apart(
                part.name, f"`{who}` puts `{part.name}` at `{handling.place}`, which"
            )
        return change

    def run_out(self, line: frozenset[str]) -> tuple[PartChange, ...]:
        """Belts that have run as one come to rest: what stands on something else now.

        PartFault if something has come off their end.
        """
        self.parts.run_out(line)
        self._show_changed()
        return self.parts.settled

    def _show_changed(self) -> None:
        for part in self.parts.present.values():
            if self._shown.get(part.name) is not part:
                self._shown[part.name] = part
                self.backend.set_part(part)

    def _expect_apart(self, name: str, who: str) -> None:
        trouble = overlap(self.backend, name)
        if trouble is not None:
            raise PartFault(f"{who} {trouble.text}")
