"""What is proved of stacks, and of what stands on turntables, next to what becomes of them command by command."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from helpers.stacking_cell import TOML
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry.activities import Doing
from pn2code.geometry.compare import Comparison
from pn2code.geometry.contents import Contents
from pn2code.geometry.legs import Planner
from pn2code.geometry.shown import Shown
from pn2code.robot.active_motion import turned
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import (
    Along,
    Command,
    Handling,
    MoveExternal,
    MoveJoint,
    Pose,
    ToolAction,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.fake import FakeBackend
from pn2code.robot.part import PartFault
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import matrix_of
from pn2code.run.handling import PartKeeper

TAKE = ToolAction("suck", 0.5, Handling("takes", "box"))
RELEASE = ToolAction("blow", 0.3, Handling("releases", "box"))


def cell_of(*at: tuple[float, float, float], **devices: Any) -> RobotCell:
    data = tomllib.loads(TOML)
    data["devices"] |= devices
    data["parts"]["box"]["at"] = [dict(zip("xyz", place, strict=True)) for place in at]
    d = Diagnostics()
    found = load(data, Path(), lambda *_: Origin("cell.toml"), d)
    assert found is not None, [e.message for e in d.errors]
    return found


def over(x: float, y: float, z: float) -> MoveJoint:
    """To where the top of a box is."""
    return MoveJoint(Pose(x, y, z, math.pi, 0.0, 0.0))


def turn(degrees: float) -> MoveExternal:
    return MoveExternal((Along("plate", math.radians(degrees), is_track=False),))


def as_run(cell: RobotCell, commands: list[Command]) -> str:
    """What a run with the backend that measures nothing says; "": nothing."""
    executor = RobotExecutor(cell.robot("robot"), cell.motion)
    keeper = PartKeeper(cell, FakeBackend(cell))
    keeper.begin()
    try:
        for command in commands:
            motion = executor.begin(command, 0.0)
            for plate in turned(executor.robot, motion):
                keeper.parts.turn(plate)
            executor.finish()
            keeper.parts.stand("robot", executor.q)
            if isinstance(command, ToolAction) and command.handling is not None:
                keeper.handle("robot", command.handling, matrix_of(executor.pose))
    except PartFault as fault:
        return str(fault)
    return ""


def as_proved(cell: RobotCell, commands: list[Command]) -> tuple[str, str]:
    """What is proved: a fault, and a doubt."""
    planner = Planner(cell)
    doing = Doing(planner, cell)
    stand, contents = planner.home("robot"), doing.start
    for command in commands:
        found = doing.of("robot", (command,), stand, contents, (stand,))
        if found.fault or found.doubt:
            return found.fault, found.doubt
        assert found.end is not None
        stand, contents = found.end, found.after
    return "", ""


def random_work(choice: Random) -> tuple[RobotCell, list[Command]]:
    """Boxes are stacked, turned and taken again, often wrongly."""
    places = [[1.7, 0.6, 0.4], [1.5, 0.35, 0.4], [1.2, -0.9, 0.0]]
    cell = cell_of(*((0.9 + 0.3 * i, -1.4, 0.075) for i in range(4)))
    commands: list[Command] = []
    for i in range(choice.randint(2, 4)):
        x, y, z = stack = choice.choice(places)
        x += choice.choice([0.0, 0.0, 0.0, 0.099, 0.101, 0.105])
        z += 0.15 + choice.choice([0.0, 0.0, 0.0, 0.0049, 0.0051])
        stack[2] += 0.15
        commands += [over(0.9 + 0.3 * i, -1.4, 0.15), TAKE, over(x, y, z), RELEASE]
        if choice.random() < 0.4:
            commands.append(turn(choice.choice([90.0, -90.0, 0.0])))
        if choice.random() < 0.4:
            commands += [over(x, y, z - choice.choice([0.0, 0.15])), TAKE]
            commands += [over(0.9, 1.3, 0.15), RELEASE]
    return cell, commands


def test_proofs_and_runs_agree_about_stacks() -> None:
    """Where nothing is in doubt they say the same, in the same words."""
    seen = {"fault": 0, "well": 0}
    for seed in range(amount(16, 1000)):
        cell, commands = random_work(Random(seed))
        said = as_run(cell, commands)
        fault, doubt = as_proved(cell, commands)
        assert doubt or fault == said, (seed, fault, said)
        seen["fault" if said else "well"] += 1
    assert min(seen.values()) >= 2, seen


@pytest.mark.parametrize(("gap", "known"), [(0.00497, True), (0.005, False), (0.00503, True)])
def test_what_is_as_high_as_is_permitted_is_not_known(gap: float, known: bool) -> None:
    cell = cell_of((1.2, -0.9, 0.075), (0.9, -1.4, 0.075))
    work = [over(0.9, -1.4, 0.15), TAKE, over(1.2, -0.9, 0.3 + gap), RELEASE]
    fault, doubt = as_proved(cell, work)
    assert bool(doubt) is not known
    assert bool(fault) is (known and gap > 0.005)


@pytest.mark.parametrize(("off", "known"), [(0.00497, True), (0.005, False), (0.00503, True)])
def test_what_is_as_far_off_as_can_be_gripped_is_not_known(off: float, known: bool) -> None:
    fault, doubt = as_proved(cell_of((0.9, -1.4, 0.075)), [over(0.9 + off, -1.4, 0.15), TAKE])
    assert bool(doubt) is not known
    assert bool(fault) is (known and off > 0.005)


def test_which_of_two_parts_is_taken_that_are_as_near_is_not_known() -> None:
    """Which one a run takes depends on the order in which they have come."""
    data = tomllib.loads(TOML)
    data["parts"]["box"] |= {"size": [0.008, 0.2, 0.15], "grip_tolerance": 0.01}
    for x, known in ((1.0045, False), (1.004, True)):
        data["parts"]["box"]["at"] = [{"x": at, "y": -1.4, "z": 0.075} for at in (1.0, 1.009)]
        cell = load(data, Path(), lambda *_: Origin("cell.toml"), Diagnostics())
        assert cell is not None
        fault, doubt = as_proved(cell, [over(x, -1.4, 0.15), TAKE])
        assert not fault and bool(doubt) is not known, x


def contents_of(doing: Doing, planner: Planner, *commands: Command) -> tuple[Contents, int]:
    stand = planner.home("robot")
    found = doing.of("robot", commands, stand, doing.start, (stand,))
    assert not found.fault, found.fault
    return found.after, found.number


@pytest.mark.bullet
def test_a_part_on_a_turntable_is_swept_when_that_turns(request: pytest.FixtureRequest) -> None:
    """A box at the rim meets the arm of the robot that stands over the other side."""
    cell = cell_of((1.8, 0.6, 0.475), (1.8, 0.6, 0.625), (1.8, 0.6, 0.775))
    backend = BulletBackend(cell, looks=False)
    request.addfinalizer(backend.close)
    planner = Planner(cell)
    doing = Doing(planner, cell, Shown(backend))
    comparison = Comparison(cell, planner, Shown(backend))
    stand = planner.home("robot")

    def swept(height: float) -> str:
        found = doing.of("robot", (over(1.2, 0.6, height), turn(180.0)), stand, doing.start)
        (_, (leg, contents)) = found.legs
        assert found.turns == {"robot/plate"} and not found.fault
        return comparison.around(leg, contents.load("robot"))[1].outcome

    assert (swept(1.5), swept(0.6)) == ("clear", "touch")


def test_handling_beside_a_turntable_that_turns_is_told_apart() -> None:
    cell = cell_of((1.7, 0.6, 0.475))
    planner = Planner(cell)
    doing = Doing(planner, cell)
    stand = planner.home("robot")
    turning = doing.of("robot", (turn(90.0),), stand, doing.start, (stand,))
    contents = turning.between
    for x, expected in ((1.7, True), (1.9, True), (3.0, False)):
        where = (matrix_of(Pose(x, 0.6, 0.5, 0.0, 0.0, 0.0))[:3, 3], 0.3)
        assert doing.plates.within("robot/plate", where, contents) is expected


@pytest.mark.bullet
def test_distances_on_the_way_are_no_less_than_what_is_certain(
    request: pytest.FixtureRequest,
) -> None:
    """Boxes on a turntable that turns, beside a box that stands: sampled, next to what was swept."""
    cell = cell_of((1.8, 0.6, 0.475), (1.8, 0.6, 0.625), (1.25, 1.05, 0.575))
    backend = BulletBackend(cell, looks=False)
    request.addfinalizer(backend.close)
    planner = Planner(cell)
    doing = Doing(planner, cell, Shown(backend))
    comparison = Comparison(cell, planner, Shown(backend))
    (beside,) = doing.start.standing.values()
    assert (beside.name, len(doing.start.load("robot"))) == ("box.3", 2)
    random = Random(4)
    stand, least, nearest, clear = planner.home("robot"), math.inf, math.inf, 0
    for _ in range(4):
        x, y, z = random.uniform(0.9, 1.3), random.uniform(-0.3, 0.4), random.uniform(0.7, 1.2)
        go, about = over(x, y, z), turn(random.uniform(-170.0, 170.0))
        found = doing.of("robot", (go, about), stand, doing.start, (stand,))
        assert found.end is not None and not found.fault
        stand = found.end
        for leg, contents in found.legs:
            load = contents.load("robot")
            swept = comparison.beside((leg, load), beside)
            _, itself = comparison.around(leg, load)
            if leg.path is None or {swept.outcome, itself.outcome} != {"clear"}:
                continue
            clear += 1
            Shown(backend).show((*doing.start.parts.present.values(),))
            for share in range(11):
                backend.set_joints("robot", leg.path.on_way(np.array([share / 10.0]))[0])
                scene = backend.distances.pairs("scene", "robot", 0.5, only={"box.3"})
                mine = [
                    c.distance
                    for c in backend.distances.pairs("self", "robot", 0.5)
                    if "box" in c.b
                ]
                off = min((c.distance + (c.allowed or 0.0) for c in scene), default=0.5)
                assert off >= swept.least - 1e-5
                assert min(mine, default=0.5) >= itself.least - 1e-5
                nearest = min(nearest, off)
            least = min(least, swept.least)
    assert clear >= 4 and least < nearest < 0.2


@pytest.mark.bullet
def test_a_part_on_a_lift_is_swept_as_that_moves(request: pytest.FixtureRequest) -> None:
    platform = {
        "kind": "slide",
        "pose": {"x": 1.2, "y": -1.3, "z": 0.3},
        "direction": [0.0, 0.0, 1.0],
        "from": 0.0,
        "to": 1.0,
        "objects": [{"name": "top", "size": [0.4, 0.4, 0.05], "pose": {"z": -0.025}}],
    }
    under = (1.2, -1.3, 0.875)
    cell = cell_of((1.2, -1.3, 0.375), under, elevator={"axes": {"platform": platform}})
    backend = BulletBackend(cell, looks=False)
    request.addfinalizer(backend.close)
    planner = Planner(cell)
    doing = Doing(planner, cell, Shown(backend))
    comparison = Comparison(cell, planner, Shown(backend))
    (hangs,) = doing.start.standing.values()
    stand = planner.home("elevator")

    def moved(to: float) -> str:
        command = MoveExternal((Along("platform", to, is_track=True),))
        found = doing.of("elevator", (command,), stand, doing.start, (stand,))
        ((leg, contents),) = found.legs
        assert found.turns == {"elevator/platform"} and not found.fault and not found.kinds
        load = contents.load("elevator")
        assert [p.name for p in load] == ["box.1"]
        return comparison.beside((leg, load), hangs).outcome

    assert (moved(0.3), moved(0.4)) == ("clear", "touch")
    near = (matrix_of(Pose(1.2, -1.3, 1.2, 0.0, 0.0, 0.0))[:3, 3], 0.2)
    far = (matrix_of(Pose(1.2, -0.4, 1.2, 0.0, 0.0, 0.0))[:3, 3], 0.2)
    seen = [doing.plates.within("elevator/platform", x, (doing.start,)) for x in (near, far)]
    assert seen == [True, False]
