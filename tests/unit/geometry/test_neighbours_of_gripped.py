"""A tool that grips parts may touch the one to which its line leads, and none of the others of the same kind."""

from __future__ import annotations

import pytest

from helpers.row_of_boxes import TOP, Lines, cell_of, pose
from pn2code.geometry.legs import Planner
from pn2code.robot.commands import MoveJoint, MoveLinear, Pose
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.parts import Parts
from pn2code.robot.parts_table import PartKind

FAR, OVER = "box.1", "box.2"
"""In a row, 0.2 m apart: one is gripped, and the tool comes over the next one."""

GRIP = pose(1.1, TOP + 0.003), pose(1.4, TOP + 0.003)
"""From beside the second box, close above it, to the first one."""
CASES = {
    "a neighbour that is passed": (GRIP, OVER, False),
    "the part that is gripped": (GRIP, FAR, True),
    "the way back": (GRIP[::-1], FAR, True),
    "the rest of the way is another line": ((pose(1.4, 0.4), pose(1.4, TOP + 0.025)), FAR, True),
    "a line that ends too early": ((pose(1.4, 0.4), pose(1.4, TOP + 0.1)), FAR, False),
    "worked on beside its grip": ((pose(1.44, 0.4), pose(1.44, TOP)), FAR, True),
}


@pytest.mark.parametrize(("move", "part", "known"), CASES.values(), ids=CASES)
def test_which_part_a_line_leads_to(move: tuple[Pose, Pose], part: str, known: bool) -> None:
    cell = cell_of()
    planner, own = Planner(cell), Parts(cell).present[part]
    over = planner.leg(planner.home("robot"), MoveJoint(move[0]))
    leg = planner.leg(over.end, MoveLinear(move[1]))
    assert leg.path is not None and isinstance(own.kind, PartKind)
    assert MoveEnds.of(cell.robot("robot"), "", leg.path).is_at(own.kind, own.frame) is known


@pytest.mark.bullet
@pytest.mark.parametrize("deep", [0.0, 0.0035])
def test_a_run_and_a_proof_see_a_neighbour_that_is_grazed(
    deep: float, request: pytest.FixtureRequest
) -> None:
    """The run said nothing of 3 mm above it, and neither did anything of half a millimetre in it."""
    lines = Lines(cell_of())
    request.addfinalizer(lines.backend.close)
    z = TOP + 0.003 - deep
    leg = lines.leg(pose(1.1, z), MoveLinear(pose(1.4, z)))
    passing = lines.planner.leg(leg.start, MoveLinear(pose(1.2, z))).end
    seen = dict(zip((OVER, FAR), lines.seen(leg, passing.q, leg.end.q), strict=True))
    warned = {at: [w.b for w in v.warnings if w.b.startswith("box")] for at, v in seen.items()}
    assert warned == {OVER: [OVER], FAR: []}
    assert [v.fault is not None for v in seen.values()] == [deep > 0.0, False]
    assert [lines.proved(leg, p) for p in (FAR, OVER)] == ["clear", "touch" if deep else "clear"]


def test_a_robot_that_carries_none_works_on_all() -> None:
    """`carries` says what its tool grips; the contacts of one that grips nothing stay as they are."""
    rules = {name: cell_of(**change).scene.contacts for name, change in
             {"grips": {}, "works": {"carries": []}}.items()}  # fmt: skip
    grips = {name: any(r.led == "tool" for r in found) for name, found in rules.items()}
    assert grips == {"grips": True, "works": False}
