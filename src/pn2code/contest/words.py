"""The contest's words: its examinations, what their lines are called, and what stands for what is not known.

It is loaded before anything else of the command, so it needs nothing that takes long to load.
"""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

FORMULAS = (
    "ReachabilityCardinality", "ReachabilityFireability", "UpperBounds", "CTLCardinality", "CTLFireability",
    "LTLCardinality", "LTLFireability",
)  # fmt: skip
GLOBAL = ("ReachabilityDeadlock", "OneSafe", "QuasiLiveness", "Liveness", "StableMarking")
SPACE = "StateSpace"
ALL = (SPACE, *GLOBAL, *FORMULAS)
UNKNOWN = "CANNOT_COMPUTE"


def names(examination: str, folder: Path) -> list[str]:
    """What the lines of an examination are called, before the net is known; of the state space none."""
    if examination in GLOBAL:
        return [examination]
    return _names_in(folder / f"{examination}.xml") if examination in FORMULAS else []


def unknown(name: str) -> str:
    """The line of a formula that is not known."""
    return f"FORMULA {name} {UNKNOWN}"


def _names_in(path: Path) -> list[str]:
    """The names of the formulas of a file, as far as they are seen at once; for who cannot wait until it is read."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return []
    return [unescape(name.strip()) for name in re.findall(r"<id>([^<>]+)</id>", text)]
