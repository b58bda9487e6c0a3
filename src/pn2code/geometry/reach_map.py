"""Where the base of an arm could stand: what it then reaches of all that the net makes it do, and how well.

task = Task.of(situations, robot)             # poses of its TCP in the world: ends of joint moves, samples of lines
found = reach_map(robot, task, bases)         # Map: of each base reach, conditioning, margin of the limits
found.reach[i], found.condition[i], found.limit[i]

Where tracks carry the arm, they do so as the net says, and the map is of where they begin. A base keeps its height and
its directions; x and y are looked at. A joint move may end in any branch, or in the one that the robot must have; a
line must stay in one branch from its beginning to its end, in samples. Clearances are not looked at here: `check
--geometry` does, for a base that was chosen.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.geometry.situations import Situations
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.commands import (
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveHome,
    MoveJoint,
    MoveLinear,
    tcp_of,
)
from pn2code.robot.kinematics import BRANCHES, CHARACTERISTIC_LENGTH, TURN, Kinematics
from pn2code.robot.model import AXES
from pn2code.robot.motion import LinearTrajectory
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import Array, inverse, matrix_of

_OF_ARM = (MoveHome, MoveAxes, MoveExternal)
LINE_STEP = 0.05
"""m: samples of lines."""
_AT_ONCE = 400_000
_DIGITS = 6


@frozen(eq=False)
class Task:
    """What an arm has to reach.

    Args:
        poses: `T_world_tcp`, (n, 4, 4).
        groups: those that must be reached in one branch, as slices of them: a pose, or the samples of a line.
    """

    poses: Array
    groups: tuple[slice, ...]

    @staticmethod
    def of(found: Situations, robot: CellRobot) -> Task:
        """All that a robot is told, from wherever it can be then; joint positions belong to the arm, not the task."""
        parts: list[Array] = []
        seen: set[tuple[float, ...]] = set()
        for leg in found.doing.planner.legs:
            if leg.robot != robot.name or isinstance(leg.command, _OF_ARM):
                continue
            own: Array | None = None
            planner = found.doing.planner
            if isinstance(leg.path, LinearTrajectory | AlongTrajectory):
                line = leg.path.line
                count = max(2, int(np.ceil(line.length / LINE_STEP)) + 1)
                own = robot.T_world_base @ line.at(np.linspace(0.0, 1.0, count))
            elif (
                isinstance(leg.command, MoveJoint | MoveLinear | MoveCircular)
                and leg.command.frame != "tool"
            ):
                if robot.axes:
                    own = (robot.T_world_base @ planner.seen_from_arm(leg.start, leg.command))[None]
                else:
                    own = matrix_of(leg.command.target)[None]
                    if leg.command.frame != "world":
                        own = matrix_of(planner.cell.frames[leg.command.frame]) @ own
            if own is None:
                continue
            tcp = "" if leg.command is None else tcp_of(leg.command)
            if tcp and (not robot.axes or isinstance(leg.path, LinearTrajectory | AlongTrajectory)):
                back = inverse(robot.tcps[tcp].T_flange_tcp) @ robot.kinematics.T_flange_tcp
                own = own @ back
            key = tuple(np.round(own[[0, -1]], _DIGITS).ravel().tolist())
            if key not in seen:
                seen.add(key)
                parts.append(own)
        ends = np.cumsum([len(p) for p in parts], dtype=int).tolist()
        groups = tuple(slice(e - len(p), e) for e, p in zip(ends, parts, strict=True))
        poses = np.concatenate(parts) if parts else np.zeros((0, 4, 4))
        return Task(poses, groups)


@frozen(eq=False)
class Map:
    """Of each base.

    Args:
        bases: x and y in the world, (n, 2).
        reach: the part of the task that is reached inside the limits, 0 to 1.
        condition: the worst condition number over what is reached, in the best branch; inf: nothing is.
        limit: rad, the least margin of a limit, in that branch; -inf: nothing is.
    """

    bases: Array
    reach: Array
    condition: Array
    limit: Array

    @property
    def best(self) -> int | None:
        """The base that reaches everything with the best conditioning; None: none reaches everything."""
        whole = self.reach >= 1.0
        if not whole.any():
            return None
        return int(np.argmin(np.where(whole, self.condition, np.inf)))


def grid(robot: CellRobot, around: float, steps: int) -> Array:
    """Bases in a square around where the robot stands."""
    line = np.linspace(-around, around, steps)
    x, y = np.meshgrid(robot.base.x + line, robot.base.y + line)
    return np.stack([x.ravel(), y.ravel()], axis=1)


def reach_map(robot: CellRobot, task: Task, bases: Array) -> Map:
    """What the arm could do from each of them."""
    count = len(task.poses)
    each = max(1, _AT_ONCE // max(1, count * len(BRANCHES)))
    parts = [_part(robot, task, bases[i : i + each]) for i in range(0, len(bases), each)]
    reach, condition, limit = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Map(bases, reach, condition, limit)


def _part(robot: CellRobot, task: Task, bases: Array) -> tuple[Array, Array, Array]:
    kinematics = robot.kinematics.alone
    T_base_world = np.repeat(inverse(robot.T_world_base)[None], len(bases), axis=0)  # noqa: N806
    turn = T_base_world[:, :3, :3]
    where = np.column_stack([bases, np.full(len(bases), robot.base.z)])
    T_base_world[:, :3, 3] = -(turn @ where[..., None])[..., 0]
    poses = (T_base_world[:, None] @ task.poses).reshape(-1, 4, 4)
    rows = kinematics.all_branches(poses)
    margin, inside = _margins(kinematics, rows)
    condition = np.full(rows.shape[:2], np.inf)
    condition[inside] = _conditions(kinematics, rows[inside])
    shape = (len(bases), len(task.poses), len(BRANCHES))
    margin, condition = margin.reshape(shape), condition.reshape(shape)
    reached = np.zeros(len(bases))
    worst, least = np.zeros(len(bases)), np.full(len(bases), np.inf)
    for group in task.groups:
        own = condition[:, group].max(axis=1)
        is_line = group.stop - group.start > 1
        if robot.branch is not None and not is_line:
            others = [b.index for b in BRANCHES if b != robot.branch]
            own[:, others] = np.inf
        best = own.argmin(axis=1)
        there = np.arange(len(bases))
        found = own[there, best]
        ok = np.isfinite(found)
        reached += ok
        worst = np.where(ok, np.maximum(worst, found), worst)
        near = margin[:, group].min(axis=1)[there, best]
        least = np.where(ok, np.minimum(least, near), least)
    nothing = reached == 0
    worst[nothing], least[nothing] = np.inf, -np.inf
    return reached / max(1, len(task.groups)), worst, least


def _margins(kinematics: Kinematics, rows: Array) -> tuple[Array, Array]:
    """Of each row the least distance from a limit with the turns that leave most, and whether it is inside."""
    lower, upper = kinematics.arm.lower, kinematics.arm.upper
    middle = (lower + upper) / 2.0
    q = rows + TURN * np.round((middle - rows) / TURN)
    margin = np.minimum(q - lower, upper - q).min(axis=-1)
    inside = np.nan_to_num(margin, nan=-1.0) >= 0.0
    return np.where(inside, margin, -np.inf), inside


def _conditions(kinematics: Kinematics, q: Array) -> Array:
    jacobian = kinematics.jacobian_many(q.reshape(-1, AXES))
    jacobian[:, :3] /= CHARACTERISTIC_LENGTH
    sigma = np.linalg.svd(jacobian, compute_uv=False)
    return np.asarray(sigma[:, 0] / np.maximum(sigma[:, -1], 1e-12))


def rows(found: Map) -> Sequence[dict[str, float | None]]:
    """For programs."""
    return [
        {
            "x": round(float(x), 4),
            "y": round(float(y), 4),
            "reach": round(float(r), 4),
            "condition": round(float(c), 2) if np.isfinite(c) else None,
            "limit_deg": round(float(np.degrees(m)), 2) if np.isfinite(m) else None,
        }
        for (x, y), r, c, m in zip(
            found.bases, found.reach, found.condition, found.limit, strict=True
        )
    ]
