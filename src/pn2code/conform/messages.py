"""Tokens of channels as the scalars of messages."""

from __future__ import annotations

from typing import Any

from pn2code.cell.token_values import message_values
from pn2code.channels.scalars import ScalarValue
from pn2code.ml.core.colsets import Colset
from pn2code.semantics.values.colour_json import to_json
from pn2code.semantics.values.data import Timed


def scalars(c: Colset, token: Any) -> tuple[ScalarValue, ...]:
    """The scalars of a token in the declared order of the colour set."""
    value = token.value if isinstance(token, Timed) else token
    return tuple(message_values(c, to_json(c, value)))
