"""A part that is carried may touch what its line lays it on or lifts it from, and nothing else on the way."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from helpers.row_of_boxes import TOP, Lines, cell_of, pose
from pn2code.robot.commands import MoveCircular, MoveLinear, Pose
from pn2code.robot.led_contacts import Led, LedContact

FLOOR = TOP
"""m: where the tool is when the box in it stands on the floor ..."""
STACKED = 2.0 * TOP
"""... and where it is when that stands on another box."""
BY = 5e-4
"""m: so deep a neighbour is grazed: less than contacts permit."""

ROW = (2.0, 1.2, 1.08, 1.45)
"""Where boxes are at the start; the first one is in the tool."""

Case = tuple[Pose, MoveLinear | MoveCircular, str, bool]
CASES: dict[str, Case] = {
    "set down on a box": (pose(1.2, 0.5), MoveLinear(pose(1.2, STACKED)), "box.2", True),
    "and a little into it": (pose(1.2, 0.5), MoveLinear(pose(1.2, STACKED - BY)), "box.2", True),
    "lifted from it": (pose(1.2, STACKED), MoveLinear(pose(1.2, 0.5)), "box.2", True),
    "on two boxes": (pose(1.14, 0.5), MoveLinear(pose(1.14, STACKED)), "box.3", True),
    "the rest is another line": (
        pose(1.2, 0.5), MoveLinear(pose(1.2, STACKED + 0.025)), "box.2", True,
    ),
    "over a box": (
        pose(0.8, STACKED - BY), MoveLinear(pose(1.7, STACKED - BY)), "box.2", False,
    ),
    "along the side of a box": (
        pose(1.35 + BY, 0.5), MoveLinear(pose(1.35 + BY, FLOOR)), "box.4", False,
    ),
    "up along its side": (pose(1.35 + BY, FLOOR), MoveLinear(pose(1.35 + BY, 0.5)), "box.4", False),
    "over a box and down": (
        pose(0.8, 0.5),
        MoveLinear(pose(1.45, STACKED), via=(pose(0.9, STACKED - BY), pose(1.35, STACKED - BY)), blend=0.001),
        "box.2", False,
    ),
    "on an arc over it": (
        pose(0.9, 0.5), MoveCircular(pose(1.2, STACKED - BY), pose(1.5, 0.5)), "box.2", False,
    ),
    "to the floor beside it": (pose(1.35, FLOOR + 0.1), MoveLinear(pose(1.35 + BY, FLOOR + BY)), "box.4", False),
}  # fmt: skip


@pytest.fixture(scope="module")
def lines() -> Iterator[Lines]:
    found = Lines(cell_of(ROW), holding=True)
    yield found
    found.backend.close()


@pytest.mark.bullet
@pytest.mark.parametrize(("first", "command", "other", "is_led"), CASES.values(), ids=CASES)
def test_a_run_and_a_proof_say_the_same(
    first: Pose,
    command: MoveLinear | MoveCircular,
    other: str,
    is_led: bool,
    lines: Lines,
) -> None:
    """Up to a millimetre deep nobody said anything."""
    leg = lines.leg(first, command)
    assert leg.path is not None
    led = lines.led_to(leg, 1.0, LedContact("robot", "box.1", other))
    assert (led is not Led.ELSEWHERE) is is_led
    seen = lines.seen(leg, *np.linspace(0.0, 1.0, 17).tolist())
    faults = {v.fault.message.split(" (")[0] for v in seen if v.fault is not None}
    said = f"robot `robot`: `robot/box.1` and `{other}` collide"
    assert said in faults if not is_led else not faults
    assert lines.proved(leg, other) == ("clear" if is_led else "touch")


@pytest.mark.bullet
def test_the_floor_is_touched_where_a_line_ends(lines: Lines) -> None:
    down = lines.leg(pose(1.3, 0.5), MoveLinear(pose(1.3, FLOOR - BY)))
    beside = MoveLinear(pose(1.0, 0.5), via=(pose(1.2, FLOOR - BY),), blend=0.001)
    assert lines.proved(down) == "clear"
    assert lines.proved(lines.leg(pose(1.3, 0.5), beside)) == "touch"
