"""When what a script says or does is the same as what the net says or does."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pn2code.primitive_calls import Unknown
from pn2code.robot import commands


def is_same(a: object, b: object) -> bool:
    """Whether two values are equal, and of one type: 1 is not 1.0, and neither is true."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(is_same(a[k], b[k]) for k in a)
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return len(a) == len(b) and all(map(is_same, a, b))
    return type(a) is type(b) and a == b


def is_nothing(seconds: float, among: float) -> bool:
    """Whether what is left of a time is rounding alone."""
    return math.isclose(seconds, 0.0, abs_tol=1e-9 * max(1.0, among))


def listed(found: tuple[commands.Command | Unknown, ...]) -> str:
    """Commands, one after the other."""
    return ", ".join(map(str, found)) or "nothing"
