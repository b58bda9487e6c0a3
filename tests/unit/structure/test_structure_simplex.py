"""Linear programs over the marking equation: against all minimal sub-invariants of small matrices, and limits."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from helpers.thorough import amount
from pn2code.structure.flows import Limits, Program, is_sub_invariant, semiflows
from pn2code.structure.simplex import MarkingProgram, TooMuchWorkError

Matrix = list[dict[int, int]]


def changes(r: random.Random, places: int, modes: int) -> Matrix:
    return [
        {k: n for k in range(modes) if (n := r.choice((0, 0, 0, 1, -1, 2, -1, -3)))}
        for _ in range(places)
    ]


def least_sums(rows: Matrix, initial: list[int]) -> list[Fraction | None]:
    """For each place the least initial sum, by its weight, of all sub-invariants of minimal support."""
    modes = sorted({k for row in rows for k in row})
    with_slack = [*rows, *({k: 1} for k in modes)]
    every = semiflows(with_slack, Limits(work=10_000_000))
    assert every.complete
    found: list[Fraction | None] = []
    for place in range(len(rows)):
        sums = [
            Fraction(sum(initial[p] * w for p, w in v.items() if p < len(rows)), v[place])
            for v in every.vectors
            if place in v
        ]
        found.append(min(sums, default=None))
    return found


@pytest.mark.parametrize("seed", range(amount(20, 60)))
def test_no_sub_invariant_bounds_a_place_better(seed: int) -> None:
    r = random.Random(seed)
    rows = changes(r, r.randint(2, 9), r.randint(1, 8))
    initial = [r.choice((0, 0, 1, 3)) for _ in rows]
    expected = least_sums(rows, initial)
    exact = MarkingProgram(rows, initial)
    in_floats = Program(rows, at_most=True)
    for place in r.sample(range(len(rows)), len(rows)):  # in any order
        for weights in (
            exact.most(place),
            in_floats.invariant(place, [float(n) for n in initial]),
        ):
            if expected[place] is None:
                assert weights is None
                continue
            assert weights is not None and is_sub_invariant(rows, weights)
            assert weights[place] > 0
            total = sum(initial[p] * w for p, w in weights.items())
            assert Fraction(total, weights[place]) == expected[place]


def test_among_equally_good_proofs_the_one_of_fewest_places() -> None:
    # a -> b -> c -> b, and x gives to b what nothing else says
    rows = [{0: -1}, {0: 1, 1: -1, 2: 1}, {1: 1, 2: -1}, {3: -1}]
    program = MarkingProgram(rows, [1, 0, 0, 0])
    assert program.most(1) == {0: 1, 1: 1, 2: 1}
    assert program.most(0) == {0: 1}
    assert program.most(3) == {3: 1}


def test_what_grows_without_limit_is_in_no_proof() -> None:
    # Mode 0 makes tokens on place 0 from nothing, mode 1 moves them to place 1; place 2 loses.
    rows = [{0: 1, 1: -1}, {1: 1}, {2: -1}]
    program = MarkingProgram(rows, [0, 0, 4])
    assert program.most(1) is None
    assert program.most(0) is None
    assert program.most(2) == {2: 1}


def test_weights_that_are_not_one() -> None:
    # Three tokens of place 0 become two of place 1.
    rows = [{0: -3}, {0: 2}]
    program = MarkingProgram(rows, [6, 0])
    assert program.most(1) == {0: 2, 1: 3}


def test_the_work_is_limited_and_can_go_on() -> None:
    ring = [{k: -1, (k - 1) % 30: 1} for k in range(30)]
    ring[0][30] = -1  # so that not all that is known of it is an invariant
    program = MarkingProgram(ring, [1] * 30)
    with pytest.raises(TooMuchWorkError):
        program.most(7, work=10)
    assert 10 < program.work < 200
    assert program.most(7) == dict.fromkeys(range(30), 1)
    again = MarkingProgram(ring, [1] * 30)
    again.most(7)
    assert again.work == program.work
