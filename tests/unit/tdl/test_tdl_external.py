"""External axes in scripts: read, printed, and what they tell the arm."""

from __future__ import annotations

import math

import pytest

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.robot.commands import Along, MoveAxes, MoveExternal, MoveJoint, MoveLinear
from pn2code.tdl import pretty
from pn2code.tdl.check import check
from pn2code.tdl.parse import parse
from pn2code.tdl.requests import Fault
from unit.tdl.test_tdl_moves import HALF, P, program, told

RAIL = Along("rail", 1.2, is_track=True)
PLATE = Along("plate", math.radians(-30.0), is_track=False)
BOTH = "$track rail = 1200 mm, $turntable plate = -30 deg"


@pytest.mark.parametrize(
    ("move", "command"),
    [
        (f"move $external with {BOTH}", MoveExternal((RAIL, PLATE))),
        (
            "move $external with $track rail = p.x + 1100 mm at 30 % acceleration e",
            MoveExternal((RAIL,), 0.3, 0.5),
        ),
        (
            f"move $linear p in bench with {BOTH} at 50 mm/s",
            MoveLinear(P, "bench", 0.05, along=(RAIL, PLATE)),
        ),
        ("move $linear p in bench with $tool grip", MoveLinear(P, "bench", tcp="grip")),
        (
            "move $joint p with $tool grip, $track rail = 1200 mm",
            MoveJoint(P, along=(RAIL,), tcp="grip"),
        ),
        (
            "move $joint p with $track rail = 1200 mm at 40 %",
            MoveJoint(P, 0.4, along=(RAIL,)),
        ),
        (
            "move $joint axes(0 deg, 0 deg, 0 deg, 0 deg, 0 deg, 0 deg) with $track rail = 1200 mm",
            MoveAxes((0.0,) * 6, along=(RAIL,)),
        ),
    ],
)
def test_what_the_arm_is_told(move: str, command: object) -> None:
    assert told(move) == command
    assert move in pretty.program(program(move))


@pytest.mark.parametrize(
    ("move", "message"),
    [
        ("move $joint with $track rail = 1 mm", "says nowhere to go"),
        ("move $joint home with $tool grip", "only a move to a pose has a tool frame"),
        ("move $joint p with $tool grip, $tool grap", "a move has one tool frame"),
        ("move $joint home with $arm angle = 5 deg", "only a move to a pose has an arm angle"),
        ("move $joint p with $arm angle = 5 deg, $arm angle = 6 deg", "a move has one arm angle"),
        ("move $joint p with $track rail", "`$track rail` says nowhere to go"),
        ("move $external p with $track rail = 1 mm", "the arm stands still"),
        ("move $external with $lift rail = 1 mm", "no external axis of the kind `$lift`"),
        ("move $external with $track rail = 1 deg", "the position of track `rail`"),
        ("move $external with $turntable plate = 1 mm", "the position of turntable `plate`"),
        (
            "move $external with $track rail = 1 mm, $track rail = 2 mm",
            "`rail` is told twice where to go",
        ),
        ("move $joint home with $track rail = 1 mm", "on the way home external axes stand still"),
    ],
)
def test_moves_that_are_none(move: str, message: str) -> None:
    text = f"program t\nvar p : pose := {HALF}\nbegin\n  {move}\n  stop p\nend program\n"
    d = Diagnostics()
    found = parse(SourceText(text, Origin("t.tdl", 1, 1)), d)
    if found is not None and not d.errors:
        check(found, d, ())
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]


def test_a_position_that_is_no_number_stops_the_script() -> None:
    assert isinstance(told("move $external with $track rail = p.x / (e - e)"), Fault)
