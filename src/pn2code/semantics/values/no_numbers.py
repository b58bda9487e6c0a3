"""What stands for reals that are no numbers, in orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    pass


class _Least:
    """Before all numbers."""

    def __lt__(self, other: object) -> bool:
        return other is not self

    def __gt__(self, other: object) -> bool:
        return False


class _Alike:
    """Neither before nor after any number, and so like each of them where one goes on with what comes next."""

    def __eq__(self, other: object) -> bool:
        return True

    def __lt__(self, other: object) -> bool:
        return False

    def __gt__(self, other: object) -> bool:
        return False

    __hash__ = None  # type: ignore[assignment]  # as lists have it


LEAST, ALIKE = _Least(), _Alike()
"""What is no number, in orders: that of tokens is one, so that markings have one text; that of `lt` is none."""
