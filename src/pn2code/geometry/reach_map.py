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

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from pn2code.base.frozen import frozen
from pn2code.base.how_far import counting
from pn2code.geometry.legs import Leg
from pn2code.geometry.situations import Situations
from pn2code.geometry.words import words
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.carried import WithAxes
from pn2code.robot.commands import (
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveHome,
    MoveJoint,
    MoveLinear,
    tcp_of,
)
from pn2code.robot.kinematics import CHARACTERISTIC_LENGTH, Kinematics
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import Array, inverse, matrix_of

_OF_ARM = (MoveHome, MoveAxes, MoveExternal)
LINE_STEP = 0.05
"""m: samples of lines."""
_AT_ONCE = 50_000
_DIGITS = 6


@frozen(eq=False)
class Task:
    """What an arm has to reach.

    Args:
        poses: `T_world_tcp`, (n, 4, 4).
        groups: those that must be reached in one branch, as slices of them: a pose, or the samples of a line.
        names: of the groups, the commands in words; (): they have none.
        shifts: of each pose how far tracks have carried the arm by then, in the frame of its base, (n, 3); None: it has
            no tracks.
        angles: of each pose the arm angle, rad, (n,); None: the arm has none.
    """

    poses: Array
    groups: tuple[slice, ...]
    names: tuple[str, ...] = ()
    shifts: Array | None = None
    angles: Array | None = None

    @property
    def carried(self) -> Array:
        """How far tracks have carried the arm, (n, 3)."""
        return np.zeros((len(self.poses), 3)) if self.shifts is None else self.shifts

    @property
    def elbows(self) -> Array:
        """The arm angle of each pose, (n,); zeros where the arm has none."""
        return np.zeros(len(self.poses)) if self.angles is None else self.angles

    @staticmethod
    def of(found: Situations, robot: CellRobot) -> Task:
        """All that a robot is told, from wherever it can be then; joint positions belong to the arm, not the task."""
        parts: list[Array] = []
        shifts: list[Array] = []
        angles: list[Array] = []
        names: list[str] = []
        seen: set[tuple[float, ...]] = set()
        for leg in found.doing.planner.legs:
            if leg.robot != robot.name or isinstance(leg.command, _OF_ARM):
                continue
            own: Array | None = None
            shift = np.zeros((1, 3))
            planner = found.doing.planner
            if isinstance(leg.path, LinearTrajectory | AlongTrajectory):
                line = leg.path.line
                count = max(2, int(np.ceil(line.length / LINE_STEP)) + 1)
                way = np.linspace(0.0, 1.0, count)
                own = line.at(way)
                shift = np.zeros((count, 3))
                if isinstance(leg.path, AlongTrajectory):
                    shift = leg.path.way.carried(way)
                own[:, :3, 3] += shift
                own = robot.T_world_base @ own
            elif (
                isinstance(leg.command, MoveJoint | MoveLinear | MoveCircular)
                and leg.command.frame != "tool"
            ):
                if robot.axes:
                    own = planner.seen_from_arm(leg.start, leg.command)[None]
                    shift = _shift(robot, leg.start.q, leg.command)[None]
                    own[:, :3, 3] += shift
                    own = robot.T_world_base @ own
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
            angle = _arm_angles(robot, leg, len(own))
            ends = (own[[0, -1]], shift[[0, -1]], angle[[0, -1]])
            key = tuple(x for e in ends for x in np.round(e, _DIGITS).ravel().tolist())
            if key not in seen:
                seen.add(key)
                parts.append(own)
                shifts.append(shift)
                angles.append(angle)
                names.append(words(leg.command))
        last = np.cumsum([len(p) for p in parts], dtype=int).tolist()
        groups = tuple(slice(e - len(p), e) for e, p in zip(last, parts, strict=True))
        poses = np.concatenate(parts) if parts else np.zeros((0, 4, 4))
        carried = np.concatenate(shifts) if parts and robot.axes.tracks else None
        is_redundant = parts and robot.kinematics.arm_angle is not None
        elbows = np.concatenate(angles) if is_redundant else None
        return Task(poses, groups, tuple(names), carried, elbows)


def _arm_angles(robot: CellRobot, leg: Leg, count: int) -> Array:
    """The arm angle (rad) at each pose of a leg; of arms that have none, zeros."""
    path = leg.path.led if isinstance(leg.path, AlongTrajectory) else leg.path
    if isinstance(path, LinearTrajectory):
        angles = path.arm_angles(np.linspace(0.0, 1.0, count))
        return np.zeros(count) if angles is None else angles
    said = robot.kinematics.arm_angle or 0.0
    if isinstance(leg.command, MoveJoint | MoveLinear | MoveCircular):
        said = said if leg.command.arm_angle is None else leg.command.arm_angle
    return np.full(count, said)


def _shift(robot: CellRobot, q: Array, command: MoveJoint | MoveLinear | MoveCircular) -> Array:
    """How far tracks have carried the arm where a move ends that begins at `q`, in the frame of its base."""
    if not isinstance(robot.kinematics, WithAxes):
        return np.zeros(3)
    there = np.array(q)
    for a in command.along:
        there[robot.index(a.axis)] = a.position
    return np.asarray(robot.kinematics.shifts(there[None])[0])


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
    frames = np.repeat(robot.T_world_base[None], len(bases), axis=0)
    frames[:, :2, 3] = bases
    found = judge(robot, task, frames, counting(f"moving {robot.name}", total=len(bases)))
    return Map(bases, found.reach, found.condition, found.limit)


@frozen(eq=False)
class Judged:
    """What an arm could do from each of n bases, in the branches that are best conditioned.

    Args:
        reach: the part of the task that is reached inside the limits, 0 to 1; reached: which groups, (n, groups).
        condition: the worst condition number over what is reached; inf: nothing is.
        limit: rad, the least margin of a limit; -inf: nothing is.
    """

    reach: Array
    reached: NDArray[np.bool_]
    condition: Array
    limit: Array


def judge(
    robot: CellRobot,
    task: Task,
    T_world_base: Array,  # noqa: N803
    more: Callable[[int], None] = lambda _count: None,
) -> Judged:
    """What the arm could do with its base at each of these frames, (n, 4, 4); `more` is told how many more are done."""
    each = max(1, _AT_ONCE // max(1, len(task.poses) * len(robot.kinematics.branches)))
    starts = range(0, len(T_world_base), each)
    parts = []
    for i in starts:
        parts.append(_judged(robot, task, T_world_base[i : i + each]))
        more(len(parts[-1].reach))
    columns = zip(*((p.reach, p.reached, p.condition, p.limit) for p in parts), strict=True)
    return Judged(*(np.concatenate(column) for column in columns))


def _judged(robot: CellRobot, task: Task, frames: Array) -> Judged:
    kinematics = robot.kinematics.alone
    count = len(frames)
    T_base_world = np.zeros_like(frames)  # noqa: N806
    turn = frames[:, :3, :3].transpose(0, 2, 1)
    T_base_world[:, :3, :3] = turn
    T_base_world[:, :3, 3] = -(turn @ frames[:, :3, 3, None])[..., 0]
    T_base_world[:, 3, 3] = 1.0
    poses = T_base_world[:, None] @ task.poses
    poses[..., :3, 3] -= task.carried  # tracks go where the base has them
    poses = poses.reshape(-1, 4, 4)
    angles = None if task.angles is None else np.tile(task.angles, count)
    rows = kinematics.all_branches(poses, angles)
    margin = _margins(kinematics, rows)
    inside = margin >= 0.0
    condition = np.full(rows.shape[:2], np.inf)
    condition[inside] = _conditions(kinematics, rows[inside])
    shape = (count, len(task.poses), len(kinematics.branches))
    margin, condition = margin.reshape(shape), condition.reshape(shape)
    reached = np.zeros((count, len(task.groups)), bool)
    worst, least = np.zeros(count), np.full(count, np.inf)
    there = np.arange(count)
    for number, group in enumerate(task.groups):
        own = condition[:, group].max(axis=1)
        is_line = group.stop - group.start > 1
        if robot.branch is not None and not is_line:
            others = [b.index for b in kinematics.branches if b != robot.branch]
            own[:, others] = np.inf
        best = own.argmin(axis=1)
        found = own[there, best]
        ok = np.isfinite(found)
        reached[:, number] = ok
        worst = np.where(ok, np.maximum(worst, found), worst)
        near = margin[:, group].min(axis=1)[there, best]
        least = np.where(ok, np.minimum(least, near), least)
    nothing = ~reached.any(axis=1)
    worst[nothing], least[nothing] = np.inf, -np.inf
    reach = reached.sum(axis=1) / max(1, len(task.groups))
    return Judged(reach, reached, worst, least)


def _margins(kinematics: Kinematics, rows: Array) -> Array:
    """Of each row the least distance from a limit with the turns that leave most; -inf: it is outside."""
    lower, upper = kinematics.arm.lower, kinematics.arm.upper
    middle = (lower + upper) / 2.0
    q = kinematics.unwound(rows, middle)
    each = kinematics.arm.margins(q)
    margin = np.nan_to_num(each.min(axis=-1), nan=-1.0)
    if kinematics.slides.any():  # of these it only matters whether they are inside
        least = np.nan_to_num(each[..., ~kinematics.slides].min(axis=-1), nan=-1.0)
        margin = np.where(margin >= 0.0, least, margin)
    return np.where(margin >= 0.0, margin, -np.inf)


def _conditions(kinematics: Kinematics, q: Array) -> Array:
    jacobian = kinematics.jacobian_many(q)
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
