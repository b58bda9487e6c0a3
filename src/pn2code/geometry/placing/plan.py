"""All that an arm is told, as a tree: each command with the one after which it comes, to be planned from another base.

    plan = Plan.of(planner.legs, "robot2", parts_of(situations, "robot2"))
    walk = plan.walk(robot_elsewhere, cell)     # Walk: paths, how long they take; or a fault

The planner is that of runs: the same branches, lines and faults. A place to which several commands lead is reached
through one of them, and parts are where they are as the arms stand now; so the walk is a guide, and all of it is looked
at when a base is proved.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from types import MappingProxyType

import numpy as np

from pn2code.base.frozen import frozen, replace
from pn2code.geometry.contents import Load, spots
from pn2code.geometry.legs import Leg
from pn2code.geometry.part_names import held, on_plate, standing
from pn2code.geometry.situations import Situations
from pn2code.robot.active_motion import PATHS
from pn2code.robot.commands import Command, MoveAxes, MoveHome
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.part import Part
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.trajectories import Still
from pn2code.robot.transforms import Array

_SAMPLES = 9
"""Places on the way of each move."""


@frozen(eq=False)
class Among:
    """Parts that may be there during a command, each with a name of its own.

    Args:
        load: what the arm moves; standing: in some situation or other.
    """

    load: Load = ()
    standing: Load = ()

    @property
    def parts(self) -> dict[str, Part]:
        """All of them, by name."""
        return {p.name: p for p in (*self.load, *self.standing)}


NONE = Among()
"""No parts."""


@frozen(eq=False)
class Step:
    """A command.

    Args:
        after: the number of the step after which it comes, -1: from HOME.
        among: by what the arm carries then, in one way or another.
    """

    after: int
    command: Command
    among: tuple[Among, ...] = (NONE,)


@frozen(eq=False)
class Way:
    """Some rows of a walk.

    Args:
        ends: of the move; None: it is HOME.
        among: as of its step.
    """

    rows: slice
    ends: MoveEnds | None
    among: tuple[Among, ...]


@frozen(eq=False)
class Walk:
    """What an arm does from a base.

    Args:
        q: joint positions on all of its ways, (n, axes), HOME first.
        ways: all of these rows, by what they belong to.
        counts: of each, whether it shows how well the arm stands: on lines and arcs, and where joint moves end.
            HOME and given joint positions are the same from everywhere. What lies between such places lies between
            their limits, and conditioning is of no concern there.
        seconds: how long all commands together take.
        done: so many commands could be planned; fault: why not the next one.
    """

    q: Array
    ways: tuple[Way, ...]
    counts: Array
    seconds: float
    done: int
    fault: MotionFault | None


@frozen(eq=False)
class Plan:
    """What an arm is told."""

    steps: tuple[Step, ...]

    @staticmethod
    def of(
        legs: Iterable[Leg],
        robot: str,
        among: Mapping[int, tuple[Among, ...]] = MappingProxyType({}),
    ) -> Plan:
        """From legs in the order in which they were planned; `among`: the parts, by the numbers of legs."""
        after: dict[int, int] = {}
        steps: list[Step] = []
        for leg in legs:
            if leg.robot != robot or leg.command is None:
                continue
            own = among.get(leg.number, (NONE,))
            steps.append(Step(after.get(leg.start.number, -1), leg.command, own))
            if leg.end is not leg.start:
                after.setdefault(leg.end.number, len(steps) - 1)
        return Plan(tuple(steps))

    def with_more(self, other: Plan) -> Plan:
        """Both, one after the other."""
        more = (
            replace(step, after=step.after + len(self.steps)) if step.after >= 0 else step
            for step in other.steps
        )
        return Plan((*self.steps, *more))

    def walk(self, robot: CellRobot, cell: RobotCell) -> Walk:
        """Plans everything from where the robot stands."""
        executor = RobotExecutor(robot, cell.motion, cell.frames)
        home = (executor.q, executor.T_base_tcp, executor.tool)
        ends: list[tuple[Array, Array, str]] = []
        rows, ways, counts = [np.array(home[0])[None]], [Way(slice(0, 1), None, (NONE,))], [False]
        seconds = 0.0
        for step in self.steps:
            executor.stand(*(ends[step.after] if step.after >= 0 else home))
            tool = executor.tool
            try:
                motion = executor.begin(step.command, 0.0)
            except MotionFault as fault:
                q = np.concatenate(rows)
                return Walk(q, tuple(ways), np.array(counts), seconds, len(ends), fault)
            executor.finish()
            ends.append((np.array(executor.q), np.array(executor.T_base_tcp), executor.tool))
            path = motion.trajectory
            seconds += path.duration
            if not isinstance(path, Still):
                rows.append(path.on_way(np.linspace(0.0, 1.0, _SAMPLES)))
                is_path = motion.kind in PATHS
                both = MoveEnds.of(robot, tool, path, motion.kind)
                ways.append(Way(slice(len(counts), len(counts) + _SAMPLES), both, step.among))
                counts += [is_path] * (_SAMPLES - 1)
                counts.append(not isinstance(step.command, MoveHome | MoveAxes))
        q = np.concatenate(rows)
        return Walk(q, tuple(ways), np.array(counts), seconds, len(ends), None)


def parts_of(found: Situations, robot: str) -> dict[int, tuple[Among, ...]]:
    """By the numbers of legs what the arm moves on it, in one way or another, and what stands somewhere meanwhile."""
    parts = found.parts() if found.beside else {}
    loads: dict[int, dict[str, Load]] = {}
    others: dict[tuple[int, str], dict[str, Part]] = {}
    for number, _ in found.activities:
        for leg, contents in found.doing.activities[number].legs:
            if leg.robot == robot:
                load = contents.load(robot)
                loads.setdefault(leg.number, {}).setdefault(spots(load), load)
    for number, i, where in found.beside:
        leg, contents = found.doing.activities[number].legs[i]
        if leg.robot == robot:
            key = leg.number, spots(contents.load(robot))
            others.setdefault(key, {})[where] = parts[where]
    return {
        number: tuple(
            Among(_moved(load, robot), _standing(others.get((number, key), {}).values()))
            for key, load in own.items()
        )
        for number, own in loads.items()
    }


def _moved(load: Load, robot: str) -> Load:
    return tuple(
        replace(p, name=held(p.name, robot) if p.holder else on_plate(p.name, p.plate, i))
        for i, p in enumerate(load, 1)
    )


def _standing(parts: Iterable[Part]) -> Load:
    """Some that are never there together may have one name in runs."""
    numbers = itertools.count(1)
    return tuple(
        replace(p, name=standing(p.name if p.is_tool else f"{p.kind.name}.{next(numbers)}"))
        for p in parts
    )
