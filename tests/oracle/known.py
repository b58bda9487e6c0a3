"""Differences from the engine that are meant, and why."""

from __future__ import annotations

from tests.oracle.answers import Said


def reason_of(text: str, ours: Said, theirs: Said) -> str:
    """Why the answers may differ; "" if no reason is known."""
    return ""
