"""Tasks: what an evaluation is made of (see `evaluate`, which runs them)."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

from pn2code.base.frozen import record

Task = Generator[Any, Any, Any]
"""Yields steps, is sent their values, returns a value or a `Tail`."""
Step = Any
"""A value, or a task that finds it."""


@record(eq=False)
class Tail:
    """What a task returns to be replaced by another step."""

    step: Step
