"""Writing traces (docs/trace.md), byte for byte as the compiled simulator does.

Each line is written whole and flushed. When that fails, what there is of the line is cut off.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

from pn2code.base.os_reason import os_reason
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game
from pn2code.trace import token_game as lines

_ESCAPED = re.compile(r'[\x00-\x1f\x7f"\\]')
_SHORT = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def json_text(value: Any) -> str:
    """JSON as `pn_text.h` writes it; dictionaries keep their order."""
    match value:
        case None:
            return "null"
        case bool():
            return "true" if value else "false"
        case int():
            return str(value)
        case float():
            return repr(value) if math.isfinite(value) else f'"{value!r}"'
        case str():
            return f'"{_ESCAPED.sub(_escape, value)}"'
        case list() | tuple():
            return f"[{', '.join(map(json_text, value))}]"
        case dict():
            return f"{{{', '.join(f'{json_text(k)}: {json_text(v)}' for k, v in value.items())}}}"
        case _:
            raise TypeError(f"{type(value).__name__} is no JSON")


def _escape(found: re.Match[str]) -> str:
    c = found.group()
    return _SHORT.get(c) or f"\\u{ord(c):04x}"


class TraceUnwritableError(Exception):
    """The trace cannot be written.

    Args:
        path: its file.
        reason: in the system's words, lower case.
    """

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"cannot write the trace `{path}`: {reason}")
        self.path = path
        self.reason = reason


class TraceFile:
    """A trace being written.

    Args:
        path: the file; None: nothing is written.

    Raises:
        TraceUnwritableError: it cannot be opened, or a line cannot be written.
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._good = 0
        try:
            self._file = path.open("wb", buffering=0) if path is not None else None
        except OSError as problem:
            raise self._unwritable(problem) from None

    def _unwritable(self, problem: OSError) -> TraceUnwritableError:
        assert self._path is not None
        return TraceUnwritableError(self._path, os_reason(problem))

    def header(self, game: Game, by: str, seed: int, initial: str | None = None) -> None:
        """The first line; before the game begins.

        Args:
            game: the game.
            by: who plays.
            seed: of the random numbers.
            initial: initial markings of its net that are not those of the net's file, as JSON.
        """
        if self._file is not None:
            first = lines.header(game, by)
            if initial is not None:
                first["initial"] = json.loads(initial)
            self._line({**first, "seed": seed})

    def occurrence(self, game: Game, occurred: BindingElement) -> None:
        """The line of what has just been fired."""
        if self._file is not None:
            self._line(lines.occurrence(game, occurred))

    def end(self, time: int | float, why: str) -> None:
        """The last line of a complete trace."""
        if self._file is not None:
            self._line({"t": time, "event": "end", "why": why})

    def close(self) -> None:
        """Closes the file; without an `end` the trace is not complete."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _line(self, line: dict[str, Any]) -> None:
        assert self._file is not None
        data = (json_text(line) + "\n").encode("utf-8", "surrogateescape")
        try:
            left = memoryview(data)
            while left:
                left = left[self._file.write(left) :]
        except OSError as problem:
            self._cut()
            raise self._unwritable(problem) from None
        self._good += len(data)

    def _cut(self) -> None:
        """Takes away what there is of a line that is not whole; what is no ordinary file stays as it is."""
        assert self._file is not None
        file, self._file = self._file, None
        try:
            if file.seekable():
                file.truncate(self._good)
        except OSError:
            pass  # a device: the failure to write is reported in any case
        finally:
            file.close()
