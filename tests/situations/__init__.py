"""Situations into which supervisors are brought, and what they have to do there: `test_branches.py` runs all of them.

Each is a function with the decorator `situation`; it gets the `Lab` whose programs count which branches are taken.
"""

from __future__ import annotations

from collections.abc import Callable

from helpers.counted import Lab

Situation = Callable[[Lab], None]

SITUATIONS: dict[str, Situation] = {}
"""All of them, by module and name."""


def situation(function: Situation) -> Situation:
    """Decorator: one of them."""
    name = f"{function.__module__.rpartition('.')[2]}-{function.__name__}"
    assert name not in SITUATIONS
    SITUATIONS[name] = function
    return function
