"""Commands of an arm, each from where the arm stands when it begins, planned as a run plans them.

    planner = Planner(cell)
    home = planner.home("robot1")
    leg = planner.leg(home, MoveJoint(pose))       # Leg(kind="ptp", path=..., end=Stand(...)), or with a fault
    planner.leg(leg.end, MoveLinear(step, "tool"))

Equal commands from equal places are one leg. Places that differ by less than 1e-7 (rad, m) are one place, unless more
digits are wanted: how long a short move takes goes by the third root of how far it leads.
"""

from __future__ import annotations

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.active_motion import MotionKind
from pn2code.robot.commands import Command, MoveCircular, MoveJoint, MoveLinear
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.trajectories import Still, Trajectory
from pn2code.robot.transforms import Array

DIGITS = 7
"""Of numbers that tell places apart where geometry is what counts ..."""
DIGITS_OF_TIME = 12
"""... and where time does."""


@frozen(eq=False)
class Stand:
    """Where an arm stands between commands.

    Args:
        number: of this place, among all places of all arms.
        q: its joint position, rad; T_base_tcp: where its TCP was told to be, that of its coupling if it changes tools.
        tool: which of these is in use; "": none.
    """

    number: int
    robot: str
    q: Array
    T_base_tcp: Array
    tool: str = ""


@frozen(eq=False)
class Leg:
    """What an arm does on one command; how long it takes does not matter.

    Args:
        number: of this leg, among all legs.
        command: as it is meant there: a move that names no TCP is one of the tool in use.
        path: its joint positions along the way; None with a fault.
        fault: why it cannot be carried out; the arm stays where it is.
    """

    number: int
    robot: str
    command: Command | None
    kind: MotionKind
    path: Trajectory | None
    start: Stand
    end: Stand
    fault: MotionFault | None = None

    @property
    def is_moving(self) -> bool:
        """Whether the arm goes anywhere."""
        return self.path is not None and not isinstance(self.path, Still)


def rewound(robot: CellRobot, q: Array) -> Array:
    """The same, with belts as if they had not run yet: however far they have, they go on in the same way."""
    out = np.array(q)
    for axis in robot.belts:
        out[robot.index(axis.name)] = 0.0
    return out


class Planner:
    """Plans commands of the arms of a cell, each once.

    Args:
        digits: of the numbers (rad, m) that tell places apart.
    """

    def __init__(self, cell: RobotCell, digits: int = DIGITS) -> None:
        self.cell = cell
        self._digits = digits
        self._executors = {r.name: RobotExecutor(r, cell.motion, cell.frames) for r in cell.moving}
        self.stands: list[Stand] = []
        self.legs: list[Leg] = []
        self._stands: dict[tuple[object, ...], Stand] = {}
        self._legs: dict[tuple[int, Command | None], Leg] = {}

    def home(self, robot: str) -> Stand:
        """Where a run begins."""
        executor = RobotExecutor(self.cell.robot(robot), self.cell.motion)
        return self._stand(robot, executor)

    def standing(self, stand: Stand) -> Leg:
        """An arm that does nothing."""
        key = (stand.number, None)
        if key not in self._legs:
            path = Still(stand.q, 0.0)
            self._keep(key, Leg(len(self.legs), stand.robot, None, "wait", path, stand, stand))
        return self._legs[key]

    def leg(self, stand: Stand, command: Command) -> Leg:
        """A command from a place."""
        key = (stand.number, command)
        if key not in self._legs:
            self._keep(key, self._planned(stand, command))
        return self._legs[key]

    def _keep(self, key: tuple[int, Command | None], leg: Leg) -> None:
        self._legs[key] = leg
        self.legs.append(leg)

    def _planned(self, stand: Stand, command: Command) -> Leg:
        executor = self._executors[stand.robot]
        executor.stand(stand.q, stand.T_base_tcp, stand.tool)
        command = executor.told(command)
        number = len(self.legs)
        try:
            motion = executor.begin(command, 0.0)
        except MotionFault as fault:
            return Leg(number, stand.robot, command, "wait", None, stand, stand, fault)
        executor.finish()
        end = self._stand(stand.robot, executor)
        return Leg(number, stand.robot, command, motion.kind, motion.trajectory, stand, end)

    def seen_from_arm(self, stand: Stand, command: MoveJoint | MoveLinear | MoveCircular) -> Array:
        """Where a move to a pose leads the TCP, seen from where the tracks have carried the base of the arm then."""
        executor = self._executors[stand.robot]
        executor.stand(stand.q, stand.T_base_tcp, stand.tool)
        return executor.seen_from_arm(command)

    def _stand(self, robot: str, executor: RobotExecutor) -> Stand:
        q, T_base_tcp = rewound(executor.robot, executor.q), executor.T_base_tcp  # noqa: N806
        key = (
            robot,
            executor.tool,
            *np.round(q, self._digits).tolist(),
            *np.round(T_base_tcp, self._digits).ravel().tolist(),
        )
        if key not in self._stands:
            found = Stand(len(self.stands), robot, np.array(q), np.array(T_base_tcp), executor.tool)
            self._stands[key] = found
            self.stands.append(found)
        return self._stands[key]
