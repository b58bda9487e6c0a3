"""A name that nothing else has: `unused_name("Zone", taken, "{} {}")` is Zone, Zone 2, Zone 3, ..."""

from __future__ import annotations

from collections.abc import Container
from itertools import count


def unused_name(name: str, taken: Container[str], form: str = "{}{}") -> str:
    """The name, or with the first number (from 2) that makes it another one than those that are taken."""
    if name not in taken:
        return name
    numbered = (form.format(name, n) for n in count(2))
    return next(x for x in numbered if x not in taken)
