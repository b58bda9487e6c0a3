"""`place` judges placings by the contacts that a run permits: of what a tool grips, and of what is carried."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from helpers.row_of_boxes import TOP, Lines, cell_of, pose
from pn2code.geometry.placing.free import parse
from pn2code.geometry.placing.judging import Judge
from pn2code.geometry.placing.plan import Among, Plan, Step
from pn2code.robot.commands import MoveJoint, MoveLinear, Pose

ROW = (2.0, 1.4, 1.2)
BY = 5e-4
"""m: so deep a neighbour is grazed: less than contacts permit."""
STACKED = 2.0 * TOP

CASES: dict[str, tuple[bool, Pose, Pose, bool]] = {
    "a box is gripped": (False, pose(1.4, 0.4), pose(1.4, TOP), True),
    "a box beside it is grazed": (False, pose(1.1, TOP - BY), pose(1.4, TOP - BY), False),
    "a box is set down on another": (True, pose(1.4, 0.5), pose(1.4, STACKED), True),
    "a box is carried over another": (True, pose(1.0, STACKED - BY), pose(1.7, STACKED - BY), False),
    "a box is carried along another": (True, pose(1.3 + BY, 0.5), pose(1.3 + BY, TOP + 0.01), False),
}  # fmt: skip


@pytest.fixture(scope="module")
def lines() -> Iterator[Lines]:
    found = Lines(cell_of(ROW), holding=True)
    yield found
    found.backend.close()


@pytest.mark.bullet
@pytest.mark.parametrize(("holds", "first", "last", "is_well"), CASES.values(), ids=CASES)
def test_what_is_touched(holds: bool, first: Pose, last: Pose, is_well: bool, lines: Lines) -> None:
    """It knew of no parts, and of no contact rule but that of joint moves."""
    present = lines.parts.present
    among = Among(lines.held if holds else (), (present["box.2"], present["box.3"]))
    plan = Plan((Step(-1, MoveJoint(first)), Step(0, MoveLinear(last), (among,))))
    judge = Judge(lines.cell, {}, {"robot": plan}, parse(("robot.base.x",), lines.cell, 1.0))
    try:
        walked = judge.walk((0.0,), 0.0)
    finally:
        judge.close()
    assert walked.done == 1.0
    assert (walked.clearance > 0.0) is is_well
