"""What the monitor makes of joint positions and of what a backend measures."""

import math
from dataclasses import replace

import numpy as np
import pytest

from helpers.robot_cells import pose_mm, riveting_cell
from pn2code.robot.backend import Clearance
from pn2code.robot.commands import MoveJoint, MoveLinear
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.fake import FakeBackend
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import Led, LedContacts
from pn2code.robot.monitor import Monitor
from pn2code.robot.robot_cell import ContactRule


class Scripted(FakeBackend):
    """The fake backend with distances given by the test."""

    def __init__(self, cell):
        super().__init__(cell)
        self.gaps = ()

    def clearances(self, limit):
        return tuple(self.gaps)


@pytest.fixture
def cell():
    return riveting_cell("good")


@pytest.fixture
def backend(cell):
    return Scripted(cell)


@pytest.fixture
def monitor(cell, backend):
    return Monitor(cell, backend)


@pytest.fixture
def home(cell):
    return {r.name: np.array(r.home) for r in cell.robots}


def gap(distance, allowed=None, kind="scene", a="robot1/tool_tip", b="panel/skin"):
    return Clearance(kind, "robot1", a, b, distance, allowed, (5.75, 5.9, 2.1))


def test_nothing_to_report(monitor, home):
    verdict = monitor.check(0.0, home)
    assert verdict.fault is None
    assert verdict.warnings == ()
    assert [s.robot for s in verdict.samples] == ["robot1", "robot2"]


def test_collision_names_both_parts_and_the_pose(monitor, backend, home):
    backend.gaps = [gap(-0.002, a="robot1/link_4", b="panel/ribs")]
    fault = monitor.check(1.5, home, "approach").fault
    assert (fault.kind, fault.robot, fault.t) == ("collision", "robot1", 1.5)
    assert "robot `robot1`: `robot1/link_4` and `panel/ribs` collide (2.0 mm deep" in fault.message
    assert "at TCP pose (" in fault.message


def test_permitted_contact_up_to_its_depth(monitor, backend, home):
    lin = {"robot1": "lin"}
    backend.gaps = [gap(-0.004, allowed=0.005)]
    assert monitor.check(0.0, home, kinds=lin).fault is None
    backend.gaps = [gap(-0.006, allowed=0.005)]
    fault = monitor.check(0.1, home, kinds=lin).fault
    assert "6.0 mm deep in `panel/skin`" in fault.message
    assert "only 5.0 mm are allowed" in fault.message


def test_on_a_joint_move_nothing_may_touch(monitor, backend, home):
    backend.gaps = [gap(-0.001, allowed=0.005)]
    assert monitor.check(0.0, home, kinds={"robot1": "tool"}).fault is None
    assert monitor.check(0.1, home, kinds={"robot1": "ptp"}).fault.kind == "collision"
    meeting = gap(0.0, allowed=0.001, kind="robots", b="robot2/tool_tip")
    backend.gaps = [meeting]
    assert monitor.check(0.2, home, kinds={"robot1": "lin", "robot2": "lin"}).fault is None
    assert monitor.check(0.3, home, kinds={"robot1": "lin", "robot2": "ptp"}).fault is not None


def test_close_is_a_warning(monitor, backend, home):
    backend.gaps = [gap(0.015, b="panel/ribs"), gap(0.021, b="floor", kind="self")]
    verdict = monitor.check(0.0, home)
    assert verdict.fault is None
    assert [w.b for w in verdict.warnings] == ["panel/ribs"]


def test_minima_with_time_phase_and_parts(monitor, backend, home):
    for t, phase, distance in ((0.0, "in", 0.3), (1.0, "in", 0.1), (2.0, "out", 0.2)):
        backend.gaps = [gap(distance, b="panel/ribs")]
        monitor.check(t, home, phase)
    [total] = [e for e in monitor.minima() if e.measure == "scene"]
    assert (total.value, total.t, total.phase) == (0.1, 1.0, "in")
    assert total.parts == ("robot1/tool_tip", "panel/ribs")
    [out] = [e for e in monitor.minima("out") if e.measure == "scene"]
    assert (out.value, out.t) == (0.2, 2.0)
    assert monitor.phases() == ("in", "out")


def test_conditioning_keeps_the_greatest_and_margins_the_least(monitor, home):
    straight = dict(home, robot2=np.radians([0, -60, 5, 0, 45, 0]))
    monitor.check(0.0, home)
    monitor.check(1.0, straight)
    monitor.check(2.0, home)
    extremes = {(e.measure, e.robot): e for e in monitor.minima()}
    assert extremes["condition", "robot2"].t == 1.0
    assert extremes["elbow", "robot2"].t == 1.0
    assert extremes["elbow", "robot2"].value < math.radians(10)
    assert extremes["sigma_min", "robot2"].t == 1.0
    assert extremes["limit", "robot1"].parts == ("joint_2",)
    assert extremes["limit", "robot1"].value == pytest.approx(math.radians(20))


def test_outside_a_joint_limit(monitor, home):
    q = dict(home, robot1=np.radians([0, -141, 110, 0, 45, 90]))
    fault = monitor.check(0.0, q).fault
    assert fault.kind == "joint-limit"
    assert "axis 2 (`joint_2`) is at -141.00 deg, 1.00 deg outside its limits" in fault.message


def test_singularity_is_a_fault_on_a_line_only(monitor, home):
    q = dict(home, robot1=np.radians([0, -100, 100, 20, 0, 30]))
    assert monitor.check(0.0, q, kinds={"robot1": "ptp"}).fault is None
    fault = monitor.check(1.0, q, kinds={"robot1": "lin"}).fault
    assert fault.kind == "singularity"
    assert "wrist 0.0 deg from straight" in fault.message


def test_expecting_positions_changes_no_answer(cell, backend, home):
    rng = np.random.default_rng(7)
    path = {name: q + rng.uniform(-0.1, 0.1, (5, 6)) for name, q in home.items()}
    plain, expecting = Monitor(cell, backend), Monitor(cell, backend)
    expecting.expect(path)
    expecting.expect({next(iter(home)): next(iter(path.values()))[:0]})  # nothing comes next
    for i in range(5):
        joints = {name: p[i] for name, p in path.items()}
        one, other = plain.check(i, joints), expecting.check(i, joints)
        for a, b in zip(one.samples, other.samples, strict=True):
            assert np.array_equal(a.q, b.q)
            assert a.limit_axis == b.limit_axis
            assert a.conditioning.condition == pytest.approx(b.conditioning.condition)
            assert a.pose.x == pytest.approx(b.pose.x, abs=1e-12)


def test_works_without_distances(cell, home):
    verdict = Monitor(cell, FakeBackend(cell)).check(0.0, home)
    assert verdict.clearances is None
    assert verdict.fault is None


def test_positions_given_are_the_ones_measured(cell, backend, monitor):
    robot = cell.robot("robot1")
    e = RobotExecutor(replace(robot), cell.motion)
    e.begin(MoveJoint(pose_mm(5750, 5802.2, 2160.9, -105)), 0.0)
    e.finish()
    motion = e.begin(MoveLinear(pose_mm(0, 0, 100), "tool"), 0.0)
    sample = monitor.check(motion.ends, {"robot1": motion.q(motion.ends)}).samples[0]
    assert sample.pose.y == pytest.approx(motion.target.y, abs=1e-9)
    assert backend.tcp("robot1")[1, 3] == pytest.approx(sample.pose.y, abs=1e-12)


def test_what_stands_on_a_calm_plate_does_not_go_with_a_joint_move(monitor, backend, home):
    """Another arm grips it; while the plate turns, or where the owner's arm touches, nothing is permitted."""
    found = Clearance(
        "robots", "robot1", "box.1", "robot2/tool_tip", -1e-4, 0.002,
        second="robot2", rides=("robot1",),
    )  # fmt: skip
    moving = {"robot1": "ptp", "robot2": "tool"}

    def fault(gap, kinds=moving, calm=("robot1", "robot2")):
        backend.gaps = [gap]
        return monitor.check(0.0, home, kinds=kinds, calm=calm).fault

    assert fault(found) is None
    assert fault(found, calm=("robot2",)) is not None
    assert fault(found, kinds={**moving, "robot2": "ptp"}) is not None
    assert fault(replace(found, rides=())) is not None
    assert fault(replace(found, distance=-0.003)) is not None
    on_a_line = {"robot1": "lin", "robot2": "tool"}
    assert fault(found, on_a_line) is None
    assert fault(found, on_a_line, calm=("robot2",)) is not None
    assert fault(replace(found, rides=()), on_a_line, calm=("robot2",)) is None


def test_what_stands_on_an_axis_of_a_device_that_moves_is_not_touched(monitor, backend, home):
    """While the lift stands a tool may grip there, also while a door of the same device moves; and so the scene."""
    found = Clearance(
        "robots", "mill", "box.1", "robot2/tool_tip", -1e-4, 0.001,
        second="robot2", rides=("mill",), plates=("mill/lift",),
    )  # fmt: skip
    kinds = {"mill": "axis", "robot2": "lin"}

    def fault(gap, turning):
        backend.gaps = [gap]
        gap = replace(gap, robot="robot1")  # a pose that is known
        backend.gaps = [gap]
        return monitor.check(0.0, home, kinds=kinds, turning=turning).fault

    assert fault(found, ()) is None and fault(found, {"mill/door"}) is None
    assert fault(found, {"mill/lift"}) is not None
    beside = replace(found, kind="scene", b="fence", second="")
    assert fault(beside, {"mill/lift"}) is None


def test_a_part_in_a_tool_is_not_touched_by_a_door_that_moves(cell, backend, home):
    """It can be put down on axes of devices; while a door closes on it that was permitted up to a millimetre deep."""
    rule = ContactRule("*/box.*", "mill/door", 1e-3, "part")
    monitor = Monitor(replace(cell, scene=replace(cell.scene, contacts=(rule,))), backend)
    gap = Clearance("robots", "robot1", "robot1/box.1", "mill/door", -1e-4, 1e-3, second="mill")
    backend.gaps = [gap]
    fault = {
        axis: monitor.check(0.0, home, kinds={"mill": "axis"}, turning={axis}).fault is not None
        for axis in ("mill/door", "mill/lift")
    }
    assert fault == {"mill/door": True, "mill/lift": False}
    led = LedContacts(monitor._cell)
    going = MoveEnds(cell.robots[0], (), "", False, frozenset({"mill/door"}))
    found = {
        who: led.of_pair(
            gap.a, gap.b, {who: going}.get, {}, home.__getitem__, lambda _name: (0.0, 1.0)
        )
        for who in ("mill", "other")
    }
    assert found == {"mill": Led.ELSEWHERE, "other": Led.NEAR}
