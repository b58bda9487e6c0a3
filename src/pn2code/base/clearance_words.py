"""A least clearance of `summary.json` in words: how much, when, and which two things were nearest then.

figure({"m": 0.0123, "t": 1.5, "between": ["arm/link_4", "post"]})       # "12.3 mm at 1.50 s, `arm/link_4` and `post`"
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def figure(entry: Mapping[str, Any], *, is_timed: bool = True) -> str:
    """`is_timed`: with when it was. Summaries of older versions do not say what was nearest."""
    when = f" at {entry['t']:.2f} s" if is_timed else ""
    two = entry.get("between")
    between = f", `{two[0]}` and `{two[1]}`" if two else ""
    return f"{entry['m'] * 1000:.1f} mm{when}{between}"
