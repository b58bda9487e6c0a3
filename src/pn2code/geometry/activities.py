"""What a transition of a robot or device does, from where its arm stands and with the parts that are there then.

doing = Doing(planner, cell)
activity = doing.of("robot1", commands, stand, contents)
activity.legs                   # ((leg, contents while it lasts), ...)
activity.end, activity.after    # where the arm stands afterwards, and the parts
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.legs import Leg, Planner, Stand
from pn2code.geometry.shown import Shown
from pn2code.geometry.sweeps import ROUNDING
from pn2code.robot.commands import Command, Handling, ToolAction
from pn2code.robot.lying import Trouble, overlap, unsupported
from pn2code.robot.parts import Part, PartChange, PartFault, Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import describe

_DIGITS = 6


@frozen(eq=False)
class Contents:
    """Which parts are where.

    Args:
        number: of these contents, among all.
    """

    number: int
    parts: Parts

    @property
    def standing(self) -> dict[str, Part]:
        """Parts that nobody carries, by what makes them equal."""
        return {spot(p): p for p in self.parts.present.values() if not p.holder}

    def held_by(self, robot: str) -> Part | None:
        """What a robot carries."""
        return self.parts.held_by(robot)


def spot(part: Part) -> str:
    """The same for parts of a kind that are in the same place, or in the same hand in the same way."""
    numbers = np.round(part.frame[:3], _DIGITS) + 0.0
    return f"{part.kind.name} {part.holder} {numbers.ravel().tolist()}"


@frozen(eq=False)
class Activity:
    """One transition under way.

    Args:
        legs: each leg with the parts while it lasts.
        end: where the arm stands afterwards; None: a device.
        after: the parts afterwards.
        fault: why it cannot be done to its end; in which leg: the last.
        kinds: the kinds of parts that it handles.
        is_part: the fault is about a part; command: what cannot be done then.
        doubt: why it is not known whether an action can be done; "": it is.
    """

    number: int
    legs: tuple[tuple[Leg, Contents], ...]
    end: Stand | None
    after: Contents
    fault: str = ""
    kinds: frozenset[str] = frozenset()
    is_part: bool = False
    command: Command | None = None
    doubt: str = ""

    @property
    def between(self) -> tuple[Contents, ...]:
        """The parts at each moment."""
        return (*(contents for _, contents in self.legs), self.after)


class Doing:
    """Works activities out, each once.

    Args:
        shown: where what is put down is looked at: does it lie on something, and overlap nothing? None: nowhere.
    """

    def __init__(self, planner: Planner, cell: RobotCell, shown: Shown | None = None) -> None:
        self.planner, self._cell, self._shown = planner, cell, shown
        self._known: dict[tuple[object, ...], Activity] = {}
        self._contents: dict[tuple[str, ...], Contents] = {}
        self._standing: dict[tuple[int, int], Activity] = {}
        self.activities: list[Activity] = []
        self.start = self._kept(Parts(cell))

    def overlaps_at_start(self) -> list[tuple[Part, Trouble]]:
        """Parts of the start that are in something, or perhaps are: such a run ends before it begins."""
        if self._shown is None:
            return []
        parts = self.start.parts.present
        self._shown.show(parts.values())
        found = [(p, overlap(self._shown.backend, p.name, ROUNDING)) for p in parts.values()]
        return [(part, trouble) for part, trouble in found if trouble is not None]

    def _kept(self, parts: Parts) -> Contents:
        key = tuple(sorted(spot(p) for p in parts.present.values()))
        if key not in self._contents:
            self._contents[key] = Contents(len(self._contents), parts)
        return self._contents[key]

    def standing(self, stand: Stand, contents: Contents) -> Activity:
        """An arm that does nothing."""
        key = (stand.number, contents.number)
        if key not in self._standing:
            leg = self.planner.standing(stand)
            self._standing[key] = self._added(Activity(0, ((leg, contents),), stand, contents))
        return self._standing[key]

    def of(
        self, owner: str, commands: tuple[Command, ...], stand: Stand | None, contents: Contents
    ) -> Activity:
        """What an owner does on these commands."""
        key = (owner, commands, None if stand is None else stand.number, contents.number)
        if key not in self._known:
            self._known[key] = self._added(self._worked_out(owner, commands, stand, contents))
        return self._known[key]

    def _added(self, a: Activity) -> Activity:
        made = replace(a, number=len(self.activities))
        self.activities.append(made)
        return made

    def _worked_out(
        self, owner: str, commands: tuple[Command, ...], stand: Stand | None, contents: Contents
    ) -> Activity:
        legs: list[tuple[Leg, Contents]] = []
        doubtful: tuple[str, Command | None] = ("", None)
        kinds = frozenset(
            c.handling.part
            for c in commands
            if isinstance(c, ToolAction) and c.handling is not None
        )
        for command in commands:
            if stand is not None:
                leg = self.planner.leg(stand, command)
                legs.append((leg, contents))
                if leg.fault is not None:
                    return Activity(0, tuple(legs), stand, contents, leg.fault.message, kinds)
                stand = leg.end
            if isinstance(command, ToolAction) and command.handling is not None:
                parts = contents.parts.copy()
                tcp = None
                if stand is not None:
                    base = self._cell.robot(owner).T_world_base
                    tcp = base @ stand.T_base_tcp
                try:
                    change = parts.handle(owner, command.handling, tcp)
                    doubt = self._expect_lying(owner, command.handling, change, parts)
                except PartFault as fault:
                    return Activity(
                        0,
                        tuple(legs),
                        stand,
                        contents,
                        str(fault),
                        kinds,
                        is_part=True,
                        command=command,
                    )
                contents = self._kept(parts)
                if doubt and not doubtful[0]:
                    doubtful = (doubt, command)
        return Activity(
            0,
            tuple(legs),
            stand,
            contents,
            kinds=kinds,
            command=doubtful[1],
            doubt=doubtful[0],
        )

    def _expect_lying(self, who: str, handling: Handling, change: PartChange, parts: Parts) -> str:
        """Whether a part that is put down lies on something and overlaps nothing, as a run looks at it.

        Gives why that is not known; "": it is so.
        Raises PartFault if it is not so.
        """
        if self._shown is None or change.effect not in ("releases", "creates"):
            return ""
        self._shown.show(p for p in parts.present.values() if not p.holder)
        does = f"`{who}` releases `{change.part}`"
        if change.effect == "creates":
            does = f"`{who}` puts `{change.part}` at `{handling.place}`"
        found = [(f"{does}, which", overlap(self._shown.backend, change.part, ROUNDING))]
        if change.effect == "releases":
            hangs = unsupported(self._shown.backend, change.part, ROUNDING)
            found.append((f"{does} in the air:", hangs))
        for what, trouble in found:
            if trouble is not None and trouble.margin < -ROUNDING:
                raise PartFault(f"{what} {trouble.text}, part at {describe(change.pose)}")
        return next(
            (
                f"{what} {x.text}: that is as much as is permitted, to {1000.0 * ROUNDING:g} mm"
                for what, x in found
                if x is not None
            ),
            "",
        )
