"""What a comparison finds, for one net and one question."""

from __future__ import annotations

from enum import Enum

from pn2code.base.frozen import frozen


class State(Enum):
    """How our answer relates to the real engine's."""

    AGREES = "yes"
    RANDOM = "random"
    """the net draws random numbers here: what is determined agrees"""
    INTENDED = "intended"
    """the engine has a known bug, or leaves it to chance; the note says which rule holds here"""
    UNSUPPORTED = "unsupported"
    DIFFERS = "NO"
    NOTHING = "–"
    """there is nothing to compare"""


@frozen
class Finding:
    """An answer compared; `note` says how it differs, or why there is none."""

    state: State
    note: str = ""


AGREES = Finding(State.AGREES)
NOTHING = Finding(State.NOTHING)


def differs(note: str) -> Finding:
    """Our answer is another one."""
    return Finding(State.DIFFERS, note)
