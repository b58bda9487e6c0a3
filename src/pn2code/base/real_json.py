"""Reals in JSON, which has no form for those that are not finite (docs/trace.md)."""

from __future__ import annotations

import math


def real_to_json(x: float) -> float | str:
    """The JSON form of a real: itself, or `"nan"`, `"inf"`, `"-inf"`."""
    if math.isnan(x):
        return "nan"
    if math.isinf(x):
        return "inf" if x > 0 else "-inf"
    return x
