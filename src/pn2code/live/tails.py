"""Traces that other programs write, read as they grow: whole lines only, from the beginning if the file begins anew.

    tails = Tails([folder / "supervisor.trace.jsonl"], folder)
    for tail in tails.look():
        tail.by, tail.lines      # what is new

What cannot be read is left out and counted: a line that is half written, is none, or is longer than any.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

SUFFIX = ".trace.jsonl"
MOST_AT_ONCE = 1 << 20
"""Bytes of a file that are read in a look; the rest with the next ones."""
MOST_FILES = 100


class Tail:
    """One trace.

    Attributes:
        by: who writes it, as its first line says; "": there is none yet.
        session: that of its first line, "" where it says none.
        lines: what was new at the last look, without the first line.
        header: the first line.
        is_new: whether the file has begun, or begun anew, at the last look.
        written: when it was written last.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.written = 0.0
        self.unreadable = 0
        self._key = (0, 0)
        self._begin()
        self.is_new = False

    def _begin(self) -> None:
        self.by = self.session = ""
        self.header: dict[str, Any] = {}
        self.lines: list[dict[str, Any]] = []
        self._at = 0
        self._part = b""
        self.is_new = True

    def look(self) -> bool:
        """Reads on; whether there was all that there is."""
        self.lines, self.is_new = [], False
        try:
            with self.path.open("rb") as stream:
                found = os.fstat(stream.fileno())
                key = (found.st_dev, found.st_ino)
                if key != self._key or found.st_size < self._at:
                    self._begin()
                    self._key = key
                self.written = found.st_mtime
                stream.seek(self._at)
                data = stream.read(MOST_AT_ONCE)
        except OSError:
            return True
        self._at += len(data)
        *whole, self._part = (self._part + data).split(b"\n")
        if len(self._part) > MOST_AT_ONCE:  # no line is as long
            self._part = b""
            self.unreadable += 1
        for text in whole:
            self._take(text)
        return len(data) < MOST_AT_ONCE

    def _take(self, text: bytes) -> None:
        try:
            line = json.loads(text)
        except (ValueError, RecursionError):
            line = None
        if not isinstance(line, dict):
            self.unreadable += 1
        elif not self.header:
            self.header = line
            self.by, self.session = str(line.get("by", "")), str(line.get("session", ""))
        else:
            self.lines.append(line)

    def start_over(self) -> None:
        """From the beginning, with the next look."""
        self._begin()


class Tails:
    """All traces of a cell: those that are named, or those in a folder.

    Args:
        paths: that are named.
        folder: whose traces count as well; None: only those that are named.
    """

    def __init__(self, paths: Sequence[Path], folder: Path | None) -> None:
        self._folder = folder
        self._tails = {path: Tail(path) for path in paths}

    def look(self) -> Iterator[Tail]:
        """All that are there, each after reading on."""
        if self._folder is not None:
            try:
                found = sorted(self._folder.glob(f"*{SUFFIX}"))
            except OSError:
                found = []
            for path in found[: MOST_FILES - len(self._tails)]:
                self._tails.setdefault(path, Tail(path))
        for tail in self._tails.values():
            tail.look()
            yield tail

    def start_over(self) -> None:
        """Everything once more: another session has begun."""
        for tail in self._tails.values():
            tail.start_over()
