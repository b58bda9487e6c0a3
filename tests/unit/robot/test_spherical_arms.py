"""Arms of several makers with a spherical wrist: data sheets, all branches, a second inverse, shapes that keep off."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.kinematics import BRANCHES, Kinematics
from pn2code.robot.model import find_arm
from pn2code.robot.monitor import Monitor
from pn2code.robot.scene import load
from pn2code.robot.transforms import difference

HERE = Origin("cell.toml")
# Reach (m) of the middle of the wrist (of TX2-90: of the flange), limits and speeds, from the makers' data sheets.
PUBLISHED = {
    "irb6700_200_260": (
        2.60,
        [(-170, 170), (-65, 85), (-180, 70), (-300, 300), (-130, 130), (-360, 360)],
        [110, 110, 110, 190, 150, 210],
    ),
    "gp25": (
        1.73,
        [(-180, 180), (-105, 155), (-86, 160), (-200, 200), (-150, 150), (-455, 455)],
        [210, 210, 265, 420, 420, 885],
    ),
    "tx2_90": (
        1.0,
        [(-180, 180), (-130, 147.5), (-145, 145), (-270, 270), (-115, 140), (-270, 270)],
        [400, 400, 430, 540, 475, 760],
    ),
}
HOMES = {
    "irb6700_200_260": [0, -20, 20, 0, 60, 0],
    "gp25": [0, -20, -20, 0, -60, 0],
    "tx2_90": [0, -20, 100, 0, 60, 0],
}


def kinematics(name: str) -> Kinematics:
    d = Diagnostics()
    arm = find_arm(name, Path(), HERE, d)
    assert arm is not None, list(d)
    found = Kinematics.of(arm, None, HERE, d)
    assert found is not None, list(d)
    return found


def positions(k: Kinematics, count: int) -> Any:
    return np.random.default_rng(7).uniform(k.arm.lower, k.arm.upper, (count, 6))


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_arm_is_that_of_the_data_sheet(name: str) -> None:
    k = kinematics(name)
    reach, limits, speeds = PUBLISHED[name]
    assert np.degrees(k.arm.lower) == pytest.approx([low for low, _ in limits])
    assert np.degrees(k.arm.upper) == pytest.approx([high for _, high in limits])
    assert np.degrees(k.arm.velocity) == pytest.approx(speeds)
    # As far as it gets from axis 1, whatever axes 2 and 3 do inside their limits.
    low, high = k.arm.lower, k.arm.upper
    x, y = np.meshgrid(np.linspace(low[1], high[1], 200), np.linspace(low[2], high[2], 200))
    q = np.zeros((x.size, 6))
    q[:, 1], q[:, 2] = x.ravel(), y.ravel()
    frames = k.link_frames(q)
    end = frames[6] if name == "tx2_90" else frames[4]
    assert np.abs(end[:, 0, 3]).max() == pytest.approx(reach, rel=0.005)


@pytest.mark.parametrize("name", PUBLISHED)
def test_each_position_is_found_again_and_so_are_the_other_branches(name: str) -> None:
    k = kinematics(name)
    q = positions(k, 200)
    poses = k.forward_many(q)
    rows = k.all_branches(poses)
    there = ~np.isnan(rows[:, :, 0])
    assert there.sum(1).min() >= 4
    assert np.abs(k.forward_many(rows[there]) - np.repeat(poses, there.sum(1), axis=0)).max() < 1e-8
    own = np.array([rows[i, k.branch_of(x).index] for i, x in enumerate(q)])
    assert np.abs((own - q + math.pi) % (2 * math.pi) - math.pi).max() < 1e-6
    assert (there.sum(1) == len(BRANCHES)).any()


def numeric(k: Kinematics, target: Any, start: Any) -> Any:
    """A second inverse: damped Newton steps on the forward kinematics, nothing else."""
    q = start.copy()
    for _ in range(60):
        now = k.forward(q)
        turn = target[:3, :3] @ now[:3, :3].T
        spin = 0.5 * np.array(
            [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        )
        error = np.concatenate([target[:3, 3] - now[:3, 3], spin])
        columns = []
        for axis in range(6):  # the Jacobian by differences
            step = q.copy()
            step[axis] += 1e-6
            there = k.forward(step)
            by = (there[:3, :3] - now[:3, :3]) @ now[:3, :3].T / 1e-6
            columns.append([*((there[:3, 3] - now[:3, 3]) / 1e-6), by[2, 1], by[0, 2], by[1, 0]])
        j = np.array(columns).T
        q = q + j.T @ np.linalg.solve(j @ j.T + 1e-10 * np.eye(6), error)
        if np.abs(error).max() < 1e-12:
            break
    return q


OTHERS = ("kr210_r2700", "kr120_r2500", "ur10e", "ur5e")
"""Arms of other files, which have no second inverse there."""


@pytest.mark.parametrize("name", [*PUBLISHED, *OTHERS])
def test_a_second_inverse_finds_the_same(name: str) -> None:
    if name.startswith("ur"):
        pytest.importorskip("eaik")
    k = kinematics(name)
    compared = 0
    for q in positions(k, 30):
        if k.conditioning(q).condition > 30.0:
            continue
        target = k.forward(q)
        found = numeric(k, target, q + 0.05)
        if max(difference(k.forward(found), target)) > 1e-9:
            continue
        rows = k.all_branches(target[None])[0]
        away = np.abs((rows - found + math.pi) % (2 * math.pi) - math.pi).max(axis=1)
        assert np.nanmin(away) < 1e-7
        compared += 1
    assert compared >= 8


@pytest.mark.bullet
@pytest.mark.parametrize("name", PUBLISHED)
def test_its_links_keep_apart_at_a_home(name: str) -> None:
    d = Diagnostics()
    data = {"robots": {"r": {"model": name, "base": {}, "home": HOMES[name]}}}
    cell = load(data, Path(), lambda *_: HERE, d)
    assert cell is not None, [e.message for e in d.errors]
    backend = BulletBackend(cell, looks=True)
    verdict = Monitor(cell, backend).check(0.0, {"r": np.array(cell.robots[0].home)})
    backend.close()
    assert verdict.fault is None, verdict.fault
    assert not verdict.warnings, verdict.warnings


@pytest.mark.bullet
@pytest.mark.parametrize("name", PUBLISHED)
def test_most_of_the_reach_is_free_of_the_arm_itself(name: str) -> None:
    """Shapes that are too large would make moves impossible that the arm can do."""
    d = Diagnostics()
    data = {"robots": {"r": {"model": name, "base": {}, "home": HOMES[name]}}}
    cell = load({**data, "scene": {"floor": False}}, Path(), lambda *_: HERE, d)
    assert cell is not None, [e.message for e in d.errors]
    backend = BulletBackend(cell, looks=False)
    monitor = Monitor(cell, backend)
    q = positions(cell.robots[0].kinematics, 150)
    free = [monitor.check(float(i), {"r": x}).fault is None for i, x in enumerate(q)]
    backend.close()
    assert sum(free) > 0.6 * len(free)
