"""What a swarm of searches has seen, in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def seen(swarm: Mapping[str, Any]) -> str:
    """How many searches, how many markings, and how many there may be, without a full stop."""
    counted, searches = swarm["counted"], swarm["searches"]
    done = (
        f"{counted:,} of {searches:,} searches" if counted < searches else f"{searches:,} searches"
    )
    if searches == 1:
        done = "1 search"
    about = "" if swarm["markings_are_exact"] else "about "
    text = f"{done} looked at {about}{swarm['markings']:,} different markings"
    total, part = swarm["estimated_total"], swarm["estimated_coverage"]
    if total is None:
        return f"{text}; how many there are, one search alone does not tell"
    return (
        f"{text}, {swarm['seen_by_one_search']:.0%} of them by one search alone; by that there are about {total:,} or "
        f"more, so that {part:.0%} or less were seen (an estimate, and no proof: all searches begin at the initial "
        "marking)"
    )
