"""Who has to do with plates that move: what a program does to parts, where those of others can take some along."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from helpers.belt_cell import TOML
from helpers.robot_cells import nowhere
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.activities import Doing
from pn2code.geometry.activity import Activity
from pn2code.geometry.legs import Planner
from pn2code.geometry.prisms import Prism
from pn2code.robot.commands import Along, Command, Handling, MoveExternal, ToolAction
from pn2code.robot.ground import REST_GAP
from pn2code.robot.scene import load

FEED = ToolAction("feed", 2.0, Handling("creates", "box", "entry"))
RUN = MoveExternal((Along("belt", 1.2, True),))
TURN = MoveExternal((Along("plate", math.pi / 2.0, False),))
PUT = ToolAction("put", 2.0, Handling("creates", "box", "on_plate"))


def doing_of(x: float, y: float, *, boxes: bool = True, z: float = 0.5) -> Doing:
    """A belt along y at x = 1.5 m, and a turntable of another device, with a box on it."""
    data: dict[str, Any] = tomllib.loads(TOML)
    plate = {
        "kind": "swing", "pose": {"x": x, "y": y, "z": z}, "from": -180.0, "to": 180.0,
        "objects": [{"name": "top", "kind": "cylinder", "radius": 0.3, "length": 0.02, "pose": {"z": -0.01}}],
    }  # fmt: skip
    data["devices"]["table"] = {"instance": "Table", "axes": {"plate": plate}}
    data["devices"]["hand"] = {"instance": "Hand"}
    data["places"]["on_plate"] = {"x": x + 0.1, "y": y, "z": z + 0.075}
    data["parts"]["box"]["at"] = [{"x": x, "y": y, "z": z + 0.075}] if boxes else []
    d = Diagnostics()
    cell = load(data, Path(), nowhere, d)
    assert cell is not None, [e.message for e in d.errors]
    return Doing(Planner(cell), cell)


def does(doing: Doing, name: str, *commands: Command) -> Activity:
    stands = tuple(doing.planner.home(r.name) for r in doing.start.parts.cell.moving)
    own = next((s for s in stands if s.robot == name), None)
    done = doing.of(name, commands, own, doing.start, stands)
    assert not done.fault and not done.doubt, (done.fault, done.doubt)
    return done


def test_a_belt_has_nothing_to_do_with_what_stands_on_a_turntable_elsewhere() -> None:
    doing = doing_of(3.0, 0.0)
    runs, turns = does(doing, "feeder", FEED, RUN), does(doing, "table", TURN)
    (ends,) = (m for m in runs.part_events if m.goes == "onto")
    assert ends.point[:2] == pytest.approx((1.5, -0.6))
    assert not doing.plates.part_events_near(turns, runs) and not doing.plates.part_events_near(
        runs, turns
    )


@pytest.mark.parametrize(("x", "is_near"), [(1.903, True), (1.91, False)])
def test_beside_a_belt_it_counts_how_far_the_turntable_comes(x: float, is_near: bool) -> None:
    """The box at the stop of the belt comes to 1.6, the table to 0.3 from x; what is within 6 mm may carry."""
    doing = doing_of(x, -0.6)
    runs, turns = does(doing, "feeder", FEED, RUN), does(doing, "table", TURN)
    found = doing.plates.part_events_near(turns, runs)
    assert bool(found) is is_near
    assert is_near or not doing.plates.part_events_near(runs, turns)


def test_who_puts_a_part_onto_a_plate_that_turns() -> None:
    doing = doing_of(3.0, 0.0, boxes=False)
    puts, turns = does(doing, "hand", PUT), does(doing, "table", TURN)
    ((plate, event),) = doing.plates.part_events_near(turns, puts)
    assert (
        plate == "table/plate"
        and event.plates == {plate}
        and doing.plates.moves_first(turns, plate)
    )
    assert (event.says, event.goes) == ("`hand` creates `box.1`", "on")


def test_what_passes_over_one_another_with_room_between_is_apart() -> None:
    """The box on the belt is up to 0.65 m: the table over it, with its rim 10 mm above or 3 mm."""
    for z, is_near in ((0.70, False), (0.673, True)):
        doing = doing_of(1.5, -0.6, boxes=False, z=z)
        runs, turns = does(doing, "feeder", FEED, RUN), does(doing, "table", TURN)
        assert bool(doing.plates.part_events_near(turns, runs)) is is_near, z


def test_rooms_are_near_if_something_in_them_is() -> None:
    """Random prisms, next to places in them."""
    random, counts = Random(5), [0, 0]
    draw = np.random.default_rng(5)
    for _ in range(300):
        shapes = []
        for _ in range(2):
            middle = draw.uniform(-0.17, 0.17, 3)
            corners = middle + draw.uniform(-0.2, 0.2, (random.choice([1, 2, 5]), 3))
            shapes.append((corners, random.choice([0.0, 0.05])))
        one, other = (Prism.around(c, rim) for c, rim in shapes)
        weights = [draw.dirichlet(np.full(len(c), 0.4), 400) @ c for c, _ in shapes]
        off = np.linalg.norm(weights[0][:, None, :2] - weights[1][None, :, :2], axis=2)
        heights = weights[0][:, None, 2] - weights[1][None, :, 2]
        rims = shapes[0][1] + shapes[1][1]
        is_seen = bool(((off <= rims + REST_GAP) & (np.abs(heights) <= rims + REST_GAP)).any())
        is_near = one.is_near(other)
        assert is_near == other.is_near(one) and (is_near or not is_seen)
        counts[is_near] += 1
    assert min(counts) > 40
