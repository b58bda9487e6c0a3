"""The whole path of the riveting cell, both layouts, with and without PyBullet."""

import math

import numpy as np
import pytest

from helpers.robot_cells import RIVETS, riveting_cell, riveting_path
from helpers.thorough import amount
from pn2code.robot.backend import Camera
from pn2code.robot.choose_backend import open_backend
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.monitor import Monitor
from pn2code.robot.render import Film, cameras, picture, save, soften
from pn2code.robot.transforms import difference, matrix_of

EXACT = 1e-9  # m: 1e-6 mm
BULLET = 1e-6  # m: PyBullet's TCP is about 1e-7 m from ours; poses are judged by our kinematics
STEP = 0.1  # s between samples: coarse, to be quick

PATHS = [
    ("fake", "good"),
    pytest.param("bullet", "paper", marks=pytest.mark.bullet),
    pytest.param("bullet", "good", marks=pytest.mark.bullet),
    ("fake", "paper"),
]
"""Backends and layouts."""
CONDITIONS = {
    "good": [8.8, 8.6, 8.4, 8.4, 8.4, 8.6, 8.8],
    "paper": [13.9, 14.2, 15.2, 16.9, 20.0, 26.9, 102.1],
}


@pytest.mark.parametrize(("backend_name", "layout"), PATHS[: amount(2, 4)])
def test_the_whole_path(backend_name, layout):
    cell = riveting_cell(layout)
    backend = open_backend(backend_name, cell)
    try:
        run_path(cell, backend, layout)
    finally:
        backend.close()


def run_path(cell, backend, layout):
    monitor = Monitor(cell, backend)
    executors = [RobotExecutor(r, cell.motion) for r in cell.robots]
    t, rows, meetings, conditions = 0.0, 0, [], []
    for (phase, one), (_, two) in zip(riveting_path(1), riveting_path(2), strict=True):
        motions = [e.begin(c, t) for e, c in zip(executors, (one, two), strict=True)]
        end = max(m.ends for m in motions)
        times = np.append(np.arange(t, end, STEP), end)
        paths = [m.sample(times) for m in motions]
        kinds = {m.robot: m.kind for m in motions}
        for i, now in enumerate(times):
            joints = {m.robot: path[i] for m, path in zip(motions, paths, strict=True)}
            verdict = monitor.check(now, joints, phase, kinds)
            assert verdict.fault is None, verdict.fault
            assert verdict.warnings == ()
        for robot, motion, path in zip(cell.robots, motions, paths, strict=True):
            reached = robot.T_world_base @ robot.kinematics.forward(path[-1])
            assert max(difference(reached, matrix_of(motion.target))) < EXACT
            assert difference(backend.tcp(robot.name), reached)[0] < BULLET
            if motion.kind == "lin":
                assert off_the_line(robot, motion, path) < EXACT
        for e in executors:
            e.finish()
        rows += phase != "home"
        if phase == "in":
            a, b = (matrix_of(m.target) for m in motions)
            meetings.append(float(np.linalg.norm(a[:3, 3] - b[:3, 3])))
            assert a[:3, 2] == pytest.approx(-b[:3, 2], abs=1e-12)
            conditions.append([s.conditioning for s in verdict.samples])
        t = end
    assert rows == 22
    assert len(meetings) == RIVETS
    assert max(meetings) < EXACT
    assert [c[1].condition for c in conditions] == pytest.approx(CONDITIONS[layout], rel=0.006)
    assert all(10.2 < c[0].condition < 11.3 for c in conditions)
    if layout == "paper":
        assert math.degrees(conditions[-1][1].elbow) == pytest.approx(7.9, abs=0.05)
    found = {(e.measure, e.robot): e for e in monitor.minima()}
    assert found["limit", "robot1"].value > math.radians(15)
    if backend.name == "fake":
        assert ("scene", "robot1") not in found
        return
    # Noses pass the ribs at 21 mm; everything else has more room.
    assert 0.020 < found["scene", "robot2"].value < 0.023
    assert found["scene", "robot2"].parts == ("robot2/tool_nose", "panel/ribs")
    assert found["scene", "robot1"].value > 0.045
    assert found["robots", "robot1+robot2"].value > 0.045
    assert found["self", "robot1"].value > 0.1
    assert -0.005 < found["contact", "robot1"].value < 0.0
    home = {(e.measure, e.robot): e.value for e in monitor.minima("home")}
    approach = {(e.measure, e.robot): e.value for e in monitor.minima("approach")}
    for phase in (home, approach):
        assert phase["scene", "robot1"] > 0.09
        assert phase["scene", "robot2"] > 0.05
        assert phase["self", "robot2"] > 0.1


def off_the_line(robot, motion, path):
    a, b = (np.array([p.x, p.y, p.z]) for p in (motion.start, motion.target))
    way = (b - a) / np.linalg.norm(b - a)
    worst = 0.0
    for now in robot.T_world_base @ robot.kinematics.forward_many(path):
        gone = now[:3, 3] - a
        worst = max(worst, float(np.linalg.norm(gone - (gone @ way) * way)))
    return worst


@pytest.fixture(scope="module")
def bullet():
    backend = open_backend("bullet", riveting_cell("good"))
    yield backend
    backend.close()


def nearest(backend, kind, robot):
    found = [
        c for c in backend.clearances(0.5) if (c.kind, c.robot, c.allowed) == (kind, robot, None)
    ]
    return found[0] if found else None


@pytest.mark.bullet
def test_distances_are_those_of_the_geometry(bullet):
    """The tip, pushed towards the skin along its axis, loses exactly the distance it travels."""
    cell = riveting_cell("good")
    robot = cell.robot("robot1")
    e = RobotExecutor(robot, cell.motion)
    commands = list(riveting_path(1))
    e.begin(commands[0][1], 0.0)
    e.finish()
    motion = e.begin(commands[1][1], 0.0)
    seen = []
    for t in np.linspace(0.0, 0.8 * motion.duration, 5):
        bullet.set_joints("robot1", motion.q(t))
        [c] = [c for c in bullet.clearances(0.5) if (c.a, c.b) == ("robot1/tool_tip", "panel/skin")]
        left = np.linalg.norm(
            bullet.tcp("robot1")[:3, 3] - [motion.target.x, motion.target.y, motion.target.z]
        )
        seen.append(left - c.distance)
    # Half the skin, and what the tip's 26 mm radius adds on a surface of 1.6 m: constant.
    assert max(seen) - min(seen) < 5e-5
    assert 0.0015 < seen[0] < 0.0025


@pytest.mark.bullet
def test_a_collision_is_found_and_named(bullet):
    cell = riveting_cell("good")
    monitor = Monitor(cell, bullet)
    through = {
        "robot1": np.radians([0, -60, 60, 0, 45, 90]),
        "robot2": np.array(cell.robot("robot2").home),
    }
    fault = monitor.check(0.0, through, kinds={"robot1": "lin"}).fault
    assert fault.kind == "collision"
    assert "robot1/" in fault.message
    assert "panel/" in fault.message


@pytest.mark.bullet
def test_a_robot_that_hits_itself(bullet):
    cell = riveting_cell("good")
    joints = {r.name: np.array(r.home) for r in cell.robots}
    joints["robot1"] = np.radians([0, -100, 155, 0, 125, 0])
    bullet.set_joints("robot1", joints["robot1"])
    found = nearest(bullet, "self", "robot1")
    assert found is not None
    assert found.distance < 0.1


@pytest.mark.bullet
def test_same_question_same_answer(bullet):
    cell = riveting_cell("good")
    for r in cell.robots:
        bullet.set_joints(r.name, r.home)
    first = bullet.clearances(0.5)
    bullet.set_joints("robot1", np.radians([5, -100, 100, 0, 45, 90]))
    assert bullet.clearances(0.5) != first
    bullet.set_joints("robot1", cell.robot("robot1").home)
    again = bullet.clearances(0.5)
    assert [(c.a, c.b) for c in again] == [(c.a, c.b) for c in first]
    assert [c.distance for c in again] == pytest.approx([c.distance for c in first], abs=1e-9)


@pytest.mark.bullet
def test_pictures_show_something(bullet, tmp_path):
    cell = riveting_cell("good")
    for r in cell.robots:
        bullet.set_joints(r.name, r.home)
    views = cameras(cell, bullet)
    assert [c.name for c in views] == ["overview", "behind", "tools", "seam"]
    image = picture(bullet, views[0], 160, 90)
    assert image.shape == (90, 160, 3)
    red, green, blue = (image[:, :, i].astype(int) for i in range(3))
    orange = (red > 120) & (red > green + 50) & (green > blue)
    assert orange.mean() > 0.01
    assert picture(bullet, views[0], 80, 45, smooth=2).shape == (45, 80, 3)
    assert save(image, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    for name in ("film.mp4", "film.gif"):
        with Film(tmp_path / name, bullet, views[0], width=64, height=36) as film:
            for _ in range(3):
                film.frame()
        assert (tmp_path / name).stat().st_size > 500


def test_no_pictures_without_a_simulator(tmp_path):
    cell = riveting_cell("good")
    backend = open_backend("fake", cell)
    image = picture(backend, Camera("x", (1, 0, 0), (0, 0, 0)))
    assert image is None
    assert not save(image, tmp_path / "a.png")


@pytest.mark.bullet
def test_nothing_is_printed(capfd):
    backend = open_backend("bullet", riveting_cell("good"))
    backend.clearances(0.1)
    backend.close()
    out, err = capfd.readouterr()
    assert (out, err) == ("", "")


def test_softening_touches_edges_only():
    image = np.zeros((8, 8, 3), np.uint8)
    image[:, 4:] = 200
    out = soften(image)
    assert out[4, 0, 0] == 0
    assert out[4, 7, 0] == 200
    assert 20 < out[4, 3, 0] < out[4, 4, 0] < 180
