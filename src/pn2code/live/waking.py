"""Waiting for a folder to change: woken by the system where it can (inotify), else by the clock.

    with Waking(path) as waking:
        waking.wait(0.05)        # at most so long
        waking.drain()           # {"flag1_interno.robcad": 2}: how often which file was replaced

Reads only: nothing in the folder is opened, locked or written for it.
"""

from __future__ import annotations

import ctypes
import os
import select
import struct
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

from pn2code.base.closing import Closing

_NONBLOCK, _CLOEXEC = 0o4000, 0o2000000
_CLOSE_WRITE, _MOVED_TO, _CREATE, _DELETE = 0x8, 0x80, 0x100, 0x200
_OVERFLOW = 0x4000
_EVENT = struct.Struct("iIII")
_MASK = _CLOSE_WRITE | _MOVED_TO | _CREATE | _DELETE
_LOOK_S = 0.02
"""Between two looks where nothing wakes us."""


class Waking(Closing):
    """Wakes when something in a folder changes, as long as the folder is there."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._fd = -1
        self._inode = (0, 0)

    def wait(self, seconds: float) -> None:
        """Until something changes, at most so long."""
        if not self._is_set():
            time.sleep(min(seconds, _LOOK_S))
            return
        select.select([self._fd], [], [], seconds)

    @property
    def counts(self) -> bool:
        """Whether `drain` knows of each change."""
        return self._fd >= 0

    def drain(self) -> Counter[str]:
        """How often a file was put in the place of another since the last call, by name; "": more than can be told."""
        found: Counter[str] = Counter()
        if not self._is_set():
            return found
        with suppress(BlockingIOError):
            while data := os.read(self._fd, 1 << 14):
                at = 0
                while at + _EVENT.size <= len(data):
                    _, mask, _, size = _EVENT.unpack_from(data, at)
                    name = data[at + _EVENT.size : at + _EVENT.size + size].rstrip(b"\0")
                    at += _EVENT.size + size
                    if mask & (_MOVED_TO | _OVERFLOW):
                        found[os.fsdecode(name)] += 1
        return found

    def _is_set(self) -> bool:
        """Whether the folder that is there now is watched."""
        try:
            found = self._folder.stat()
        except OSError:
            self.close()
            return False
        if self._fd >= 0 and self._inode == (found.st_dev, found.st_ino):
            return True
        self.close()
        try:
            libc = ctypes.CDLL(None, use_errno=True)
            self._fd = libc.inotify_init1(_NONBLOCK | _CLOEXEC)
            watched = libc.inotify_add_watch(self._fd, os.fsencode(self._folder), _MASK)
        except (OSError, AttributeError):  # another system
            return False
        if self._fd < 0 or watched < 0:
            self.close()
            return False
        self._inode = (found.st_dev, found.st_ino)
        return True

    def close(self) -> None:
        """No more."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1
