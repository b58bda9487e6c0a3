"""Proofs from the state equation, checked in integers.

A linear program is solved in floating point, and nothing that it says is believed: its dual solution is rounded to
integers, and these must prove the claim by themselves. If it cannot be rounded, the equations that it satisfies nearly
are solved exactly.

    with a weight w of the places that no transition can lower (w * effect >= 0 for each), w * m >= w * m0 always:
    is_refuted    rows a * m <= b, added with factors f >= 0, say f * a * m <= f * b; if w <= f * a everywhere and
                  w * m0 > f * b, then no reachable marking satisfies them all, since tokens are never negative
    bound         with y >= c everywhere and y * effect <= 0 for each transition, c * m <= y * m <= y * m0
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import lcm

from pn2code.contest.conditions import AtMost

_SCALES = (1, 2, 3, 4, 5, 6, 8, 10, 12, 24, 60, 120, 360, 840, 2520, 27720, 720720)
_NEAR = 1e-4
_LARGEST_DENOMINATOR = 10_000
_LARGEST_COMMON = 10**15
_MOST_UNKNOWNS = 300
_MOST_EQUATIONS = 1500

Effects = Sequence[Mapping[int, int]]
"""By transition: how much it changes each place."""


def is_refuted(
    rows: Sequence[AtMost],
    factors: Sequence[int],
    weight: Mapping[int, int],
    initial: Sequence[int],
    effects: Effects,
) -> bool:
    """Whether factors of the rows and a weight of the places prove that no reachable marking satisfies all rows."""
    if any(f < 0 for f in factors):
        return False
    added: dict[int, int] = {}
    limit = 0
    for row, f in zip(rows, factors, strict=True):
        limit += f * row.limit
        for p, n in row.factors if f else ():
            added[p] = added.get(p, 0) + f * n
    if any(weight.get(p, 0) > added.get(p, 0) for p in weight.keys() | added.keys()):
        return False
    if sum(w * initial[p] for p, w in weight.items()) <= limit:
        return False
    return all(sum(weight.get(p, 0) * n for p, n in effect.items()) >= 0 for effect in effects)


def bound(
    factors: Mapping[int, int],
    weight: Mapping[int, int],
    scale: int,
    initial: Sequence[int],
    effects: Effects,
) -> int | None:
    """An upper bound of a sum that the weight divided by the scale proves; None: it proves nothing."""
    keys = factors.keys() | weight.keys()
    if any(weight.get(p, 0) < max(0, scale * factors.get(p, 0)) for p in keys):
        return None
    if any(sum(weight.get(p, 0) * n for p, n in effect.items()) > 0 for effect in effects):
        return None
    return sum(w * initial[p] for p, w in weight.items()) // scale


def integers(values: Sequence[float]) -> Iterator[tuple[list[int], int]]:
    """Integers that are nearly a multiple of the values, with the multiple; small multiples first."""
    smallest = min((abs(v) for v in values if abs(v) > 1e-7), default=1.0)
    for unit in (1.0, smallest):
        for scale in _SCALES:
            scaled = [v * scale / unit for v in values]
            found = [round(v) for v in scaled]
            if all(abs(v - n) < _NEAR for v, n in zip(scaled, found, strict=True)):
                if unit == 1.0:
                    yield found, scale
                else:
                    yield found, 0
                break
    fractions = [Fraction(v).limit_denominator(_LARGEST_DENOMINATOR) for v in values]
    common = 1
    for f in fractions:
        common = lcm(common, f.denominator)
        if common > _LARGEST_COMMON:
            return
    yield [int(f * common) for f in fractions], common


def solution(
    equations: Sequence[tuple[Mapping[int, int], int]], near: Mapping[int, float]
) -> dict[int, Fraction] | None:
    """The exact solution of linear equations that is near to one in floating point.

    Args:
        equations: factors of the unknowns, and what their sum is.
        near: the unknowns, nearly; where the equations leave a choice, it is made by them.

    Returns:
        None: there are too many of them, or no solution.
    """
    from flint import fmpq, fmpq_mat

    columns = {v: i for i, v in enumerate(near)}
    wanted = {(tuple(sorted(f.items())), r) for f, r in equations if f or r}
    if len(columns) > _MOST_UNKNOWNS or len(wanted) > _MOST_EQUATIONS or not wanted:
        return None
    matrix = fmpq_mat(len(wanted), len(columns) + 1)
    for i, (factors, right) in enumerate(sorted(wanted)):
        for v, n in factors:
            matrix[i, columns[v]] = n
        matrix[i, len(columns)] = right
    reduced, rank = matrix.rref()
    found = {v: Fraction(x).limit_denominator(_LARGEST_DENOMINATOR) for v, x in near.items()}
    names = list(near)
    for i in range(rank):
        row = {j: reduced[i, j] for j in range(len(columns) + 1) if reduced[i, j] != 0}
        pivot = min(row)
        if pivot == len(columns):
            return None
        value = fmpq(row.get(len(columns), 0))
        for j, entry in row.items():
            if pivot < j < len(columns):
                f = found[names[j]]
                value -= entry * fmpq(f.numerator, f.denominator)
        found[names[pivot]] = Fraction(int(value.p), int(value.q))
    return found


def whole(values: Mapping[int, Fraction]) -> tuple[dict[int, int], int]:
    """The values as integers, with the multiple that they are."""
    scale = lcm(1, *(f.denominator for f in values.values()))
    return {v: int(f * scale) for v, f in values.items()}, scale
