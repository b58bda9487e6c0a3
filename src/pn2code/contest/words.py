"""The contest's words for what is not known."""

from __future__ import annotations

UNKNOWN = "CANNOT_COMPUTE"


def unknown(name: str) -> str:
    """The line of a formula that is not known."""
    return f"FORMULA {name} {UNKNOWN}"
