"""Condition numbers as people read them."""

from __future__ import annotations

import pytest

from pn2code.base.conditioning import condition_text


@pytest.mark.parametrize(
    ("condition", "digits", "text"),
    [
        (12.34, 0, "12"),
        (12.34, 1, "12.3"),
        (1e6, 0, "1000000"),
        (6.3e17, 1, "above 1,000,000"),
        (float("inf"), 0, "above 1,000,000"),
    ],
)
def test_of_a_singularity_only_that_it_is_one(condition: float, digits: int, text: str) -> None:
    assert condition_text(condition, digits) == text
