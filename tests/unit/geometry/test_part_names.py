"""Parts are told by the names that runs give them."""

from __future__ import annotations

import math

import pytest

from pn2code.geometry.apart import Apart
from pn2code.geometry.part_names import as_in_runs, as_seen, held, on_plate, standing
from pn2code.robot.backend import Clearance


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        (f"arm/{held('blank.1', 'arm')}", "arm/blank.1"),
        (on_plate("blank.12", "left/plate"), "blank.12"),
        (standing("blank.2"), "blank.2"),
        ("arm/link_1", "arm/link_1"),
        ("table.standing", "table.standing"),
        ("camera.on_table", "camera.on_table"),
    ],
)
def test_names_are_those_of_runs(name: str, shown: str) -> None:
    assert as_in_runs(name) == shown


def test_what_is_reported_has_them() -> None:
    nothing = (0.0, 0.0, 0.0)
    names = f"arm/{held('blank.1', 'arm')}", standing("blank.2")
    gap = Clearance("robots", "arm", *names, 0.0, None, nothing, nothing)
    found = as_seen(Apart("open", 0.0, math.inf, gap, why=f"`{gap.a}` and `{gap.b}` come within"))
    assert found.where is not None
    assert (found.where.a, found.where.b) == ("arm/blank.1", "blank.2")
    assert found.why == "`arm/blank.1` and `blank.2` come within"
