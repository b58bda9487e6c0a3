"""How long the rest of a run takes, from what its tests were expected to take and what they do take."""

from __future__ import annotations

from collections.abc import Mapping

_PRIOR_S = 10.0
"""So long the expectations count for more than the pace of this run."""


class Estimate:
    """A run under way.

    Args:
        expected: seconds of each test, what it shares with others included.
        cores: how many tests run at a time.
    """

    def __init__(self, expected: Mapping[str, float], cores: int) -> None:
        self._expected = dict(expected)
        self._cores = cores
        self._total = self._rest = sum(expected.values())
        self._all = len(expected)

    def done(self, test: str) -> None:
        """A test has ended."""
        self._rest -= self._expected.pop(test, 0.0)

    @property
    def tests(self) -> int:
        """How many tests have ended."""
        return self._all - len(self._expected)

    def share(self) -> float:
        """The part of the work that is done, from 0 to 1."""
        return 1.0 - self._rest / self._total if self._expected and self._total else 1.0

    def left(self, elapsed: float) -> float:
        """Seconds until the end, after so many seconds."""
        rest = self._rest / self._cores
        done = self._total / self._cores - rest
        return rest * (elapsed + _PRIOR_S) / (done + _PRIOR_S)

    def line(self, elapsed: float) -> str:
        """For people."""
        left = self.left(elapsed)
        return (
            f"{self.share():4.0%}  {self.tests:,} of {self._all:,} tests, "
            f"{clock(elapsed)} gone, about {clock(left)} left"
        )


def clock(seconds: float) -> str:
    """`3:07`."""
    whole = round(seconds)
    return f"{whole // 60}:{whole % 60:02}"
