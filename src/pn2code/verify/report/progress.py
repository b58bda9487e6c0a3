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


class ProgressLine(Line):
    """Shows states, rate, frontier, depth and memory; a few plain lines where the stream is no terminal."""

    def __init__(self, *, shown: bool = True, stream: IO[str] | None = None) -> None:
        super().__init__(
            shown=shown, stream=stream, first="compiling and exploring the net ...", plain=True
        )

    def update(self, said: Mapping[str, Any]) -> None:
        """What the explorer says of itself, twice a second."""
        phase = _PHASES.get(said.get("phase", ""), str(said.get("phase", "")))
        parts = [
            f"{said.get('states', 0):,} states",
            f"{said.get('arcs', 0):,} arcs",
            f"{said.get('rate', 0):,.0f} states/s",
            f"{said.get('frontier', 0):,} waiting",
            f"depth {said.get('depth', 0):,}",
            f"{said.get('mib', 0):,.0f} MiB",
            f"{said.get('seconds', 0):.0f} s",
        ]
        self.say(f"{phase}: " + "  ".join(parts))
