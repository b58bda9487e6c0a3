"""Methods that are lent without what they belong to."""

from __future__ import annotations

import gc

import pytest

from pn2code.base.weakly import weakly


class Whole:
    def __init__(self) -> None:
        self.lent = weakly(self.sum)
        self.ten = 10

    def sum(self, left: int, *, right: int = 0) -> int:
        return self.ten + left + right


def test_it_is_called_as_the_method_is() -> None:
    whole = Whole()
    assert whole.lent(1, right=2) == whole.sum(1, right=2) == 13


def test_it_does_not_keep_its_object() -> None:
    was_on = gc.isenabled()
    gc.disable()
    try:
        lent = Whole().lent
    finally:
        if was_on:
            gc.enable()
    with pytest.raises(ReferenceError, match="has gone"):
        lent(1)
