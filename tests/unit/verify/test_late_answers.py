"""Answers of a cell that are open since the time was over, while few of the permitted states were looked at first."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from pn2code.verify.controller.cut_answers import is_full, too_late
from pn2code.verify.exploring.limits import Limits


def test_only_what_is_open_for_the_number_of_states_has_another_reason() -> None:
    rows = [
        {"answer": "unknown", "why": "states"},
        {"answer": "unknown", "why": "memory"},
        {"answer": "yes"},
    ]
    assert too_late(rows) == ({"answer": "unknown", "why": "seconds"}, *rows[1:])


@pytest.mark.parametrize(
    ("nodes", "most", "expected"), [(20, None, False), (20, 21, False), (20, 20, True)]
)
def test_what_is_permitted_at_all_counts(nodes: int, most: int | None, expected: bool) -> None:
    found = cast(Any, SimpleNamespace(nodes=nodes))
    assert is_full(found, Limits(max_states=most)) is expected
