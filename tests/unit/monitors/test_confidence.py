"""Averages of simulations and their confidence intervals, beside those that the engine of CPN Tools has written.

The recorded answers are from two replication reports (7 and 35 simulations) of one net with random delays.
"""

from __future__ import annotations

import json
import math
import statistics
from fractions import Fraction
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


@pytest.mark.parametrize(
    "observations",
    [
        [1e9 + 0.1, 1e9 + 0.2, 1e9 + 0.3],
        [123456789012, 123456789013, 123456789015],
        [2**70, 2**70 + 4],
        [0.1, 0.1, 0.1],
        [1e200, 2e200],
        [1e-200, 3e-200],
        [-7, 0, 7.5],
    ],
    ids=str,
)
def test_large_observations_that_differ_a_little_are_not_the_same(
    observations: list[float],
) -> None:
    found = Average.of(observations)
    std = statistics.stdev(map(Fraction, observations))
    assert found.average == pytest.approx(float(statistics.mean(observations)), rel=1e-12)
    assert found.std == pytest.approx(float(std), rel=1e-9, abs=0.0)
    assert found.half_lengths is not None
    half = critical_point(95, len(observations) - 1) * float(std) / math.sqrt(len(observations))
    assert found.half_lengths[95] == pytest.approx(half, rel=1e-9, abs=0.0)


def test_of_what_is_no_number_or_beyond_all_nothing_is_said() -> None:
    found = Average.of([math.inf, 1.0])
    assert (found.std, found.half_lengths, found.average) == (None, None, math.inf)
    assert Average.of([math.nan, 1.0]).row()["half_95"] is None
    assert Average.of([10**400, 10**400]).average == math.inf
    assert Average.of([10**400, 10**400]).std == 0.0
