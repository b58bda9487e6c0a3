"""Statistical variables, with the formulas of CPN Tools' simulation reports.

    s = Untimed()
    for x in (0, 1, 1, 2): s.update(x)
    s.values()["avg"]                # 1.0

A timed variable weights each value with the model time for which it held, up to now:

    clock = [0]
    s = Timed(lambda: clock[0])
    s.update(2); clock[0] = 3; s.update(0); clock[0] = 4
    s.values()["avg"]                # (3 * 2 + 1 * 0) / 4 = 1.5

Without any value everything is 0. Integers stay integers (CPN Tools sums them as `IntInf.int`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

Number = int | float


class _Collected:
    """What both kinds keep of the values so far."""

    def __init__(self, zero: Number) -> None:
        self.zero = zero
        self.clear()

    def clear(self) -> None:
        """Forgets all values."""
        self.count = 0
        self._min = self._max = self._first = self._last = self.zero
        self._sum = self._squares = self.zero

    def _keep(self, x: Number) -> None:
        if self.count == 0:
            self._min = self._max = self._first = x
        self._min = min(self._min, x)
        self._max = max(self._max, x)
        self._last = x
        self.count += 1


class Untimed(_Collected):
    """Every value counts the same.

    Args:
        zero: 0, or 0.0 for a collector of reals: what is reported before the first value.
    """

    def __init__(self, zero: Number = 0) -> None:
        super().__init__(zero)

    def update(self, x: Number) -> None:
        """A further value."""
        self._keep(x)
        self._sum += x
        self._squares += x * x

    def values(self) -> dict[str, Number]:
        """All statistics by name."""
        n = self.count
        total, squares = float(self._sum), float(self._squares)
        average = total / n if n else 0.0
        deviations = max(squares - total * total / n, 0.0) if n else 0.0
        variance = deviations / (n - 1) if n > 1 else 0.0
        return {
            "count": n,
            "sum": self._sum,
            "avg": average,
            "min": self._min,
            "max": self._max,
            "first": self._first,
            "last": self._last,
            "ss": self._squares,
            "ssd": deviations,
            "variance": variance,
            "std": math.sqrt(variance),
        }


class Timed(_Collected):
    """Each value counts for as long as it held.

    Args:
        now: gives the model time.
        zero: 0, or 0.0 for a collector of reals.
    """

    def __init__(self, now: Callable[[], Number], zero: Number = 0) -> None:
        super().__init__(zero)
        self.now = now
        self._start: Number = 0
        self._updated: Number = 0

    def update(self, x: Number) -> None:
        """A further value, from now on."""
        now = self.now()
        if self.count == 0:
            self._start = now
        else:
            self._sum, self._squares = self._totals(now)
        self._keep(x)
        self._updated = now

    def _totals(self, now: Number) -> tuple[Number, Number]:
        """Sum and sum of squares up to now."""
        lasted = now - self._updated
        return self._sum + lasted * self._last, self._squares + lasted * self._last * self._last

    def values(self) -> dict[str, Number]:
        """All statistics by name, up to now."""
        now = self.now()
        start = self._start if self.count else now
        interval = now - start
        total, squares = self._totals(now) if self.count else (self.zero, self.zero)
        average = float(total) / float(interval) if interval > 0 else 0.0
        deviations = max(float(squares) - float(interval) * average * average, 0.0)
        variance = 0.0 if interval == 1 else deviations / (float(interval) - 1.0) + 0.0
        return {
            "count": self.count,
            "sum": total,
            "avg": average,
            "min": self._min,
            "max": self._max,
            "first": self._first,
            "last": self._last,
            "ss": squares,
            "ssd": deviations,
            "variance": variance,
            # An interval below 1 gives a negative variance in CPN Tools, and no deviation.
            "std": math.sqrt(variance) if variance >= 0 else math.nan,
            "starttime": start,
            "lasttime": self._updated if self.count else now,
            "interval": interval,
        }


Statistics = Untimed | Timed


def restored(found: Mapping[str, Number | str], now: Number | None) -> Statistics:
    """What another program has collected.

    Args:
        found: `count`, `min`, `max`, `first`, `last`, `sum`, `ss` up to the last value, `start`, `updated`; reals that
            are not finite are texts.
        now: the model time, for timed statistics; None: untimed.
    """
    zero = 0.0 if isinstance(found["min"], float) else 0
    s: Statistics = Untimed(zero) if now is None else Timed(lambda: now, zero)
    numbers = {name: float(x) if isinstance(x, str) else x for name, x in found.items()}
    s.count = int(numbers["count"])
    s._min, s._max = numbers["min"], numbers["max"]
    s._first, s._last = numbers["first"], numbers["last"]
    s._sum, s._squares = numbers["sum"], numbers["ss"]
    if isinstance(s, Timed):
        s._start, s._updated = numbers["start"], numbers["updated"]
    return s
