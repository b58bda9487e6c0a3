"""How much of the long sweeps the tests do: `make thorough` does all of it, the ordinary run a part."""

from __future__ import annotations

import os

THOROUGH = bool(os.environ.get("PN2CODE_THOROUGH"))


def amount(ordinary: int, everything: int) -> int:
    """Which of the two numbers counts in this run."""
    return everything if THOROUGH else ordinary
