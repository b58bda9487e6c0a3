"""An edited script that does what its page does agrees, but it is said that it is not the generated one."""

from __future__ import annotations

from dataclasses import replace

from pn2code.cli.conform import _robot
from pn2code.conform.script_state import RobotReport

EQUAL = RobotReport("robot1", 5, 4, 2, 2, 3, complete=True)


def test_an_edited_script_that_agrees_is_named() -> None:
    plain, edited = _robot(EQUAL, is_edited=False), _robot(EQUAL, is_edited=True)
    assert edited[:-1] == plain and "agrees" in plain[0]
    assert "not the one that is generated" in edited[-1]


def test_transitions_of_which_nothing_was_compared_are_named() -> None:
    idle = replace(EQUAL, idle=("Cell.Robot1.Press",))
    assert _robot(idle, is_edited=False)[1:] == [
        "              in none of them occur `Cell.Robot1.Press`"
    ]
    many = replace(EQUAL, idle=tuple(f"T{i}" for i in range(11)))
    (line,) = _robot(many, is_edited=False)[1:]
    assert line.endswith("`T6`, `T7` and 3 more")
