"""The oracle for the riveting cell against the paper's Table 2, and against plain geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest

from helpers.rivet_rows import printed, rotation, rows, turned
from helpers.table_2 import FIRST, LAST, table_2


def test_table_2_comes_out_digit_for_digit() -> None:
    one, two = rows(5, FIRST, LAST)
    assert [
        f"{printed(a)} {printed(b)}".split() for a, b in zip(one, two, strict=True)
    ] == table_2()


def test_double_precision_would_not_give_table_2() -> None:
    assert printed((-5 * (1000 / 6),)) != "-833.3334"
    assert printed((-5 * float(np.float32(1000 / 6)),)) == "-833.3334"


def test_safe_return_differs_only_in_the_last_row() -> None:
    paper, safe = rows(5, FIRST, LAST)[0], rows(5, FIRST, LAST, safe_return=True)[0]
    assert paper[:-1] == safe[:-1]
    assert safe[-1][0] == pytest.approx(-1000.0, abs=1e-4)


@pytest.mark.parametrize("n", [0, 1, 500])
def test_number_of_rows(n: int) -> None:
    one, two = rows(n, FIRST, LAST)
    assert len(one) == len(two) == 1 + 2 * (n + 2) + (n + 1) + 1


@pytest.mark.parametrize(
    ("degrees", "expected"),
    [(-105, 75), (75, -105), (0, 180), (180, 0), (-180, 0), (90, -90), (179, -1), (-359, -179)],
)
def test_half_a_turn_stays_in_range(degrees: float, expected: float) -> None:
    assert turned(degrees) == expected


def world(first: tuple[float, ...], out: list[tuple[float, ...]]) -> list[np.ndarray]:
    """Where the TCP stands after each row."""
    pose = out[0]
    r, at = rotation(*pose[3:]), np.array(pose[:3])
    places = [at]
    for row in out[1:]:
        at = at + r @ np.array(row[:3])
        places.append(at)
    return places


def test_both_tools_meet_in_every_rivet_whatever_the_pose() -> None:
    first = (1000.5, -200.25, 800.0, 33.0, -20.0, 140.0)
    last = (1400.0, 100.0, 650.5, 33.0, -20.0, 140.0)
    n = 3
    one, two = (world(first, out) for out in rows(n, first, last, safe_return=True))
    for k in range(n + 2):
        rivet = np.array(first[:3]) + (np.array(last[:3]) - np.array(first[:3])) * k / (n + 1)
        assert one[1 + 3 * k] == pytest.approx(rivet, abs=1e-3)
        assert two[1 + 3 * k] == pytest.approx(rivet, abs=1e-3)
    assert one[-1] == pytest.approx(one[0], abs=1e-3)
    axis = rotation(*first[3:])[:, 2]
    assert math.isclose(float(axis @ (two[0] - one[0])), 200.0, abs_tol=1e-9)


def test_a_measured_offset_adds_one_row_and_moves_the_rivets() -> None:
    a, b = (5751.0, 5899.3, 2135.0, *FIRST[3:]), (6752.0, 5899.0, 2136.0, *LAST[3:])
    plain, out = rows(5, FIRST, LAST)[0], rows(5, FIRST, LAST, measured=(a, b))[0]
    assert len(out) == len(plain) + 1
    assert out[0] == plain[0]
    places = world(FIRST, out)
    assert places[2] == pytest.approx(a[:3], abs=1e-3)
    assert places[2 + 3 * 6] == pytest.approx(b[:3], abs=1e-3)
