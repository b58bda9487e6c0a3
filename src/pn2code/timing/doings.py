"""How long what a transition tells an arm or device takes, from where the arm stands.

    doings = Doings(graph, cell)
    doings.of(element, stand)       # Doing(ns=2_430_112_000, end=Stand(...), ...); None: it tells nothing

Moves are planned by the planner that a run uses, so they take what they take in a run. Durations are whole numbers of
nanoseconds: sums of them are exact.
"""

from __future__ import annotations

import math

from pn2code.base.frozen import frozen
from pn2code.cell.partition import OwnerKind
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.legs import DIGITS_OF_TIME, Planner, Stand
from pn2code.robot.belts import stopping
from pn2code.robot.commands import Command, ToolAction, Wait
from pn2code.robot.robot_cell import RobotCell
from pn2code.semantics.game.token_game import GameError

NS = 1_000_000_000
FOREVER = 10**18
"""Nanoseconds of what never comes to its end."""


@frozen(eq=False)
class Part:
    """One command: from where, and how long it takes (ns).

    Args:
        least: ns: it may be over so soon; None: it always takes `ns`.
    """

    command: Command
    kind: str
    start: Stand | None
    ns: int
    least: int | None = None


@frozen(eq=False)
class Doing:
    """All commands of a transition.

    Args:
        ns: how long they take, at most; FOREVER: they are not done to their end.
        end: where the arm stands afterwards; None: a device.
        parts: each of them; with a fault those before it.
        fault: why not all of them can be carried out.
    """

    ns: int
    end: Stand | None
    parts: tuple[Part, ...]
    fault: str = ""

    @property
    def least(self) -> int:
        """ns: they may be over so soon, as belts come to their stop."""
        return sum(p.ns if p.least is None else p.least for p in self.parts)


class Doings:
    """Works them out, each once.

    Args:
        arms: the owners that have an arm, in the order of the cell's robots.
        why: why not all durations are known; "": they are.
        stops: whether belts come to a stop, so that of some durations only the least and the most is known.
    """

    def __init__(self, graph: CellGraph, cell: RobotCell) -> None:
        self.graph, self.cell = graph, cell
        self.planner = Planner(cell, DIGITS_OF_TIME)
        owners = {o.name: o.index for o in graph.partition.owners}
        self.arms = tuple(owners[r.name] for r in cell.moving)
        self.homes = tuple(self.planner.home(r.name) for r in cell.moving)
        self.arm_of = {owner: i for i, owner in enumerate(self.arms)}
        self.why = ""
        self.stops = False
        self._known: dict[tuple[int, int], Doing | None] = {}
        self._waits: dict[int, int] = {}

    def is_told(self, element: int) -> bool:
        """Whether somebody who is not the supervisor lets it occur."""
        e = self.graph.elements[element]
        if e.is_step or e.owner < 0:
            return False
        return self.graph.partition.owners[e.owner].kind is not OwnerKind.SUPERVISOR

    def of(self, element: int, stand: Stand | None) -> Doing | None:
        """What it takes; None: nothing is told."""
        key = (element, -1 if stand is None else stand.number)
        if key not in self._known:
            self._known[key] = self._worked_out(element, stand)
        return self._known[key]

    def waits(self, element: int) -> int:
        """ns: how long a script waits after this, as its control token has a delay."""
        if element not in self._waits:
            self._waits[element] = self._delay(element)
        return self._waits[element]

    def _delay(self, element: int) -> int:
        if not self.graph.partition.net.timed or not self.is_told(element):
            return 0
        try:
            return max(0, _ns(self.graph.delay(self.graph.elements[element])))
        except GameError:
            self.why = self.why or "waits"
            return 0

    def _worked_out(self, element: int, stand: Stand | None) -> Doing | None:
        e = self.graph.elements[element]
        commands = self.graph.commands(element)
        if not commands:
            return None
        if self.graph.outside.get(e.transition):
            self.why = self.why or "outside"
        parts: list[Part] = []
        for command in commands:
            if stand is not None:
                # Without parts nothing comes to a stop.
                stops = self.cell.parts and stopping(self.cell.robot(stand.robot), command)
                self.stops |= bool(stops)
                leg = self.planner.leg(stand, command)
                if leg.fault is not None or leg.path is None:
                    message = leg.fault.message if leg.fault is not None else ""
                    return Doing(FOREVER, stand, tuple(parts), message)
                least = 0 if stops else None
                parts.append(Part(command, leg.kind, stand, _ns(leg.path.duration), least))
                stand = leg.end
                continue
            fault = self._without_arm(e.owner, command)
            if fault:
                return Doing(FOREVER, None, tuple(parts), fault)
            assert isinstance(command, ToolAction | Wait)
            kind = "tool" if isinstance(command, ToolAction) else "wait"
            parts.append(Part(command, kind, None, _ns(command.duration)))
        return Doing(sum(p.ns for p in parts), stand, tuple(parts))

    def _without_arm(self, owner: int, command: Command) -> str:
        """Why a device, or a robot without an arm in cell.toml, cannot do it; "": it can."""
        who = self.graph.partition.owners[owner]
        if not isinstance(command, ToolAction | Wait):
            if who.kind is OwnerKind.ROBOT:
                self.why = self.why or "armless"
            return f"{who.phrase} has no arm"
        seconds = command.duration
        if not (seconds >= 0.0 and math.isfinite(seconds)):
            return f"{who.phrase}: a duration of {seconds:g} s is not possible"
        return ""


def _ns(seconds: float) -> int:
    return round(seconds * NS)
