"""A tool that grips parts may touch the one to which its line leads, and none of the others of the same kind."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import pytest

from helpers.stacking_cell import TOML
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Planner
from pn2code.geometry.shown import Shown
from pn2code.robot.active_motion import MotionKind
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import MoveJoint, MoveLinear, Pose
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.monitor import Monitor
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

TOP = 0.15
FAR, OVER, BESIDE = "box.1", "box.2", "box.3"
"""In a row, 0.2 m apart: one is gripped, the tool comes over the next one, and from the side of a third."""


def cell_of(**changes: object) -> RobotCell:
    data = tomllib.loads(TOML)
    data["parts"]["box"]["size"] = [0.1, 0.1, 0.15]
    row = ((1.4, -1.1), (1.2, -1.1), (1.0, -1.1))
    data["parts"]["box"]["at"] = [{"x": x, "y": y, "z": 0.075} for x, y in row]
    data["robots"]["robot"] |= changes
    d = Diagnostics()
    found = load(data, Path(), lambda *_: Origin("cell.toml"), d)
    assert found is not None, [e.message for e in d.errors]
    return found


def pose(x: float, z: float) -> Pose:
    return Pose(x, -1.1, z, math.pi, 0.0, 0.0)


def line(*path: Pose) -> tuple[MoveJoint, MoveLinear]:
    first, last = path
    return MoveJoint(first), MoveLinear(last)


GRIP = line(pose(1.1, TOP + 0.003), pose(1.4, TOP + 0.003))
"""From beside the second box, close above it, to the first one."""
CASES = {
    "a neighbour that is passed": (GRIP, OVER, "lin", False),
    "the part that is gripped": (GRIP, FAR, "lin", True),
    "the way back": (line(pose(1.4, TOP + 0.003), pose(1.1, TOP + 0.003)), FAR, "lin", True),
    "the rest of the way is another line": (
        line(pose(1.4, 0.4), pose(1.4, TOP + 0.025)), FAR, "lin", True,
    ),
    "a line that ends too early": (line(pose(1.4, 0.4), pose(1.4, TOP + 0.1)), FAR, "lin", False),
    "worked on beside its grip": (line(pose(1.44, 0.4), pose(1.44, TOP)), FAR, "lin", True),
}  # fmt: skip


@pytest.mark.parametrize(("move", "part", "kind", "known"), CASES.values(), ids=CASES)
def test_which_part_a_line_leads_to(
    move: tuple[MoveJoint, MoveLinear], part: str, kind: MotionKind, known: bool
) -> None:
    cell = cell_of()
    planner, parts = Planner(cell), Parts(cell)
    leg = planner.leg(planner.leg(planner.home("robot"), move[0]).end, move[1])
    assert leg.path is not None and leg.kind == kind
    own = parts.present[part]
    assert MoveEnds.of(cell.robot("robot"), "", leg.path).is_at(own, parts.world(own)) is known


@pytest.mark.bullet
@pytest.mark.parametrize("deep", [0.0, 0.0035])
def test_a_run_and_a_proof_see_a_neighbour_that_is_grazed(
    deep: float, request: pytest.FixtureRequest
) -> None:
    """The run said nothing of 3 mm above it, and neither did anything of half a millimetre in it."""
    cell = cell_of()
    backend = BulletBackend(cell, looks=False)
    request.addfinalizer(backend.close)
    planner, parts = Planner(cell), Parts(cell)
    z = TOP + 0.003 - deep
    over = planner.leg(planner.home("robot"), MoveJoint(pose(1.1, z)))
    leg = planner.leg(over.end, MoveLinear(pose(1.4, z)))
    assert leg.path is not None
    ends = MoveEnds.of(cell.robot("robot"), "", leg.path)

    def leads_to(robot: str, name: str) -> bool:
        own = parts.present[name]
        return robot == "robot" and ends.is_at(own, parts.world(own))

    for part in parts.present.values():
        backend.set_part(part)
    passing = planner.leg(over.end, MoveLinear(pose(1.2, z)))
    seen = {}
    for name, stand in ((OVER, passing.end), (FAR, leg.end)):
        joints = {r.name: r.home for r in cell.moving} | {"robot": stand.q}
        seen[name] = Monitor(cell, backend).check(
            0.0, joints, kinds={"robot": "lin"}, leads_to=leads_to
        )
    warned = {at: [w.b for w in v.warnings if w.b.startswith("box")] for at, v in seen.items()}
    assert warned == {OVER: [OVER], FAR: []}
    assert [v.fault is not None for v in seen.values()] == [deep > 0.0, False]
    for part in parts.present.values():
        backend.remove_part(part.name)
    comparison = Comparison(cell, planner, Shown(backend))
    outcomes = [comparison.beside((leg, ()), parts.present[p]).outcome for p in (FAR, OVER)]
    assert outcomes == ["clear", "touch" if deep else "clear"]


def test_a_robot_that_carries_none_works_on_all() -> None:
    """`carries` says what its tool grips; the contacts of one that grips nothing stay as they are."""
    rules = {name: cell_of(**change).scene.contacts for name, change in
             {"grips": {}, "works": {"carries": []}}.items()}  # fmt: skip
    grips = {name: any(r.grips for r in found) for name, found in rules.items()}
    assert grips == {"grips": True, "works": False}
