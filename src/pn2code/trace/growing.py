"""Reading and writing traces (docs/trace.md) while they grow."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any


class TraceError(Exception):
    """A trace is not what it should be; the message says where."""


class GrowingTrace:
    """A trace file that another process writes, read line by line as it grows.

    Attributes:
        end: the last line of a complete trace, empty until it has been read.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._stream = path.open(encoding="utf-8")
        self.end: dict[str, Any] = {}
        self.header = self._line()

    def next_occurrence(self) -> dict[str, Any]:
        """The next occurrence of a transition; notes are skipped.

        Raises:
            TraceError: there is none yet, or the line is not JSON.
        """
        while True:
            line = self._line()
            if "transition" in line:
                return line

    def complete_lines(self) -> list[dict[str, Any]]:
        """What has been written since the last call; a line that is not whole yet comes next time."""
        out: list[dict[str, Any]] = []
        while True:
            at = self._stream.tell()
            if not self._stream.readline().endswith("\n"):
                self._stream.seek(at)
                return out
            self._stream.seek(at)
            out.append(self._line())

    def _line(self) -> dict[str, Any]:
        text = self._stream.readline()
        if not text.endswith("\n"):
            raise TraceError(f"{self._path}: ends in the middle of a line")
        try:
            line = json.loads(text)
        except ValueError as problem:
            raise TraceError(f"{self._path}: not JSON: {text.rstrip()!r}") from problem
        if not isinstance(line, dict):
            raise TraceError(f"{self._path}: not an object: {text.rstrip()!r}")
        if line.get("event") == "end":
            self.end = line
        return line

    def close(self) -> None:
        """Close the file."""
        self._stream.close()


def trace_text(header: dict[str, Any], events: list[dict[str, Any]]) -> str:
    """A whole trace: one JSON object a line."""
    return "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in (header, *events))
