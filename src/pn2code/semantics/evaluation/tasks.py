"""Tasks: what an evaluation is made of (see `evaluate`, which runs them)."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from typing import Any

Task = Generator[Any, Any, Any]
"""Yields steps, is sent their values, returns a value or a `Tail`."""
Step = Any
"""A value, or a task that finds it."""


@dataclass(slots=True, eq=False)
class Tail:
    """What a task returns to be replaced by another step."""

    step: Step
