"""`./dev geometry --pairs N`: pairs of moves a second of processor time, on two workloads.

measured("dense", 256)              # Measured(pairs, touching, distances, seconds, elapsed)

Two arms of one kind face each other. `far`: moves in all of what each arm reaches, most of which keep well apart, as in
real cells; `dense`: moves in the space that both share, about half of which touch.
"""

from __future__ import annotations

import itertools
import math
import resource
import time
import tomllib
from pathlib import Path
from random import Random
from typing import Literal

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry.activities import Doing
from pn2code.geometry.activity import Activity
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.shown import Shown
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import MoveJoint, MoveLinear, Pose
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

Workload = Literal["far", "dense"]
WORKLOADS: tuple[Workload, ...] = ("far", "dense")
CELL = """
[robots.left]
model = "kr120_r2500"
base = { x = 0.0 }
home = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0]
[robots.right]
model = "kr120_r2500"
base = { x = APART, yaw = 180.0 }
home = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0]
"""
APART: dict[Workload, float] = {"far": 3.2, "dense": 2.75}
"""m between the bases."""
SPACE: dict[Workload, tuple[tuple[float, float], ...]] = {
    "far": ((600.0, 1500.0), (-1500.0, 1500.0), (600.0, 1900.0)),
    "dense": ((1000.0, 1500.0), (-700.0, 700.0), (800.0, 1500.0)),
}
"""mm from the base of an arm, in which its moves begin and end."""


@frozen
class Measured:
    """What a workload took: distances that were measured, seconds of processor time, and seconds by the clock."""

    pairs: int
    touching: int
    open: int
    distances: int
    seconds: float
    elapsed: float


def facing(workload: Workload) -> RobotCell:
    """The two arms."""
    d = Diagnostics()
    data = tomllib.loads(CELL.replace("APART", str(APART[workload])))
    cell = load(data, Path(), lambda *_path: Origin("cell.toml"), d)
    assert cell is not None, [x.message for x in d]
    return cell


def processor() -> float:
    """Seconds of this process and of those that it has begun and ended."""
    own, others = (resource.getrusage(w) for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own.ru_utime + own.ru_stime + others.ru_utime + others.ru_stime


def measured(workload: Workload, count: int, jobs: int = 1) -> Measured:
    """Sweeps about so many pairs against each other, as `check --geometry` does."""
    cell = facing(workload)
    backend = BulletBackend(cell, looks=False)
    planner = Planner(cell)
    some = math.isqrt(count)
    left, right = (moves(planner, r, workload, some) for r in ("left", "right"))
    compared = Comparison(cell, planner, Shown(backend))
    nothing = Doing(planner, cell).start
    acts = [[Activity(0, ((leg, nothing),), leg.end, nothing) for leg in x] for x in (left, right)]
    pairs = list(itertools.product(*acts))
    began, clock = processor(), time.perf_counter()
    with compared.pairs_ahead(pairs, jobs, lambda _pair: True):
        found = [x for pair in pairs for _, _, x in compared.activities(*pair)]
    seconds, elapsed = processor() - began, time.perf_counter() - clock
    backend.close()
    outcomes = [x.outcome for x in found]
    return Measured(
        len(found),
        outcomes.count("touch"),
        outcomes.count("open"),
        compared.sweeper.queries,
        seconds,
        elapsed,
    )


def moves(planner: Planner, robot: str, workload: Workload, count: int) -> list[Leg]:
    """Random moves of an arm that can be carried out, lines and joint moves."""
    choice = Random(f"{workload} {robot}")
    stand = planner.home(robot)
    out: list[Leg] = []
    while len(out) < count:
        x, y, z = (choice.uniform(*edge) for edge in SPACE[workload])
        x = x if robot == "left" else 1000.0 * APART[workload] - x
        pose = Pose(x / 1000.0, y / 1000.0, z / 1000.0, math.pi, 0.0, 0.0)
        command = MoveLinear(pose, "world") if choice.random() < 0.5 else MoveJoint(pose)
        leg = planner.leg(stand, command)
        if leg.fault is None:
            stand = leg.end
            if stand.number != leg.start.number:
                out.append(leg)
    return out
