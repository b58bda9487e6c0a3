"""The values that a message has, from a token in the form of traces.

tuple(message_values(batch, [4, 5]))      # (2, 4, 5): a list is its length and its elements
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pn2code.ml.core.colsets import Colset, Kind


def message_values(c: Colset, data: Any) -> Iterator[Any]:
    """The values of a token of a channel in the declared order of its colour set, as `message_scalars` describes them.

    Args:
        c: the colour set.
        data: the token.
    """
    c = c.whole
    parts = [p for p in c.components if p is not None]
    if c.kind is Kind.LIST:
        yield len(data)
        for item in data:
            yield from message_values(parts[0], item)
    elif c.kind in (Kind.PRODUCT, Kind.RECORD):
        items = data.values() if isinstance(data, dict) else data
        for part, item in zip(parts, items, strict=True):
            yield from message_values(part, item)
    else:
        yield 1 if data is None else data
