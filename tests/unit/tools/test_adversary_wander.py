"""Random runs of programs: what their clock does."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import cast

import pytest
from tools.adversary.wander import SUPERVISOR, _Wanderer

from pn2code.run.runner import RobotRunner


@pytest.mark.parametrize(("held", "expected"), [(0.0, math.nextafter(1.0, 2.0)), (3.0, 3.0)])
def test_a_random_run_sees_that_an_answer_is_late(held: float, expected: float) -> None:
    """It went on until a command ended: the supervisor stopped later than in a cell, or not at all."""
    engine = _Wanderer.__new__(_Wanderer)
    engine.now, engine.held = 0.5, {SUPERVISOR: held}
    engine.robots = cast(list[RobotRunner], [SimpleNamespace(motion=SimpleNamespace(ends=5.0))])
    engine._next_model_time, engine._finished, engine._answer_due = None, False, 1.0
    assert engine._next_event() == expected
