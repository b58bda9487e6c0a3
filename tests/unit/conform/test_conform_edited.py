"""An edited script that does what its page does agrees, but it is said that it is not the generated one."""

from __future__ import annotations

from pn2code.cli.conform import _robot
from pn2code.conform.robot import RobotReport

EQUAL = RobotReport("robot1", 5, 4, 2, 2, 3, complete=True)


def test_an_edited_script_that_agrees_is_named() -> None:
    plain, edited = _robot(EQUAL, is_edited=False), _robot(EQUAL, is_edited=True)
    assert edited[:-1] == plain and "agrees" in plain[0]
    assert "not the one that is generated" in edited[-1]
