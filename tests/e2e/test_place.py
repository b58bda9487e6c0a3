"""`pn2code place`: what it finds holds for `check --geometry`, and what it cannot find it names."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.meeting_cell import TOML, meeting_cell
from helpers.robot_cells import pose_mm, riveting_cell
from pn2code.cli.main import app
from pn2code.geometry.legs import Planner
from pn2code.geometry.placing.free import Free, FreeError, moved, parse, rounded
from pn2code.geometry.placing.judging import Judge
from pn2code.geometry.placing.plan import Plan
from pn2code.geometry.placing.search import Candidate, front_of, unlike
from pn2code.geometry.reach_map import Task
from pn2code.robot.commands import MoveHome, MoveJoint, MoveLinear
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import matrix_of

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

COMMANDS = (
    MoveJoint(pose_mm(5750.0, 5995.4, 2109.2, 75.0)),
    MoveLinear(pose_mm(0.0, 0.0, 100.0), "tool"),
    MoveLinear(pose_mm(0.0, 0.0, -100.0), "tool"),
    MoveHome(),
)


def planned(cell: RobotCell) -> Planner:
    planner = Planner(cell)
    stand = planner.home("robot2")
    for command in COMMANDS:
        stand = planner.leg(stand, command).end
    return planner


def test_what_may_be_chosen_is_read() -> None:
    cell = riveting_cell("paper")
    found = parse(["robot2.base.yaw,x=5:6.5", "robot1.base.z"], cell, 0.5)
    assert [(f.robot, f.key) for f in found] == [
        ("robot1", "z"),
        ("robot2", "x"),
        ("robot2", "yaw"),
    ]
    z, x, yaw = found
    assert (z.low, z.high) == (0.0, 0.5)  # not into the floor
    assert (x.low, x.high, x.here) == (5.0, 6.5, 5.75)
    assert (yaw.low, yaw.high) == pytest.approx((-270.0, 90.0))
    (narrow,) = parse(["robot2.base.x=5.0104:5.0126"], cell, 1.0)
    assert (narrow.low, narrow.high) == (5.011, 5.012)  # rounded inwards
    there = moved(cell, found, (0.25, 6.0, 0.0))
    assert there.robot("robot1").base == replace(cell.robot("robot1").base, z=0.25)
    assert there.robot("robot2").base == replace(cell.robot("robot2").base, x=6.0, rz=0.0)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("robot2", "not of the form"),
        ("robot2.base.", "not of the form"),
        ("robot3.base.x", "did you mean"),
        ("anybody.base.x", "known are `robot1`, `robot2`"),
        ("robot2.base.yaww", "did you mean"),
        ("robot2.base.x=5", "KEY=LOW:HIGH"),
        ("robot2.base.x=5:four", "`four` in"),
        ("robot2.base.x=5:inf", "`inf` in"),
        ("robot2.base.x=6:5", "below the upper"),
        ("robot2.base.x,x", "named twice"),
        ("robot2.base.x=5.0001:5.0004", "no two whole millimetres"),
        ("robot2.base.yaw=5.01:5.14", "no two tenths"),
    ],
)
def test_mistakes_are_told(text: str, says: str) -> None:
    with pytest.raises(FreeError) as problem:
        parse([text], riveting_cell("paper"), 1.0)
    assert says in str(problem.value)


def test_a_plan_is_walked_as_it_was_planned() -> None:
    cell = riveting_cell("paper")
    planner = planned(cell)
    plan = Plan.of(planner.legs, "robot2")
    assert [step.after for step in plan.steps] == [
        -1,
        0,
        1,
        0,
    ]  # the third ends where the first did
    walk = plan.walk(cell.robot("robot2"), cell)
    assert walk.fault is None and walk.done == 4
    paths = [leg.path for leg in planner.legs]
    assert walk.seconds == pytest.approx(sum(p.duration for p in paths if p is not None))
    assert walk.q[-1] == pytest.approx(planner.legs[-1].end.q)
    far = moved(cell, parse(["robot2.base.y"], cell, 9.0), (16.0,))
    walk = plan.walk(far.robot("robot2"), far)
    assert walk.fault is not None and walk.done == 0


def test_nothing_is_better_than_what_the_quick_look_says() -> None:
    cell = riveting_cell("paper")
    plan = Plan.of(planned(cell).legs, "robot2")
    pose = matrix_of(COMMANDS[0].target)  # type: ignore[union-attr]
    task = Task(pose[None], (slice(0, 1),))
    free = parse(["robot2.base.x,y,z,yaw"], cell, 0.8)
    judge = Judge(cell, {"robot2": task}, {"robot2": plan}, free)
    choice = Random(5)
    done = 0
    try:
        for _ in range(12):
            values = rounded(free, [choice.uniform(f.low, f.high) for f in free])
            looked = judge.look(np.array([values]))
            walked = judge.walk(values, 0.0)
            if looked.reach[0] < 1.0:
                assert walked.done < 1.0
            elif walked.done == 1.0:
                done += 1
                assert walked.condition >= looked.condition[0] - 1e-6
    finally:
        judge.close()
    assert done > 3


def test_an_arm_that_is_told_nothing_has_done_everything() -> None:
    cell = riveting_cell("paper")
    free = parse(["robot2.base.x"], cell, 0.1)
    judge = Judge(cell, {}, {"robot2": Plan(())}, free)
    try:
        assert judge.look(np.array([[5.75]])).reach[0] == 1.0
        assert judge.walk((5.75,), 0.0).done == 1.0
    finally:
        judge.close()


def test_no_other_one_is_better_in_everything() -> None:
    def candidate(condition: float, limit: float, at: float) -> Candidate:
        return Candidate((at,), 1.0, condition, limit, 0.1, 1.0, 5.0, True, True)

    a, b, c = candidate(5.0, 0.2, 0.0), candidate(9.0, 0.4, 1.0), candidate(9.0, 0.3, 1.05)
    assert front_of([c, b, a]) == (a, b)
    free = (Free("robot2", "x", 0.0, 2.0, 1.0),)
    assert unlike([a, b, c], free, 100.0) == [a, b]


def test_an_arm_that_stands_too_far_away_is_placed(tmp_path: Path) -> None:
    far = TOML.replace("{ x = 3.0, y = 0.0,", "{ x = 4.4, y = 0.3,")
    cell = meeting_cell(tmp_path / "cell", guarded=True, toml=far)
    run = CliRunner()
    out = tmp_path / "out"
    arguments = ["place", str(cell), "--free", "robot2.base.x=2.6:4.4,y=-0.5:0.5", "-o", str(out)]
    result = run.invoke(app, [*arguments, "--generations", "6", "--json"])
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert found["here"]["reach"] < 1.0
    assert found["chosen"]["reach"] == 1.0 and found["run"]["verdict"] == "finished"
    assert {Path(f).name for f in found["files"]} == {"layout.toml", "front.png", "front.tsv"}
    rows = (out / "front.tsv").read_text().splitlines()
    assert rows[0].startswith("robot2.x\trobot2.y\tcondition") and len(rows) > 1
    # What it wrote is a layout of the cell, and the whole check says the same of it.
    layout = (out / "layout.toml").read_text()
    base = tomllib.loads(layout)["layouts"]["placed"]["robots"]["robot2"]["base"]
    assert {k: base[k] for k in ("x", "y")} == found["chosen"]["bases"]["robot2"]
    with (cell / "cell.toml").open("a") as file:
        file.write(layout)
    check = ["check", "--geometry", str(cell), "--layout", "placed", "--traces", str(out)]
    assert run.invoke(app, check).exit_code == 0


def test_what_cannot_be_had_is_named(tmp_path: Path) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=True)
    run = CliRunner()
    out = tmp_path / "out"
    arguments = ["place", str(cell), "--generations", "2", "-o", str(out)]
    result = run.invoke(app, [*arguments, "--free", "robot2.base.x=7:8"])
    assert result.exit_code == 1, result.output
    assert "NO: no placing was found" in result.stdout
    assert (
        "robot2, joint 1500 0 1100, 180 0 180 (to 1500 0 1100, 180 0 180): from none"
        in result.stdout
    )
    assert not (out / "layout.toml").exists()
    # The other arm's HOME is in the way of everything here; nothing is said to be fine.
    result = run.invoke(app, [*arguments, "--free", "robot2.base.x=0.0:0.02"])
    assert result.exit_code == 1 and "NO:" in result.stdout
    result = run.invoke(app, [*arguments, "--free", "robot4.base.x"])
    assert result.exit_code == 2 and "`robot4`" in result.stderr


def test_what_does_not_depend_on_what_may_be_moved_is_told_at_once(tmp_path: Path) -> None:
    """Robot 1 stands too far away, and robot 2 may be moved: that helps nobody."""
    toml = TOML.replace("base = { x = 0.0", "base = { x = -4.0", 1)
    assert toml != TOML
    cell = meeting_cell(tmp_path / "cell", guarded=True, toml=toml)
    arguments = ["place", str(cell), "--free", "robot2.base.x,y", "-o", str(tmp_path / "out")]
    result = CliRunner().invoke(app, [*arguments, "--json"])
    assert result.exit_code == 1, result.output
    row = json.loads(result.output)
    assert row["regardless"].startswith("robot1, joint 1500 0 1100") and row["looked"] == 1
    assert not row["tried"] and row["chosen"] is None
    # Of the arm that may be moved it is looked for.
    free = ["--free", "robot1.base.x=-4.2:-3.8", "--generations", "1"]
    row = json.loads(
        CliRunner()
        .invoke(app, [*arguments[:2], *free, "-o", str(tmp_path / "out"), "--json"])
        .output
    )
    assert row["regardless"] is None and row["missed"]
