"""Names of files for the runs of properties: each has one of its own, whatever the properties are called.

run_names(["no part is lost", "no part-is lost"])
# {"no part is lost": "no-part-is-lost", "no part-is lost": "no-part-is-lost-2"}
"""

from __future__ import annotations

import re
from collections.abc import Iterable

_LONGEST = 60
_OTHERS = re.compile(r"controller-|closed-net\.|(dead|error)-\d|geometry|unbounded$", re.IGNORECASE)
"""How those of other runs of `verify` and `check` begin, after the name of the net."""


def run_names(names: Iterable[str]) -> dict[str, str]:
    """By the name of a property what stands for it in the name of its run's file."""
    used: set[str] = set()
    found: dict[str, str] = {}
    for name in names:
        slug = re.sub(r"[^A-Za-z0-9_.]+", "-", name).strip("-.")[:_LONGEST] or "property"
        if _OTHERS.match(slug):
            slug = f"property-{slug}"
        while slug.lower() in used:
            slug += "-2"
        used.add(slug.lower())
        found[name] = slug
    return found
