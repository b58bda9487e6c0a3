"""Placings of arms with tracks and turntables: what is said of one holds for cell.toml with that base."""

from __future__ import annotations

import copy
import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.robot_cells import nowhere, pose_mm
from helpers.welding_cell import TOML, welding_cell
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.activities import Doing
from pn2code.geometry.legs import Planner
from pn2code.geometry.placing.free import Free, moved, parse
from pn2code.geometry.placing.judging import Judge
from pn2code.geometry.placing.plan import Plan, Step
from pn2code.geometry.placing.search import Search, Wish
from pn2code.geometry.reach_map import Task
from pn2code.robot.carried import WithAxes
from pn2code.robot.commands import Along, MoveExternal, MoveHome, MoveJoint, MoveLinear
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import matrix_of

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

RAIL = (Along("rail", 0.3, is_track=True),)
BOTH = (*RAIL, Along("plate", math.radians(40.0), is_track=False))
OVER = MoveJoint(pose_mm(-100.0, -60.0, 60.0, 180.0, 0.0, 90.0), frame="seam")
ALONG = MoveLinear(pose_mm(100.0, -60.0, 15.0, 180.0, 0.0, 90.0), "seam", along=BOTH)
COMMANDS = (MoveExternal(along=RAIL), OVER, ALONG, MoveHome())
ELSEWHERE = (0.3, -1.35, 60.0)
DATA: dict[str, Any] = tomllib.loads(TOML)


class Explored:
    """What is known of what the arm is told, without a net."""

    def __init__(self, planner: Planner, cell: RobotCell) -> None:
        self.doing = Doing(planner, cell)


def loaded(base: tuple[float, float, float] | None = None) -> RobotCell:
    from pn2code.robot.scene import load

    data = copy.deepcopy(DATA)
    if base is not None:
        data["robots"]["left"]["base"].update(zip(("x", "y", "yaw"), base, strict=True))
    d = Diagnostics()
    found = load(data, Path(), nowhere, d)
    assert found is not None, [e.message for e in d]
    return found


def planned(cell: RobotCell) -> Planner:
    planner = Planner(cell)
    stand = planner.home("left")
    for command in COMMANDS:
        stand = planner.leg(stand, command).end
    return planner


def judge_of(cell: RobotCell) -> tuple[Judge, tuple[Free, ...]]:
    planner = planned(cell)
    free = parse(["left.base.x,y,yaw"], cell, 0.5)
    task = Task.of(Explored(planner, cell), cell.robot("left"))  # type: ignore[arg-type]
    return Judge(cell, {"left": task}, {"left": Plan.of(planner.legs, "left")}, free), free


def test_a_turntable_stays_where_it_is_when_the_base_is_moved() -> None:
    cell = loaded()
    there = moved(cell, parse(["left.base.x,y,yaw"], cell, 1.0), ELSEWHERE).robot("left")
    said = loaded(ELSEWHERE).robot("left")
    assert there.base == said.base
    q = np.array(said.home)
    q[[0, -1]] = 0.2, 0.5
    assert isinstance(there.kinematics, WithAxes)
    assert there.kinematics.joint_frames(q) == pytest.approx(said.kinematics.joint_frames(q))
    (table,) = there.axes.tables
    at = there.T_world_base @ table.T_base_axis
    assert at[:3, 3] == pytest.approx([0.0, 0.0, 0.7])
    origins = [
        next(j for j in r.arm.urdf.joints if j.name == "plate").T_parent_joint
        for r in (there, said)
    ]
    assert origins[0] == pytest.approx(origins[1])


def test_a_placing_is_as_good_as_the_cell_with_that_base() -> None:
    judge, _ = judge_of(loaded())
    said, _ = judge_of(loaded(ELSEWHERE))
    try:
        here = judge.walk((0.0, -1.2, 90.0), 0.0)
        moved_, wanted = judge.walk(ELSEWHERE, 0.0), said.walk(ELSEWHERE, 0.0)
    finally:
        judge.close()
        said.close()
    for key in ("done", "condition", "limit", "clearance", "seconds"):
        assert getattr(moved_, key) == pytest.approx(getattr(wanted, key), abs=1e-5), key
    assert moved_.done == 1.0 and moved_.condition > here.condition + 1.0


def test_what_is_reached_is_what_an_arm_on_its_track_reaches_there() -> None:
    cell = loaded()
    judge, free = judge_of(cell)
    task = judge.tasks["left"]
    # The poses are those in the world: the arm is on its track, not the work piece.
    end = matrix_of(pose_mm(0.0, 0.0, 800.0, 0.0, 0.0, 40.0)) @ matrix_of(ALONG.target)
    assert any(p == pytest.approx(end, abs=1e-6) for p in task.poses)
    choice = Random(3)
    counts = set()
    try:
        for _ in range(30):
            values = (choice.uniform(-1.6, 1.6), choice.uniform(-2.4, -0.6), choice.uniform(0, 180))
            reached = judge.look(np.array([values])).robots["left"].reached[0]
            there = moved(cell, free, values)
            executor = RobotExecutor(there.robot("left"), there.motion, there.frames)
            try:
                executor.reach(replace(OVER, along=(*RAIL, replace(BOTH[1], position=0.0))))
                is_reached = True
            except MotionFault:
                is_reached = False
            assert bool(reached[0]) is is_reached, values
            counts.add(is_reached)
    finally:
        judge.close()
    assert counts == {True, False}


def test_an_arm_that_is_told_no_pose_reaches_all_from_everywhere() -> None:
    cell = loaded()
    free = parse(["right.base.y"], cell, 0.1)
    task = Task(np.zeros((0, 4, 4)), ())
    along = MoveExternal(along=(Along("bench", 0.2, is_track=True),))
    plan = Plan((Step(-1, MoveHome()), Step(0, along)))
    judge = Judge(cell, {"right": task}, {"right": plan}, free)
    try:
        found = Search(judge, Wish(clearance=0.005), generations=1).run()
    finally:
        judge.close()
    assert found.here.meets and found.here.reach == 1.0
    assert all(c.meets for c in found.ranked) and found.ranked


def test_a_welding_arm_is_placed_and_the_check_says_the_same(tmp_path: Path) -> None:
    far = TOML.replace("base = { x = 0.0, y = -1.2,", "base = { x = 0.0, y = -3.4,")
    # What the layout has from which it starts is in the one that is written, too, under a name that is free.
    far += """
[layouts.placed]
description = "slow"
robots.left.base.z = 0.35
robots.right.base = { x = 0.05 }
motion.joint_speed = 0.3
scene.objects = [{ name = "far box", size = [0.1, 0.1, 0.1], pose = { x = 4.0, z = 0.05 } }]
"""
    cell = welding_cell(tmp_path / "cell", toml=far)
    run = CliRunner()
    out = tmp_path / "out"
    arguments = ["place", str(cell), "--free", "left.base.y=-3.4:-1.0,yaw=60:120", "-o", str(out)]
    result = run.invoke(app, [*arguments, "--generations", "2", "--json"])
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert found["here"]["reach"] < 1.0 and found["chosen"]["reach"] == 1.0
    assert found["run"]["verdict"] == "finished"
    with (cell / "cell.toml").open("a") as file:
        file.write((out / "layout.toml").read_text())
    layouts = tomllib.loads((cell / "cell.toml").read_text())["layouts"]
    old, new = layouts["placed"], layouts["placed2"]
    assert {k: old[k] for k in ("motion", "scene")} == {k: new[k] for k in ("motion", "scene")}
    assert new["robots"]["right"] == old["robots"]["right"]
    assert new["robots"]["left"]["base"]["z"] == 0.35
    check = ["check", "--geometry", str(cell), "--traces", str(out), "--json", "--layout"]
    check.append("placed2")
    result = run.invoke(app, check)
    assert result.exit_code == 0, result.output
    (layout,) = json.loads(result.stdout)["layouts"]
    led = [m for m in layout["moves"] if m["robot"] == "left" and m["kind"] == "lin"]
    proved = next(t for t in found["tried"] if t["holds"])
    assert max(m["condition"] for m in led) == pytest.approx(proved["whole_condition"], abs=1e-2)
