"""Texts of multi-set bounds, as the real tool prints them, until a deadline."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from operator import itemgetter
from typing import Any, TypeVar

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.base.readable import readable
from pn2code.ml.core.colsets import Colset
from pn2code.semantics.values.colour_json import from_json
from pn2code.semantics.values.colours import TEXTS

_LOOKS = 256
"""Colours of which texts are made between two looks at the clock."""
_Item = TypeVar("_Item")


def multiset_text(
    colset: Colset, found: Sequence[tuple[int, Any]] | None, deadline: Deadline | None = None
) -> str | None:
    """As the real tool prints it, without stamps; None for None.

    Raises:
        TimeIsOverError: the deadline has come before the text was made.
    """
    if found is None:
        return None
    values = []
    for count, value in _in_time(found, deadline):
        if count:
            decoded = from_json(colset, value)
            values.append((TEXTS.key(colset, decoded), decoded, count))
    values.sort(key=itemgetter(0))
    lines = [
        f"{count}`{readable(TEXTS.text(colset, value))}"
        for _, value, count in _in_time(values, deadline)
    ]
    return "++\n".join(lines) or "empty"


def _in_time(items: Sequence[_Item], deadline: Deadline | None) -> Iterator[_Item]:
    """The items; the clock is looked at before each of some hundred."""
    for i, item in enumerate(items):
        if deadline is not None and i % _LOOKS == 0 and deadline.is_over():
            raise TimeIsOverError
        yield item
