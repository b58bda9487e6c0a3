"""Pairs of moves: what is said of them next to samples, and how deep they touch is searched for where it is told."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tools.geometry.pairs import WORKLOADS, Workload, facing, moves

from pn2code.geometry import look
from pn2code.geometry.apart import Apart
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Planner
from pn2code.geometry.look import Look
from pn2code.geometry.pieces import Front, Level, gaps
from pn2code.geometry.progress import Meeting
from pn2code.geometry.shown import Shown
from pn2code.geometry.situation import Met
from pn2code.geometry.tracks import ArmShape, Track
from pn2code.robot.backend import Clearance
from pn2code.robot.bullet import BulletBackend


@pytest.mark.bullet
@pytest.mark.parametrize("workload", WORKLOADS)
def test_answers_hold_for_samples(workload: Workload) -> None:
    cell = facing(workload)
    backend = BulletBackend(cell, looks=False)
    planner = Planner(cell)
    left, right = (moves(planner, r, workload, 4) for r in ("left", "right"))
    compared = Comparison(cell, planner, Shown(backend))
    outcomes = set()
    for a in left:
        for b in right:
            found = compared.two((a, ()), (b, ()))
            outcomes.add(found.outcome)
            assert a.path is not None and b.path is not None
            if found.outcome == "touch":
                ways: Any = [(found.joints[0], found.joints[1])]
            else:
                ways = [
                    (q, p)
                    for q in a.path.on_way(np.linspace(0.0, 1.0, 8))
                    for p in b.path.on_way(np.linspace(0.0, 1.0, 8))
                ]
            distances = []
            for q, p in ways:
                backend.set_joints("left", q)
                backend.set_joints("right", p)
                near = backend.distances.pairs("robots", "left", 0.5, "right")
                distances.append(min((c.distance for c in near), default=0.5))
            if found.outcome == "touch":
                assert min(distances) == pytest.approx(found.nearest) and found.nearest < 0.0
            else:
                assert found.outcome == "clear" and found.least <= min(distances)
    backend.close()
    assert outcomes >= {"clear"} and (workload == "far" or "touch" in outcomes)


@pytest.mark.bullet
def test_links_that_are_left_out_are_far_apart() -> None:
    """In halves of halves no pair of links is missing that may be near, and bounds are those of all links."""
    cell = facing("dense")
    backend = BulletBackend(cell, looks=False)
    planner = Planner(cell)
    a, b = (
        Track(ArmShape.of(cell.robot(r), backend), moves(planner, r, "dense", 1)[0])
        for r in ("left", "right")
    )
    backend.close()
    front = Front.whole(a, b)
    kept = 0.1
    for _ in range(7):
        level = Level(front, a, b)
        for piece, (x, y, z, w) in enumerate(front.pieces):
            one, other = a.knots(*np.array([[x], [y]])), b.knots(*np.array([[z], [w]]))
            bound = gaps(one, a.radii, other, b.radii)[0]
            bound -= one.spread[0][:, None] + other.spread[0][None, :]
            mine = front.row == piece
            assert level.bound[mine] == pytest.approx(bound[front.one[mine], front.other[mine]])
            bound[front.one[mine], front.other[mine]] = np.inf
            assert bound.min() > kept - 1e-6
        everything = np.arange(len(front.pieces))
        front = front.halves(level, everything, level.bound <= kept)
    assert len(front.pieces) == 128 and 0 < len(front.row) < 0.8 * 128 * a.radii.size * b.radii.size


def test_depths_are_searched_for_one_of_each_two_robots_and_then_as_far_as_it_goes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def touch(deep: float) -> Apart:
        gap = Clearance("robots", "r", "r/link_4", "s/link_4", -deep, None, (0.0, 0.0, 1.0))
        return Apart("touch", -np.inf, -deep, gap, is_whole=False)

    sweeper = SimpleNamespace(queries=0)

    def deepest(apart: Apart) -> Apart:
        sweeper.queries += 100
        assert apart.where is not None
        return Apart("touch", apart.nearest - 0.001, apart.nearest, apart.where)

    self: Any = SimpleNamespace(
        comparison=SimpleNamespace(sweeper=sweeper, deepest=deepest), _run=lambda *_: None
    )
    robots = [("r", "s"), ("r", "s"), ("s", "t"), ("r", "s")]
    depths = [0.01, 0.03, 0.02, 0.025]
    meetings = [
        Meeting(who, ("A", "B"), ("", f"does {i}"), touch(deep), Met(0, (0, 1)))
        for i, (who, deep) in enumerate(zip(robots, depths, strict=True))
    ]
    for most, known in ((0, [1, 2]), (300, [1, 2, 3]), (6_000, [0, 1, 2, 3])):
        monkeypatch.setattr(look, "MOST_DEPTHS", most)
        sweeper.queries = 0
        pairs = Look._reported(self, Any, meetings)  # type: ignore[arg-type]
        assert [i for i, p in enumerate(pairs) if p.row()["at_least_m"] is not None] == known
        for i, p in enumerate(pairs):
            assert p.answer == "no"
            assert ("overlap by at least" in p.says) == (i not in known)
            assert ("nowhere on the way by more than" in p.says) == (i in known)
    # What is the same but for the run is one.
    again = Look._reported(self, Any, [*meetings, replace(meetings[0], met=Met(5, (0, 1)))])  # type: ignore[arg-type]
    assert len(again) == 5 and again[4] is again[0]
