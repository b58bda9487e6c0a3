"""Tokens of channels as the scalars of messages, and back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pn2code.channels.scalars import ScalarValue
from pn2code.ml.colsets import Colset
from pn2code.semantics.colour_json import to_json
from pn2code.semantics.values import Timed


def scalars(c: Colset, token: Any) -> tuple[ScalarValue, ...]:
    """The scalars of a token in the declared order of the colour set."""
    value = token.value if isinstance(token, Timed) else token
    return tuple(_leaves(to_json(c, value)))


def _leaves(data: Any) -> Iterator[ScalarValue]:
    match data:
        case list():
            for item in data:
                yield from _leaves(item)
        case dict():
            for item in data.values():
                yield from _leaves(item)
        case None:
            yield 1  # unit
        case _:
            yield data
