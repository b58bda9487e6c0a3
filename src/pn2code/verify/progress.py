"""One line on a terminal that tells how an exploration goes on."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from types import TracebackType
from typing import Any, Self, TextIO

_PHASES = {
    "explore": "exploring",
    "graph": "arcs",
    "components": "components",
    "properties": "liveness and fairness",
    "bounds": "bounds",
}


class ProgressLine:
    """Shows states, rate, frontier, depth and memory on stderr; nothing where that is no terminal.

    Args:
        shown: whether anything is shown at all.
        stream: where; stderr by default.
    """

    def __init__(self, *, shown: bool = True, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr
        self._shown = shown and self._stream.isatty()
        self._written = False

    def __enter__(self) -> Self:
        self._say("compiling ...")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._written:
            self._stream.write("\r\x1b[K")
            self._stream.flush()

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
        self._say(f"{phase}: " + "  ".join(parts))

    def _say(self, text: str) -> None:
        if self._shown:
            self._stream.write(f"\r\x1b[K{text}")
            self._stream.flush()
            self._written = True
