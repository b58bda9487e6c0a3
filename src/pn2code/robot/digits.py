"""Numbers for messages about limits, with as many digits as tell a value from the limits that it is outside of.

told_apart(1.0, 1.0)            # ("1.0", "1.0"): they are equal
told_apart(1.02, 1.0)           # ("1.02", "1.00")
told_apart(3.04, 1.0)           # ("3.0", "1.0")
"""

from __future__ import annotations

_MOST = 9


def told_apart(value: float, *limits: float, digits: int = 1) -> tuple[str, ...]:
    """The value and the limits as text, with at least so many digits behind the point, and with at most nine."""
    shown: tuple[str, ...] = ()
    for n in range(digits, _MOST + 1):
        shown = tuple(f"{v:.{n}f}" for v in (value, *limits))
        if shown[0] not in shown[1:]:
            return shown
    return tuple(f"{v:.{digits}f}" for v in (value, *limits))
