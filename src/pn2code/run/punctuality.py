"""How punctual a run on the wall clock is: the supervisor's answers, and when ends of commands are noticed.

    punctuality = Punctuality({"placed": "robot1", "order": "robot1"})
    punctuality.asked("placed")            # robot1 has written a message
    punctuality.answered("order")          # robot1 has taken the next one
    punctuality.described()                # {"answers": 1, "answer": 0.002, "longest": 0.002, ...}

An *answer* is the time (s of the wall clock) from a message of a robot or device to the next one that it takes: how
long the supervisor makes it wait, whatever it waits for.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(slots=True)
class Punctuality:
    """Collects times.

    Args:
        party: by channel, the robot or device at its end.
    """

    party: Mapping[str, str] = field(default_factory=dict)
    answers: list[float] = field(default_factory=list)
    longest: float = 0.0
    latest_notice: float = 0.0
    _since: dict[str, float] = field(default_factory=dict)

    def asked(self, channel: str) -> None:
        """A robot has written a message."""
        if who := self.party.get(channel):
            self._since[who] = time.perf_counter()

    def answered(self, channel: str) -> None:
        """A robot has taken a message."""
        since = self._since.pop(self.party.get(channel, ""), None)
        if since is not None:
            self.answers.append(time.perf_counter() - since)
            self.longest = max(self.longest, self.answers[-1])

    def noticed(self, late: float) -> None:
        """The end of a command was noticed so many seconds after it was due."""
        self.latest_notice = max(self.latest_notice, late)

    def described(self) -> dict[str, Any]:
        """In seconds; None where there is nothing yet."""
        return {
            "answers": len(self.answers),
            "answer": self.answers[-1] if self.answers else None,
            "longest": self.longest if self.answers else None,
            "noticed": self.latest_notice,
        }
