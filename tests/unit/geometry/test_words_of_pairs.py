"""What is said of two that do not surely keep apart: what moves is under way, what rests stands."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from pn2code.geometry.answers import Layout, Nearest, Pair
from pn2code.geometry.apart import Apart
from pn2code.geometry.met_pairs import certain, touch_in_words
from pn2code.geometry.report import text
from pn2code.geometry.runs import Run
from pn2code.robot.backend import Clearance


@pytest.mark.parametrize(
    ("transitions", "robots", "steps", "says"),
    [
        (("A", "B"), ("r", "s"), 2, "`A` and `B` may be under way at once"),
        (("A", ""), ("r", "s"), 1, "`A` may be under way while s stands there"),
        (("", "B"), ("r", "s"), 1, "`B` may be under way while r stands there"),
        (("A", ""), ("r", ""), 1, "`A` may be under way while a part stands there"),
        (("", ""), ("r", "s"), 0, "r at rest and s at rest may stand there at once"),
        (("", ""), ("r", ""), 0, "r at rest and a part may stand there at once"),
    ],
)
def test_what_rests_is_not_under_way(
    transitions: tuple[str, str], robots: tuple[str, str], steps: int, says: str
) -> None:
    run = Run(steps, steps, transitions, Path("x.trace.jsonl"))
    pair = Pair(robots, transitions, ("", ""), "no", "they overlap", run=run)
    said = text([Layout("", 3, 3, (), (pair,), 1, 1, 0.0)], full=True)
    assert f"NO: {says}\n" in said
    assert ("it is so at the start: x.trace.jsonl" in said) == (not steps)
    assert ("a run of" in said) == bool(steps)


@pytest.mark.parametrize(("devices", "who"), [((), "two arms"), (("mill",), "two arms or devices")])
def test_what_devices_move_is_no_arm(devices: tuple[str, ...], who: str) -> None:
    layout = Layout("", 3, 3, (), (), 1, 1, 0.0, nearest=Nearest(None, 0.046), devices=devices)
    said = text([layout], full=True)
    assert f" yes  no {who} collide, nor " in said and f"{who} keep at least 46 mm apart" in said
    assert ("\nrobot or device  transition" in said) == bool(devices)
    assert layout.row()["pairs_says"] in said and layout.row()["devices"] == list(devices)


@pytest.mark.parametrize(
    ("least", "known", "says"),
    [
        (-0.0213, -0.0213, ", and nowhere on the way by more than 21.3 mm"),
        (-math.inf, None, "; how deep on the rest of the way is not known"),
    ],
)
def test_an_overlap_that_may_be_deeper_elsewhere(
    least: float, known: float | None, says: str
) -> None:
    """Near a singularity nothing may be known of pieces of a line that are still to be looked at."""
    gap = Clearance("scene", "r", "r/link_5", "post", -0.02, None, (1.7, -0.5, 1.1))
    found = Apart("touch", least, -0.02, gap)
    assert certain(found) == known
    where = "`r/link_5` and `post` overlap by 20.0 mm at (1700, -500, 1100) mm"
    assert touch_in_words(found) == where + says


def test_an_overlap_on_the_way_to_a_contact() -> None:
    """It may be a millimetre deeper there, where that is permitted."""
    gap = Clearance("scene", "r", "r/tool_tip", "box.1", -0.0005, 0.0, is_early=True)
    said = touch_in_words(Apart("touch", -0.0005, -0.0005, gap))
    assert "mm, further from where the move leads than `contact_way` of the part, and" in said
    assert said.endswith("and nowhere on the way by more than 1.5 mm")
