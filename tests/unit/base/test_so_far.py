"""What is said of a command whose time was up."""

from __future__ import annotations

from pn2code.base.so_far import SoFar


def test_what_was_done_and_what_was_not() -> None:
    so_far = SoFar()
    assert so_far.words() == ""
    so_far.stage("exploring a part of 60,000 states of the cell, breadth first ...")
    so_far.say("12,000 states")
    so_far.stage("sweeping moves ...")
    assert so_far.words().startswith("; it was broken off in: sweeping moves. Done before: exp")
    so_far.stage("sweeping pairs ...")
    so_far.say("sweeping pairs: 1,200 of 9,870, 310 a second, about 28 s left")
    assert so_far.words() == (
        "; it was broken off in: sweeping pairs (1,200 of 9,870 when it was said last). Done before: "
        "exploring a part of 60,000 states of the cell, breadth first; sweeping moves. "
        "Of all else nothing is known, and what was done answers nothing"
    )


def test_a_stage_whose_number_is_not_known() -> None:
    so_far = SoFar()
    so_far.stage("looking where arms can be ...")
    so_far.say("looking where arms can be: 4,200 situations, 900 a second")
    assert "(4,200 situations when it was said last)" in so_far.words()
