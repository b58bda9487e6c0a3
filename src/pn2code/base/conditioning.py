"""Condition numbers of arms, as people read them."""

from __future__ import annotations

MOST_CONDITION = 1e6
"""A larger condition number is rounding: the arm is in a singularity."""


def condition_text(condition: float, digits: int = 0) -> str:
    """For people; of an arm in a singularity it has no meaning how large the number is."""
    if condition > MOST_CONDITION:
        return f"above {MOST_CONDITION:,.0f}"
    return f"{condition:.{digits}f}"
