"""What is outside of a limit does not look like the limit."""

from __future__ import annotations

import math

import numpy as np

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.digits import told_apart
from pn2code.robot.model import MODELS, find_arm


def test_as_many_digits_as_it_takes() -> None:
    assert told_apart(3.04, 1.0) == ("3.0", "1.0")
    assert told_apart(1.02, 1.0) == ("1.02", "1.00")
    assert told_apart(-120.004, -120.0, 120.0, digits=2) == ("-120.004", "-120.000", "120.000")
    assert told_apart(1.0, 1.0) == ("1.0", "1.0")


def test_an_axis_just_outside_its_limits() -> None:
    arm = find_arm("iiwa14_r820", MODELS, Origin("cell.toml"), Diagnostics())
    assert arm is not None
    for degrees, says in (
        (-120.001, "-120.001 deg, outside -120.000 .. 120.000"),
        (121.0, "121.00 deg, outside -120.00 .. 120.00"),
    ):
        q = np.radians([0.0, 0.0, 0.0, degrees, 0.0, 0.0, 0.0])
        assert arm.outside(3, q) == says
    assert math.isclose(arm.upper[3], math.radians(120.0))
