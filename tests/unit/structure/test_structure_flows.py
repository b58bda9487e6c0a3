"""Invariants of matrices: against enumeration of all supports, known nets, large matrices, limits."""

from __future__ import annotations

import itertools
import random
from math import gcd

import flint
import pytest

from helpers.thorough import amount
from pn2code.base.how_far import listening
from pn2code.structure.flows import (
    Limits,
    Program,
    basis,
    is_invariant,
    is_sub_invariant,
    outside_span,
    semiflows,
    transposed,
)

Matrix = list[dict[int, int]]


def matrix(r: random.Random, rows: int, columns: int) -> Matrix:
    return [
        {c: n for c in range(columns) if (n := r.choice((0, 0, 0, 1, -1, 2, -1)))}
        for _ in range(rows)
    ]


def kernel(rows: Matrix, support: tuple[int, ...], columns: int) -> list[list[int]]:
    dense = [[rows[i].get(c, 0) for i in support] for c in range(columns)]
    found, dimension = flint.fmpz_mat(dense).nullspace()
    return [[int(found[r, k]) for r in range(len(support))] for k in range(dimension)]


def by_enumeration(rows: Matrix, columns: int) -> set[tuple[tuple[int, int], ...]]:
    """Of every support: the invariant, if there is one up to a factor and it is positive throughout."""
    found = set()
    for size in range(1, len(rows) + 1):
        for support in itertools.combinations(range(len(rows)), size):
            vectors = kernel(rows, support, columns)
            if len(vectors) == 1 and all(vectors[0]):
                (v,) = vectors
                sign = 1 if v[0] > 0 else -1
                if all(n * sign > 0 for n in v):
                    divisor = gcd(*v) * sign
                    entries = zip(support, v, strict=True)
                    found.add(tuple((i, n // divisor) for i, n in entries))
    return found


@pytest.mark.parametrize("seed", range(amount(15, 40)))
def test_minimal_invariants_are_those_found_by_enumeration(seed: int) -> None:
    r = random.Random(seed)
    rows, columns = matrix(r, r.randint(1, 7), 3), 3
    found = semiflows(rows)
    assert found.complete
    assert {tuple(sorted(v.items())) for v in found.vectors} == by_enumeration(rows, columns)


@pytest.mark.parametrize("seed", range(amount(10, 25)))
def test_a_basis_spans_all_integer_invariants(seed: int) -> None:
    """Some small integer vectors that are invariants are integer combinations of the basis."""
    r = random.Random(seed)
    rows = matrix(r, 5, 3)
    found = basis(rows)
    assert found is not None
    assert all(is_invariant(rows, v) for v in found)
    assert len(found) == len(kernel(rows, tuple(range(5)), 3))
    assert len(outside_span(found, [])) == len(found)
    if not found:
        return
    dense = flint.fmpz_mat([[v.get(i, 0) for i in range(5)] for v in found])
    minors = flint.fmpz_mat(dense).snf()
    # The lattice is saturated: all invariant factors are 1.
    assert all(abs(int(minors[k, k])) == 1 for k in range(len(found)))


def test_a_basis_is_of_integer_combinations() -> None:
    # 2a = b + c, b = c mod 2: the rational kernel of one equation 2x + 3y + 5z = 0
    rows = [{0: 2}, {0: 3}, {0: 5}]
    found = basis(rows)
    assert found is not None
    square = [[v.get(i, 0) for i in range(3)] for v in found]
    minors = [
        square[0][a] * square[1][b] - square[0][b] * square[1][a]
        for a, b in ((0, 1), (0, 2), (1, 2))
    ]
    assert gcd(*minors) == 1


def test_places_without_effect_are_invariants() -> None:
    assert semiflows([{}, {0: 1}]).vectors == ({0: 1},)
    assert basis([{}, {0: 1}]) == ({0: 1},)
    assert semiflows([]).vectors == ()
    assert basis([]) == ()


def test_common_factors_are_divided_out() -> None:
    assert semiflows([{0: -6}, {0: 4}]).vectors == ({0: 2, 1: 3},)


def philosophers(n: int) -> Matrix:
    """Think, has left, has right, eats, fork; either fork first."""
    rows: Matrix = [{} for _ in range(5 * n)]
    columns = itertools.count()

    def step(take: list[int], put: list[int]) -> None:
        c = next(columns)
        for p in take:
            rows[p][c] = rows[p].get(c, 0) - 1
        for p in put:
            rows[p][c] = rows[p].get(c, 0) + 1

    for i in range(n):
        j = (i + 1) % n
        think, left, right, eat, fork, other = i, n + i, 2 * n + i, 3 * n + i, 4 * n + i, 4 * n + j
        step([think, fork], [left])
        step([think, other], [right])
        step([left, other], [eat])
        step([right, fork], [eat])
        step([eat], [think, fork, other])
    return rows


def test_large_philosophers() -> None:
    rows = philosophers(60)
    assert len(semiflows(rows).vectors) == 120
    assert len(basis(rows) or ()) == 120
    cycles = semiflows(transposed(rows, 300))
    assert cycles.complete
    assert {len(v) for v in cycles.vectors} == {3}
    assert len(cycles.vectors) == 120


def test_where_there_are_too_many_every_row_is_covered_all_the_same() -> None:
    # k stages of two parallel places each: 2^k minimal invariants
    k = 14
    rows: Matrix = [{} for _ in range(2 * k)]
    for stage in range(k):
        for p in (2 * stage, 2 * stage + 1):
            rows[p] = {stage: -1, (stage + 1) % k: 1}
    found = semiflows(rows, Limits(rows=100))
    assert not found.complete
    assert {i for v in found.vectors for i in v} == set(range(2 * k))
    assert all(is_invariant(rows, v) and min(v.values()) > 0 for v in found.vectors)
    assert len(semiflows(rows[:16], Limits(rows=4000)).vectors) == 0  # cut open: nothing is left


def test_a_cover_of_a_matrix_with_columns_below_zero() -> None:
    """As resets have them: no invariant covers such a row."""
    rows = matrix(random.Random(3), 12, 8)
    rows += [{0: 1, -7: 1}, {0: -1}, {0: 1}]
    found = semiflows(rows, Limits(rows=1, work=10)).vectors
    assert not any(12 in v for v in found)
    assert any({13, 14} <= v.keys() for v in found)


def test_sub_invariants_by_linear_programs() -> None:
    # t0 moves a to b, t1 loses from b, t2 makes c from nothing
    rows = [{0: -1}, {0: 1, 1: -1}, {2: 1}]
    program = Program(rows, at_most=True)
    assert program.support() == {0, 1}
    found = program.invariant(1, [3.0, 1.0, 0.0])
    assert found == {0: 1, 1: 1}
    assert is_sub_invariant(rows, found)
    assert program.invariant(2) is None
    assert not is_sub_invariant(rows, {2: 1})
    assert not is_sub_invariant(rows, {0: -1})


def test_a_long_solution_is_told_before_it_begins() -> None:
    """The library lets no other thread run, so nobody could say meanwhile that it goes on."""
    said: list[str] = []
    with listening(said.append):
        basis([{i: -1, (i + 1) % 40: 1} for i in range(40)])
        assert said == []
        found = basis([{i: -1, (i + 1) % 500: 1} for i in range(500)])
    assert said == ["solving for all invariants at once: 500 by 500 ..."]
    assert found == (dict.fromkeys(range(500), 1),)
