"""Averages of simulations and their confidence intervals, beside those that the engine of CPN Tools has written.

The recorded answers are from two replication reports (7 and 35 simulations) of one net with random delays.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from pn2code.simulate.confidence import LEVELS, Average, critical_point

KEPT: list[dict[str, Any]] = json.loads(
    Path(__file__, "../../../golden/engine_replications.json").resolve().read_text()
)


@pytest.mark.parametrize("row", KEPT, ids=lambda row: f"{row['name']}-{len(row['observations'])}")
def test_as_in_the_reports_of_the_engine(row: dict[str, Any]) -> None:
    found = Average.of(row["observations"]).row()
    names = ("avg", "half_90", "half_95", "half_99", "std", "min", "max")
    said = dict(zip(names, row["said"], strict=True))
    assert found == pytest.approx(said, rel=1e-5, abs=1e-6)


def test_critical_points_of_the_engine() -> None:
    freedoms = (1, 2, 29, 30, 39, 40, 49, 50, 74, 75, 99, 100, 2000)
    assert [critical_point(95, n) for n in freedoms] == [
        12.706, 4.303, 2.045, 2.042, 2.042, 2.021, 2.021, 2.009, 2.009, 1.992, 1.992, 1.984, 1.984,
    ]  # fmt: skip
    assert [critical_point(level, 1) for level in LEVELS] == [6.314, 12.706, 63.657]


def test_one_observation_says_nothing_of_confidence() -> None:
    assert Average.of([3]).half_lengths is None
    assert Average.of([3]).row()["half_95"] is None
