"""All that an arm is told, as a tree: each command with the one after which it comes, to be planned from another base.

    plan = Plan.of(planner.legs, "robot2")
    walk = plan.walk(robot_elsewhere, cell)     # Walk: paths, how long they take; or a fault

The planner is that of runs: the same branches, lines and faults. A place to which several commands lead is reached
through one of them; so the walk is a guide, and all of it is looked at when a base is proved.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.legs import Leg
from pn2code.robot.commands import Command, MoveAxes, MoveHome
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.trajectories import Still
from pn2code.robot.transforms import Array

_SAMPLES = 9
"""Places on the way of each move."""


@frozen(eq=False)
class Walk:
    """What an arm does from a base.

    Args:
        q: joint positions on all of its ways, (n, axes), HOME first.
        loose: of each, whether it is on a joint move, where nothing may touch.
        counts: of each, whether it shows how well the arm stands: on lines and arcs, and where joint moves end.
            HOME and given joint positions are the same from everywhere. What lies between such places lies between
            their limits, and conditioning is of no concern there.
        seconds: how long all commands together take.
        done: so many commands could be planned; fault: why not the next one.
    """

    q: Array
    loose: Array
    counts: Array
    seconds: float
    done: int
    fault: MotionFault | None


@frozen
class Plan:
    """What an arm is told.

    Args:
        steps: each command, with the number of the one after which it comes (-1: from HOME).
    """

    steps: tuple[tuple[int, Command], ...]

    @staticmethod
    def of(legs: Iterable[Leg], robot: str) -> Plan:
        """From legs in the order in which they were planned."""
        after: dict[int, int] = {}
        steps: list[tuple[int, Command]] = []
        for leg in legs:
            if leg.robot != robot or leg.command is None:
                continue
            steps.append((after.get(leg.start.number, -1), leg.command))
            if leg.end is not leg.start:
                after.setdefault(leg.end.number, len(steps) - 1)
        return Plan(tuple(steps))

    def with_more(self, other: Plan) -> Plan:
        """Both, one after the other."""
        more = (((before + len(self.steps)) if before >= 0 else -1, c) for before, c in other.steps)
        return Plan((*self.steps, *more))

    def walk(self, robot: CellRobot, cell: RobotCell) -> Walk:
        """Plans everything from where the robot stands."""
        executor = RobotExecutor(robot, cell.motion, cell.frames)
        home = (executor.q, executor.T_base_tcp, executor.tool)
        ends: list[tuple[Array, Array, str]] = []
        rows, loose, counts = [np.array(home[0])[None]], [True], [False]
        seconds = 0.0
        for before, command in self.steps:
            executor.stand(*(ends[before] if before >= 0 else home))
            try:
                motion = executor.begin(command, 0.0)
            except MotionFault as fault:
                q = np.concatenate(rows)
                return Walk(q, np.array(loose), np.array(counts), seconds, len(ends), fault)
            executor.finish()
            ends.append((np.array(executor.q), np.array(executor.T_base_tcp), executor.tool))
            path = motion.trajectory
            seconds += path.duration
            if not isinstance(path, Still):
                rows.append(path.on_way(np.linspace(0.0, 1.0, _SAMPLES)))
                is_joint = motion.kind == "ptp"
                loose += [is_joint] * _SAMPLES
                counts += [not is_joint] * (_SAMPLES - 1)
                counts.append(not isinstance(command, MoveHome | MoveAxes))
        q = np.concatenate(rows)
        return Walk(q, np.array(loose), np.array(counts), seconds, len(ends), None)
