"""What moves and pairs of moves come to does not depend on how many processes sweep them."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from tools.geometry.pairs import facing, moves

from pn2code.geometry import ahead
from pn2code.geometry.activities import Doing
from pn2code.geometry.activity import Activity
from pn2code.geometry.ahead import Ahead
from pn2code.geometry.apart import Apart
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Planner
from pn2code.geometry.shown import Shown
from pn2code.robot.bullet import BulletBackend

SOME = 4
"""Moves of each arm."""


def said(apart: Apart) -> tuple[Any, ...]:
    joints = tuple(tuple(np.asarray(q).tolist()) for q in apart.joints)
    return (
        apart.outcome,
        apart.least,
        apart.nearest,
        apart.where,
        apart.at,
        apart.why,
        joints,
        apart.is_whole,
    )


@pytest.mark.bullet
def test_processes_say_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = 0

    class Seen(Ahead[Any]):
        def take(self, task: int) -> Any:
            nonlocal taken
            taken += bool(self.processes)
            return super().take(task)

    monkeypatch.setattr("pn2code.geometry.compare.Ahead", Seen)
    monkeypatch.setattr(ahead, "WORTH", 5)
    cell = facing("dense")
    found = []
    for jobs in (1, 3):
        backend = BulletBackend(cell, looks=False)
        planner = Planner(cell)
        nothing = Doing(planner, cell).start
        left, right = (moves(planner, r, "dense", SOME) for r in ("left", "right"))
        compared = Comparison(cell, planner, Shown(backend))
        acts = [
            [Activity(0, ((leg, nothing),), leg.end, nothing) for leg in x] for x in (left, right)
        ]
        pairs = list(itertools.product(*acts))
        moved = [(leg, ()) for leg in (*left, *right)]
        with compared.moves_ahead(moved, jobs):
            around = [said(x) for leg, load in moved for x in compared.around(leg, load)]
        with compared.pairs_ahead(pairs, jobs, lambda i: i % 4 != 0):
            apart = [
                x for i, pair in enumerate(pairs) if i % 4 for _, _, x in compared.activities(*pair)
            ]
        touching = next(x for x in apart if x.outcome == "touch")
        deepest = compared.deepest(touching)  # also of what another process has found
        assert deepest.is_whole and deepest.nearest <= touching.nearest
        sizes = (compared.compared, compared.sweeper.queries)
        found.append((around, list(map(said, apart)), said(deepest), sizes))
        assert bool(taken) is (jobs > 1)
        backend.close()
    assert found[0] == found[1]
