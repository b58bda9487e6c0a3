"""Averages of several simulations and how far they can be trusted, with the numbers of CPN Tools' reports.

    found = Average.of([12.0, 14.5, 13.0])
    found.average, found.half_lengths[95]      # 13.17, 3.16: the mean lies in 10.01 .. 16.32 with 95 per cent

The observations have to be independent and of one distribution: one from each simulation. Half lengths are those of
Student's distribution, with the critical points that CPN Tools has: three digits; beyond 30 degrees of freedom those of
the next smaller number in its table, so that an interval is a little too wide rather than too narrow.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from pn2code.base.frozen import frozen
from pn2code.monitors.statistics import Number

LEVELS = (90, 95, 99)
"""Per cent."""
_POINTS = {
    90: (
        6.314, 2.92, 2.353, 2.132, 2.015, 1.943, 1.895, 1.86, 1.833, 1.812, 1.796, 1.782, 1.771, 1.761, 1.753,
        1.746, 1.74, 1.734, 1.729, 1.725, 1.721, 1.717, 1.714, 1.711, 1.708, 1.706, 1.703, 1.701, 1.699, 1.697,
        1.684, 1.676, 1.665, 1.66,
    ),
    95: (
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.16, 2.145, 2.131,
        2.12, 2.11, 2.101, 2.093, 2.086, 2.08, 2.074, 2.069, 2.064, 2.06, 2.056, 2.052, 2.048, 2.045, 2.042,
        2.021, 2.009, 1.992, 1.984,
    ),
    99: (
        63.657, 9.925, 5.841, 4.604, 4.032, 3.707, 3.499, 3.355, 3.25, 3.169, 3.106, 3.055, 3.012, 2.977, 2.947,
        2.921, 2.898, 2.878, 2.861, 2.845, 2.831, 2.819, 2.807, 2.797, 2.787, 2.779, 2.771, 2.763, 2.756, 2.75,
        2.704, 2.678, 2.643, 2.626,
    ),
}  # fmt: skip
_ROWS = (*range(1, 31), 40, 50, 75, 100)
"""The degrees of freedom of the table's points."""


def critical_point(level: int, freedom: int) -> float:
    """The point of Student's distribution with which an interval of so many per cent is made.

    Args:
        level: one of `LEVELS`.
        freedom: degrees of freedom, at least 1.
    """
    row = max(i for i, n in enumerate(_ROWS) if n <= freedom)
    return _POINTS[level][row]


def _root(x: Fraction) -> float:
    """The square root, also of what is too large or too small for a float."""
    if not x:
        return 0.0
    shift = (x.numerator.bit_length() - x.denominator.bit_length()) // 2
    return _number(Fraction(math.sqrt(x / Fraction(4) ** shift)) * Fraction(2) ** shift)


def _number(x: Fraction) -> float:
    """The nearest float; infinite beyond the largest."""
    try:
        return float(x)
    except OverflowError:
        return math.inf if x > 0 else -math.inf


@frozen
class Average:
    """What independent observations say.

    Args:
        count: how many they are.
        average, min, max: of them.
        half_lengths: per cent -> half the length of the confidence interval around the average; None for fewer than
            two observations, of which nothing can be said, and where one is no finite number.
        std: None where one is no finite number.
    """

    count: int
    average: float
    half_lengths: dict[int, float] | None
    std: float | None
    min: Number
    max: Number

    @staticmethod
    def of(observations: Sequence[Number]) -> Average:
        """Of observations. Computed exactly: they may be large beside their differences, such as moments."""
        n = len(observations)
        if any(isinstance(x, float) and not math.isfinite(x) for x in observations):
            return Average(
                n, sum(observations) / n, None, None, min(observations), max(observations)
            )
        own = [Fraction(x) for x in observations]
        mean = sum(own, Fraction()) / n
        variance = sum(((x - mean) ** 2 for x in own), Fraction()) / max(n - 1, 1)
        found = None
        if n > 1:
            root = _root(variance / n)
            found = {level: critical_point(level, n - 1) * root for level in LEVELS}
        return Average(
            n, _number(mean), found, _root(variance), min(observations), max(observations)
        )

    def row(self) -> dict[str, Number | None]:
        """For programs."""
        halves = {f"half_{level}": (self.half_lengths or {}).get(level) for level in LEVELS}
        return {"avg": self.average, **halves, "std": self.std, "min": self.min, "max": self.max}
