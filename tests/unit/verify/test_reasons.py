"""What stands in sentences about why something is not known."""

from __future__ import annotations

import pytest

from pn2code.verify.answers.reasons import raised


@pytest.mark.parametrize(
    ("message", "said"), [("Div", "`Div`"), ("`hd` of an empty list", "`hd` of an empty list")]
)
def test_there_are_no_back_ticks_within_back_ticks(message: str, said: str) -> None:
    assert raised(message) == said
