"""How an exploration goes on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import IO, Any

from pn2code.base.progress_line import Line

_PHASES = {
    "explore": "exploring",
    "graph": "arcs",
    "components": "components",
    "properties": "liveness and fairness",
    "bounds": "bounds",
}


_FIRST = "compiling and exploring the net ..."

ENDLESS_S = 60.0
"""Of an exploration without a limit: after them it is said that there is none."""
_ENDLESS = (
    "no limit is set, and there may be no end of markings: `--max-seconds S` or `--max-states N` ends it with what is "
    "known by then, as Ctrl-C does now"
)
_TIMED = "; `--reduce time` counts markings that differ in the time alone as one"


class ProgressLine(Line):
    """Shows states, rate, frontier, depth and memory; a few plain lines where the stream is no terminal.

    Args:
        is_limited: whether a limit of states or time is set; if not, it is said once that one helps.
        is_timed: whether markings may differ in the time alone, and are not counted as one.
    """

    def __init__(
        self,
        *,
        shown: bool = True,
        stream: IO[str] | None = None,
        is_limited: bool = True,
        is_timed: bool = False,
    ) -> None:
        super().__init__(shown=shown, stream=stream, first=_FIRST, plain=True)
        self._advice = "" if is_limited else _ENDLESS + (_TIMED if is_timed else "")
        self._begin("")

    def _begin(self, what: str) -> None:
        self._what, self._exploration, self._states = what, 1, 0

    def stage(self, text: str) -> None:
        """Several things are explored one after the other: what is counted from now on is of another one."""
        self._begin("" if text == _FIRST else text.removesuffix(" ..."))
        super().stage(text)

    def update(self, said: Mapping[str, Any]) -> None:
        """What the explorer says of itself, twice a second."""
        own = said.get("phase", "explore")
        phase = _PHASES.get(own, str(own))
        if self._what:
            phase = self._what if own == "explore" else f"{self._what}: {phase}"
        states = said.get("states", 0)
        if own == "explore" and states < self._states:  # another way to look at the same
            self._exploration += 1
        self._states = states
        if self._exploration > 1:
            phase += f" ({self._exploration})"
        going_on = [
            f"{said.get('rate', 0):,.0f} states/s",
            f"{said.get('frontier', 0):,} waiting",
            f"depth {said.get('depth', 0):,}",
        ]
        parts = [
            f"{states:,} states",
            f"{said.get('arcs', 0):,} arcs",
            # All states are known in what comes after.
            *(going_on if said.get("phase", "explore") == "explore" else ()),
            f"{said.get('mib', 0):,.0f} MiB",
            f"{said.get('seconds', 0):.0f} s",
        ]
        self.say(f"{phase}: " + "  ".join(parts))
        if self._advice and said.get("phase") == "explore" and said.get("seconds", 0) >= ENDLESS_S:
            self.keep(self._advice)
            self._advice = ""
