"""How good placings are: what arms reach from there, and how near to limits, singularities and things their ways lead.

    judge = Judge(cell, {"robot2": task}, {"robot2": plan}, free)
    found = judge.look(values)             # (n, numbers) -> Values: reach, condition; all at once, and quickly
    judge.walk(values[0], 0.0)             # Walked: a whole plan, from there

`look` takes of each pose the branch that is best conditioned, so no way is better conditioned than it says.
`walk` plans as runs do, with samples of the ways, one arm at a time with the others at HOME, with the parts in its tool
and all that may stand somewhere meanwhile; which contacts are permitted is the same as in runs. It is a guide for the
search: what is found is looked at as a whole afterwards (`proving`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pn2code.base.frozen import frozen, replace
from pn2code.geometry.placing.free import Free, base_of, moved
from pn2code.geometry.placing.plan import Among, Plan, Walk
from pn2code.geometry.reach_map import Judged, Task, judge
from pn2code.geometry.shown import Shown
from pn2code.robot.backend import Clearance
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import LedContacts, with_move
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array, matrix_of

FAR = 0.5
"""m: larger clearances are not measured."""
_TOUCHING = 1e-3
"""m: nearer to itself an arm need not be measured."""


@frozen(eq=False)
class Values:
    """Of n placings, over all arms that move.

    Args:
        reach: the part of the task that is reached, 0 to 1.
        condition: the worst condition number, each pose in the branch that is best.
        robots: what is known of each arm.
    """

    reach: Array
    condition: Array
    robots: Mapping[str, Judged]


@frozen
class Walked:
    """What arms do from a placing.

    Args:
        done: the part of the commands that could be planned, 0 to 1.
        condition: the worst condition number; limit: rad, the least margin of a limit; see `Walk.counts`.
        clearance: m, the least distance from the scene and from arms at HOME, at most `FAR`; not above zero if an arm
            touches itself, or a part that stands. What may touch does not count, unless it is deeper than permitted.
        seconds: how long all commands together take.
    """

    done: float
    condition: float
    limit: float
    clearance: float
    seconds: float


class Judge:
    """Looks at placings of a cell.

    Args:
        cell: as it stands.
        tasks: of each arm that may be moved what it has to reach; plans: what it is told.
        free: the numbers that placings choose.
    """

    def __init__(
        self,
        cell: RobotCell,
        tasks: Mapping[str, Task],
        plans: Mapping[str, Plan],
        free: Sequence[Free],
    ) -> None:
        self.cell, self.tasks, self.plans, self.free = cell, dict(tasks), dict(plans), tuple(free)
        self._moved = frozenset(f.robot for f in self.free)
        self._backend = BulletBackend(cell, looks=False)
        self._shown = Shown(self._backend)
        self._led = LedContacts(cell)
        self.reached: dict[str, NDArray[np.bool_]] = {}
        """of each arm, what it has reached from any placing that was looked at"""
        self.forget()

    def close(self) -> None:
        """Ends the collision library."""
        self._backend.close()

    def forget(self) -> None:
        """What was reached up to now does not count."""
        self.reached = {n: np.zeros(len(task.groups), bool) for n, task in self.tasks.items()}

    def look(self, values: Array) -> Values:
        """What is reached, and how well."""
        robots: dict[str, Judged] = {}
        count = len(values)
        groups, reached = 0, np.zeros(count)
        condition = np.zeros(count)
        for name, task in self.tasks.items():
            if not task.groups:
                continue  # joint positions are reached from everywhere
            bases = [matrix_of(base_of(self.cell, name, self.free, row)) for row in values]
            found = judge(self.cell.robot(name), task, np.stack(bases))
            robots[name] = found
            self.reached[name] |= found.reached.any(axis=0)
            reached += found.reached.sum(axis=1)
            groups += len(task.groups)
            condition = np.maximum(condition, found.condition)
        reach = reached / groups if groups else np.ones(count)
        return Values(reach, np.maximum(condition, 1.0), robots)

    def walk(self, values: Sequence[float], enough: float) -> Walked:
        """All that is done from a placing.

        Args:
            values: of the numbers that are free.
            enough: m; where the clearance is less it need not be the least one.
        """
        placed = moved(self.cell, self.free, values)
        condition, limit, seconds = 1.0, math.inf, 0.0
        walks = {name: plan.walk(placed.robot(name), placed) for name, plan in self.plans.items()}
        for name, walk in walks.items():
            kinematics = placed.robot(name).kinematics
            seconds += walk.seconds
            q = walk.q[walk.counts]
            if len(q):
                off = kinematics.turning_margins(q)
                limit = min(limit, float(off.min()))
                found = kinematics.conditioning_many(q)
                condition = max(condition, *(c.condition for c in found))
        count = sum(len(plan.steps) for plan in self.plans.values())
        done = sum(walk.done for walk in walks.values()) / count if count else 1.0
        clearance = self._clearance(placed, walks, enough) if done >= 1.0 else -math.inf
        return Walked(done, condition, limit, clearance, seconds)

    def _clearance(self, placed: RobotCell, walks: Mapping[str, Walk], enough: float) -> float:
        if not any(placed.robot(name).axes.tables for name in self._moved):
            for robot in placed.robots:
                self._backend.set_base(robot.name, robot.base)
                self._backend.set_joints(robot.name, robot.home)
            return self._least(self._shown, placed, walks, enough)
        # Seen from a base that is elsewhere its turntables are, too: the collision library has to build them anew.
        backend = BulletBackend(placed, looks=False)
        try:
            return self._least(Shown(backend), placed, walks, enough)
        finally:
            backend.close()

    def _least(
        self, shown: Shown, placed: RobotCell, walks: Mapping[str, Walk], enough: float
    ) -> float:
        backend, least = shown.backend, FAR
        for name, walk in walks.items():
            for way in walk.ways:
                for among in way.among:
                    shown.show(among.parts.values())
                    seen = _Seen(placed, name, way.ends, among)
                    rows = walk.q[way.rows]
                    for at, row in zip(
                        np.linspace(0.0, 1.0, len(rows)).tolist(), rows, strict=True
                    ):
                        backend.set_joints(name, row)
                        now = replace(seen, at=at)
                        least = min(least, self._standing(backend, now, least))
                        if least <= 0.0 or least < enough:
                            return least
            backend.set_joints(name, placed.robot(name).home)
        return least

    def _standing(self, backend: BulletBackend, seen: _Seen, limit: float) -> float:
        # What a moved arm stands on stays where the cell has it in the collision library.
        stays = self._moved if backend is self._backend else ()
        own = {f"{robot}_{what}" for robot in stays for what in ("pedestal", "rail")}
        things = {t for t in backend.things if t not in own}
        things |= seen.names
        pairs, name = backend.distances.pairs, seen.robot
        if any(self._counted(gap, seen) <= 0.0 for gap in pairs("self", name, _TOUCHING)):
            return 0.0
        found = pairs("scene", name, limit, only=things)
        for other in self.cell.robots:
            if other.name != name:
                found += pairs("robots", name, limit, other.name)
        return min((self._counted(gap, seen) for gap in found), default=limit)

    def _counted(self, gap: Clearance, seen: _Seen) -> float:
        """On a joint move nothing may touch; else what may touch does not count.

        How far parts that stand are from what is carried past them the net says, not where the arm stands.
        """
        allowed = gap.permitted(is_free=seen.ends is None or not seen.ends.is_path)
        if allowed is not None:
            led = self._led.of_pair(
                gap.a,
                gap.b,
                seen.ends_of,
                seen.among.parts,
                seen.stands,
                lambda _: (seen.at, seen.at),
            )
            allowed = with_move(gap, led).allowed
        if allowed is None:
            is_part = gap.b in seen.names
            return FAR if is_part and gap.distance > 0.0 else gap.distance
        return FAR if gap.distance + allowed >= 0.0 else gap.distance


@frozen(eq=False)
class _Seen:
    """A robot on its way, at a fraction of it, and the parts around it."""

    cell: RobotCell
    robot: str
    ends: MoveEnds | None
    among: Among
    at: float = 0.0

    @property
    def names(self) -> frozenset[str]:
        """Of the parts that stand."""
        return frozenset(p.name for p in self.among.standing)

    def ends_of(self, robot: str) -> MoveEnds | None:
        """All others stand."""
        return self.ends if robot == self.robot else None

    def stands(self, robot: str) -> Array:
        """Where another one stands."""
        return np.array(self.cell.robot(robot).home)
