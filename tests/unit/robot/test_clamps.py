"""Clamps that must not close on nothing: in runs, and over all that a net permits."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from helpers.door_cell import TOML
from helpers.robot_cells import nowhere
from helpers.tool_cell import placed
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.activities import Doing
from pn2code.geometry.answers import Layout, Move
from pn2code.geometry.legs import Planner, Stand
from pn2code.geometry.report import text
from pn2code.geometry.where import stands_at
from pn2code.geometry.words import carrying
from pn2code.robot.clamps import closed_on, closes, closing, nearest, on_nothing, shut
from pn2code.robot.commands import (
    Along,
    Handling,
    MoveExternal,
    MoveHome,
    MoveJoint,
    Pose,
    ToolAction,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.part import Part
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import matrix_of


def cell_of(more: str = "", at: str = "{ x = 1.0, z = 0.675 }") -> RobotCell:
    """The mill with a blank in its vice, which is open."""
    toml = TOML.replace("home = 0.04", "home = 0.12").replace(
        "at = [{ y = -0.9, z = 0.575 }]", f"at = [{at}]"
    )
    assert toml.count(at) == 1
    d = Diagnostics()
    data: dict[str, Any] = tomllib.loads(
        toml.replace('holds = "inVice"', f'holds = "inVice"{more}')
    )
    found = load(data, Path(), nowhere, d)
    assert found is not None, [e.message for e in d.errors]
    return found


def grasp(gap: float) -> MoveExternal:
    return MoveExternal((Along("vice", gap, True),))


def closed(cell: RobotCell, *gaps: float) -> Any:
    """What the mill comes to that lets its vice go to these gaps."""
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("mill")
    return doing.of("mill", tuple(map(grasp, gaps)), home, doing.start, (home,))


def test_only_moves_that_close_it_matter() -> None:
    mill = cell_of().robot("mill")
    open_, half, shut = (np.array([0.0, g / 2.0, g / 2.0]) for g in (0.12, 0.07, 0.06))
    assert [h.name for h in closing(mill, open_, shut)] == ["mill/vice"]
    assert [h.name for h in closing(mill, half, shut)] == ["mill/vice"]
    for before, after in ((shut, open_), (shut, half), (shut, shut)):
        assert not list(closing(mill, before, after))
    assert closes(mill, grasp(0.06))
    assert not closes(mill, MoveExternal((Along("door", 0.9, True),)))
    free = cell_of("\nmay_be_empty = true").robot("mill")
    assert not closes(free, grasp(0.06)) and not list(closing(free, open_, shut))


def test_what_it_closes_on_is_as_near_as_can_be_gripped() -> None:
    cell = cell_of()
    (held,) = closing(cell.robot("mill"), np.array([0.0, 0.06, 0.06]), np.array([0.0, 0.03, 0.03]))
    blank = cell.parts["blank"]
    spot = matrix_of(cell.places["inVice"])
    for off, is_there in ((0.0, True), (0.0049, True), (0.0051, False)):
        frame = spot.copy()
        frame[1, 3] += off
        near = nearest(cell, held, [(Part("blank.1", blank, frame), frame)])
        assert (near.off <= 0.0) is is_there, off
    assert on_nothing(held, near) == (
        "`mill/vice` closes on nothing: no part is at `inVice`; the nearest, `blank.1`, is 5.1 mm away"
    )
    held_out = Part("blank.1", blank, np.eye(4), "arm")
    assert on_nothing(held, nearest(cell, held, [(held_out, frame)])).endswith(
        "; the nearest, `blank.1`, in the tool of `arm`, is 5.1 mm away"
    )
    assert on_nothing(held, nearest(cell, held, [])).endswith("no part is at `inVice`")


def test_where_a_device_stands_is_said_by_its_axes() -> None:
    """It has no TCP; `check --geometry` says so where its moves begin."""
    mill = cell_of().robot("mill")
    stand = Stand(0, "mill", np.array([0.9, 0.06, 0.0605]), np.eye(4))
    assert stands_at(mill, stand) == "door 900, vice 120.5"
    move = Move(
        "mill",
        "Mill.Close",
        "external with vice 60",
        stands_at(mill, stand),
        "ptp",
        "no",
        "it is not",
    )
    layout = Layout("", 1, 1, (move,), (), 0, 0, 0.0, devices=("mill",))
    assert "\n  from door 900, vice 120.5\n" in text([layout], full=False)


def test_what_an_arm_has_is_said_with_its_move(tmp_path: Path) -> None:
    """A tool in use is no part that it carries."""
    tools, d = placed(tmp_path)
    assert tools is not None, [e.message for e in d.errors]
    kinds = tools.tools["gripper"], tools.parts["blank"]
    held = [Part(k.name, k, np.eye(4), "arm") for k in kinds]
    to = Pose(1.0, 0.0, 0.5, math.pi, 0.0, 0.0)
    assert carrying(MoveHome(), held) == " with blank, gripper in use"
    assert carrying(MoveJoint(to, tcp="gripper"), held[:1]) == ""
    on_it = Part("blank.2", kinds[1], np.eye(4), "arm", up=np.array([0.0, 0.0, 1.0]))
    assert carrying(MoveJoint(to, tcp="gripper"), [*held, on_it]) == " with blank and 1 on it"


def test_it_does_not_close_on_what_is_on_the_way() -> None:
    """One that may be empty lets nothing out; what comes meanwhile is for its jaws."""
    for may, said in (("", [True, True, False]), ("\nmay_be_empty = true", [False, True, False])):
        cell = cell_of(may)
        (held,) = shut(cell.robot("mill"), np.array([0.0, 0.06, 0.06]), np.array([0.0, 0.03, 0.03]))
        frame = matrix_of(Pose(0.0, 0.0, 0.075, math.pi, 0.0, 0.0))
        blank = Part("blank.1", cell.parts["blank"], frame, "arm")
        q = {}
        for x in (1.1, 1.003, 1.0):
            executor = RobotExecutor(cell.robot("arm"), cell.motion)
            executor.begin(MoveJoint(Pose(x, 0.0, 0.75, math.pi, 0.0, 0.0)), 0.0)
            executor.finish()
            q[x] = executor.q
        for (begun, now), is_said in zip(((1.1, 1.0), (1.0, 1.003), (1.0, 1.1)), said, strict=True):
            way = q[begun], q[now]
            found = closed_on(cell, held, cell.robot("arm"), way, ((blank,), ()))
            assert bool(found) is is_said, (may, begun, now)


def test_over_all_states_it_closes_on_a_part() -> None:
    found = closed(cell_of(), 0.0598)
    assert not found.fault and not found.doubt
    assert found.kinds == {"blank"} and found.part_events and not found.leans
    away = closed(cell_of(at="{ y = -0.9, z = 0.575 }"), 0.12, 0.0598)
    assert away.is_part and away.fault.startswith(
        "`mill/vice` closes on nothing: no part is at `inVice`; "
    )
    assert not closed(cell_of("\nmay_be_empty = true", "{ y = -0.9, z = 0.575 }"), 0.0598).fault
    nearly = closed(cell_of(at="{ x = 1.005, z = 0.675 }"), 0.0598)
    assert not nearly.fault and "as much as is permitted" in nearly.doubt


def test_a_part_leaves_the_cell_from_an_open_clamp_only() -> None:
    cell = cell_of()
    doing = Doing(Planner(cell), cell)
    home = doing.planner.home("mill")
    gone = ToolAction("eject", 1.0, Handling("removes", "blank", "inVice"))

    def after(*gaps: float, owner: str = "mill") -> Any:
        stand = home if owner == "mill" else None
        return doing.of(owner, (*map(grasp, gaps), gone), stand, doing.start, (home,))

    closed_on_it = after(0.0598)
    assert closed_on_it.is_part and closed_on_it.fault == (
        "`mill` removes `blank.1` out of `mill/vice`, which holds it: its gap is 59.8 mm, and it lets go at 120.0 mm"
    )
    opened = after(0.0598, 0.12)
    assert not opened.fault and not opened.doubt and not opened.after.parts.present
    other = after(owner="feeder")
    assert not other.fault and "whether `mill/vice` has let go then is not followed" in other.doubt
