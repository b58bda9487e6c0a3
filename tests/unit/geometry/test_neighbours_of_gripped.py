"""A tool that grips parts may touch the one to which its line leads, and none of the others of the same kind."""

from __future__ import annotations

import math

import numpy as np
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
    seen = dict(zip((OVER, FAR), lines.seen(leg, 1.0 / 3.0, 1.0), strict=True))
    warned = {at: [w.b for w in v.warnings if w.b.startswith("box")] for at, v in seen.items()}
    assert warned == {OVER: [OVER], FAR: []}
    assert [v.fault is not None for v in seen.values()] == [deep > 0.0, False]
    assert [lines.proved(leg, p) for p in (FAR, OVER)] == ["clear", "touch" if deep else "clear"]


OVERSHOT = MoveLinear(
    pose(1.4, TOP + 0.003), via=(pose(1.4, TOP - 5e-4), pose(1.4, 0.6)), blend=0.001
)
"""Half a millimetre into the box (less, as the corner is rounded), up again, and down to grip it."""
DEEPEST = 0.4505 / 1.348
"""Where on this way that is."""
ALONG = MoveLinear(pose(1.4, TOP - 5e-4))
"""From beside its middle, half a millimetre in it."""


@pytest.mark.bullet
@pytest.mark.parametrize(
    ("first", "command", "way", "stopped"),
    [
        (pose(1.4, 0.6), OVERSHOT, None, "touch"),
        (pose(1.4, 0.6), OVERSHOT, 1.0, "clear"),
        (pose(1.36, TOP - 5e-4), ALONG, None, "clear"),
        (pose(1.36, TOP - 5e-4), ALONG, 0.021, "clear"),  # it comes from there, too
        (pose(1.36, TOP - 5e-4), ALONG, 0.019, "touch"),
        (pose(1.36, TOP + 3e-4), ALONG, 0.0, "touch"),
    ],
)
def test_a_part_is_touched_only_near_where_it_is_gripped(
    first: Pose,
    command: MoveLinear,
    way: float | None,
    stopped: str,
    request: pytest.FixtureRequest,
) -> None:
    """It could be touched on the whole way that led to it."""
    lines = Lines(cell_of(way=way))
    request.addfinalizer(lines.backend.close)
    leg = lines.leg(first, command)
    seen = lines.seen(leg, *np.linspace(0.0, 1.0, 15).tolist(), DEEPEST)
    said = {v.fault.message for v in seen if v.fault is not None}
    assert ("touch" if said else "clear") == stopped == lines.proved(leg, FAR)
    assert all(
        "further from where the move leads than `contact_way` of the part" in x for x in said
    )
    assert not any(w.b == FAR for v in seen for w in v.warnings), "it is no news"


def test_a_part_may_be_touched_as_far_as_it_is_long() -> None:
    assert cell_of().parts["box"].way == pytest.approx(math.hypot(0.1, 0.1, TOP))


def test_a_robot_that_carries_none_works_on_all() -> None:
    """`carries` says what its tool grips; the contacts of one that grips nothing stay as they are."""
    rules = {name: cell_of(**change).scene.contacts for name, change in
             {"grips": {}, "works": {"carries": []}}.items()}  # fmt: skip
    grips = {name: any(r.led == "tool" for r in found) for name, found in rules.items()}
    assert grips == {"grips": True, "works": False}
