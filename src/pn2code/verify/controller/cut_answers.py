"""Answers of an exploration that was ended early, with the reason for which they are not known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration


def parted(
    rows: Sequence[Mapping[str, Any]], last: int
) -> tuple[Sequence[Mapping[str, Any]], Sequence[Mapping[str, Any]]]:
    """The answers about the cell, and so many about all orders, if there are any."""
    return (rows[: len(rows) - last], rows[len(rows) - last :]) if len(rows) >= last else (rows, ())


def with_reason(answer: Mapping[str, Any], why: str) -> Mapping[str, Any]:
    """The answer, with the reason for which it is not known."""
    is_so = answer["answer"] == "unknown" and answer.get("why") == "states"
    return {**answer, "why": why} if is_so else answer


def is_full(found: Exploration, limits: Limits) -> bool:
    """Whether as many states were seen as are permitted at all."""
    return limits.max_states is not None and found.nodes >= limits.max_states


def too_late(answers: Sequence[Mapping[str, Any]]) -> tuple[Mapping[str, Any], ...]:
    """The answers, where the time was over before as many states were seen as are permitted."""
    return tuple(with_reason(answer, "seconds") for answer in answers)
