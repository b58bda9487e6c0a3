"""The least clearances of a run: none is larger than what the same run has warned of."""

from __future__ import annotations

import random
from collections.abc import Mapping

import numpy as np
import pytest

from helpers.robot_cells import riveting_cell
from pn2code.report.summary import minima
from pn2code.robot.active_motion import MotionKind
from pn2code.robot.backend import Clearance
from pn2code.robot.fake import FakeBackend
from pn2code.robot.monitor import Monitor, Verdict
from pn2code.robot.robot_cell import RobotCell
from pn2code.run.record import NEAR, RunRecord

POST = Clearance("scene", "robot1", "robot1/tool_body", "post", 0.045)
STANDING = Clearance("scene", "robot1", "robot1/tool_tip", "bar.1", 0.0083, 0.001)
CARRIED = Clearance("scene", "robot1", "robot1/bar.2", "post", 0.0065, 0.001)
ON_BELT = Clearance(
    "robots", "robot1", "robot1/tool_tip", "bar.3", 0.0071, 0.001,
    second="belt", rides=("belt",), plates=("belt/belt",),
)  # fmt: skip


class Scripted(FakeBackend):
    """Distances that the test gives."""

    def __init__(self, cell: RobotCell) -> None:
        super().__init__(cell)
        self.gaps: tuple[Clearance, ...] = ()

    def clearances(self, limit: float) -> tuple[Clearance, ...] | None:
        return self.gaps


class Watched:
    """A run of which a test says what is near."""

    def __init__(self) -> None:
        cell = riveting_cell("good")
        self.backend = Scripted(cell)
        self.record = RunRecord("cell", "", "bullet")
        self._monitor = Monitor(cell, self.backend)
        self._home = {r.name: np.array(r.home) for r in cell.robots}

    def see(self, kinds: Mapping[str, MotionKind], *gaps: Clearance) -> Verdict:
        """One more moment."""
        self.backend.gaps = gaps
        t = 0.02 * len(self.record.sample_t)
        verdict = self._monitor.check(t, self._home, kinds=kinds, calm=["belt"])
        self.record.sample(verdict)
        return verdict

    def least(self, name: str) -> float:
        """A figure, m."""
        return float(np.nanmin(self.record.array(f"clearance.{name}")))


@pytest.fixture
def run() -> Watched:
    return Watched()


@pytest.mark.parametrize(
    ("gap", "figure"),
    [(STANDING, "scene.robot1"), (CARRIED, "scene.robot1"), (ON_BELT, "robots")],
    ids=["a part that stands", "a part that is carried", "a part on a belt"],
)
def test_what_may_be_touched_on_lines_counts_on_joint_moves(
    run: Watched, gap: Clearance, figure: str
) -> None:
    """The figure said 45 mm where the warning, rightly, said 8.3 mm; and no line was shown there."""
    verdict = run.see({"robot1": "ptp"}, gap, POST)
    assert [w.distance for w in verdict.warnings] == [gap.distance]
    assert run.least(figure) == gap.distance
    assert run.least("scene.robot1") == min(g.distance for g in (gap, POST) if g.kind == "scene")
    assert (gap.a, gap.b) in {(g.a, g.b) for _, g in run.record.gaps}


def test_a_figure_names_the_two_that_are_nearest(run: Watched) -> None:
    """Those of the least distance, though others are near before and after."""
    for near in (POST, STANDING, POST):
        run.see({"robot1": "ptp"}, near)
    assert minima(run.record) == {
        "scene.robot1": {"m": 0.0083, "t": 0.02, "between": ["robot1/tool_tip", "bar.1"]}
    }


@pytest.mark.parametrize("kind", ["lin", "tool", None])
def test_what_is_gripped_or_put_is_in_neither(run: Watched, kind: MotionKind | None) -> None:
    kinds: dict[str, MotionKind] = {} if kind is None else {"robot1": kind}
    verdict = run.see(kinds, STANDING, CARRIED, POST)
    assert verdict.warnings == ()
    assert run.least("scene.robot1") == POST.distance
    assert [g.b for _, g in run.record.gaps] == ["post"]


def test_a_contact_that_is_deeper_than_permitted_counts(run: Watched) -> None:
    deep = Clearance("scene", "robot1", "robot1/tool_tip", "bar.1", -0.003, 0.001)
    assert run.see({"robot1": "lin"}, deep, POST).fault is not None
    assert run.least("scene.robot1") == -0.003


def test_no_figure_is_larger_than_a_warning(run: Watched) -> None:
    """Also of many that are near at once, and of which each one that is warned of has its line."""
    chance = random.Random(3)
    known: tuple[MotionKind, ...] = ("ptp", "lin", "tool")
    for _ in range(200):
        kinds = {name: chance.choice(known) for name in ("robot1", "robot2")}
        gaps = [
            Clearance(
                chance.choice(("robots", "scene", "self")), "robot1", "robot1/tool_tip", f"bar.{k}",
                chance.uniform(0.001, 0.2), chance.choice((None, 0.001)), second="robot2",
            )
            for k in range(6)
        ]  # fmt: skip
        verdict = run.see(kinds, *gaps)
        for warned in verdict.warnings:
            name = "robots" if warned.kind == "robots" else f"{warned.kind}.robot1"
            assert run.record.array(f"clearance.{name}")[-1] <= warned.distance < NEAR
        t = verdict.t
        lines = {(g.a, g.b): g.distance for at, g in run.record.gaps if at == t}
        assert all(lines[w.a, w.b] <= w.distance for w in verdict.warnings)
    assert run.record.near
