"""What a command had done when its time was up: the stages that it has said, and how far it was in the last one.

so_far = SoFar()
so_far.stage("sweeping pairs ...")
so_far.say("sweeping pairs: 1,200 of 9,870, 310 a second, about 28 s left")
so_far.words()      # "; it was broken off in: sweeping pairs (1,200 of 9,870); done before: ..."
"""

from __future__ import annotations

import re

_COUNT = re.compile(r".*?: ([\d,]+(?: of [\d,]+| [a-z]+)?)(?:,|$)")


class SoFar:
    """Hears what a progress line hears."""

    def __init__(self) -> None:
        self._stages: list[str] = []
        self._count = ""

    def stage(self, text: str) -> None:
        """A new part of the work begins."""
        self._stages.append(text.removesuffix(" ..."))
        self._count = ""

    def say(self, text: str) -> None:
        """How far this part is."""
        found = _COUNT.match(text)
        self._count = found[1] if found is not None else text

    def words(self, *, is_told: bool = False) -> str:
        """Behind what was not done; "": nothing had begun. `is_told`: what is wrong is told nevertheless."""
        if not self._stages:
            return ""
        *done, last = self._stages
        count = f" ({self._count} when it was said last)" if self._count else ""
        before = "; ".join(done) or "nothing"
        rest = (
            "What was found to be wrong until then is told; of all else nothing is known"
            if is_told
            else "Of all else nothing is known, and what was done answers nothing"
        )
        return f"; it was broken off in: {last}{count}. Done before: {before}. {rest}"
