"""Cells whose arms need a solver that does not come with every Python."""

from __future__ import annotations

import pytest

COLLABORATIVE = ("assembly",)
"""Examples with arms that have no spherical wrist."""


def solver_for(example: str) -> None:
    """Leaves a test out where there is no package of the solver for this Python (3.14)."""
    if example in COLLABORATIVE:
        pytest.importorskip("eaik")
