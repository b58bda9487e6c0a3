"""What was not used for a long time leaves the user's cache folder, and so does the oldest of what is too much.

Programs and answers are counted where they are written (`toolchain.programs`, `kept_answers`). Everything else there,
compiled modules, templates, tables of parsers, libraries of the runtime, what killed processes have left, is named by
the place or the content of what it was made from, and stays behind when pn2code moves on. Once a day a command looks
at all of it when it ends. Nothing is lost by that: what is missing is made again.

Other processes may use the folder meanwhile, or tidy it, too. Each of them makes again what it does not find, and what
somebody has used within the last hour stays, so that nothing goes between a look for a file and its use.
"""

from __future__ import annotations

import atexit
import os
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

MOST_DAYS = 30
"""Files that nobody has used for so long go."""
MOST_BYTES = {"modules": 100_000_000, "programs": 400_000_000, "answers": 50_000_000}
"""By folder; the least recently used go first."""
MOST_OTHER_BYTES = 20_000_000
"""Of files that are in none of these."""
IN_USE_S = 3600.0
"""Nothing goes that was used within this time."""
STAMP = "tidied"
"""The file whose date says when this was last done."""
_DAY_S = 86_400.0

_looked_at: set[str] = set()


class _File(NamedTuple):
    used: float
    size: int
    path: str


def tidy_when_due(folder: Path) -> None:
    """Has the folder tidied when this process ends, if that was not done for a day. It costs one look at a file."""
    name = str(folder)
    if name in _looked_at:
        return
    _looked_at.add(name)
    stamp = folder / STAMP
    try:
        is_due = abs(time.time() - stamp.stat().st_mtime) > _DAY_S
    except FileNotFoundError:
        is_due = True
    except OSError:
        return
    if is_due:
        with suppress(OSError):
            stamp.touch()  # so that others that begin meanwhile do not do the same
            atexit.register(tidy, folder)


def tidy(folder: Path, now: float | None = None) -> None:
    """Removes what is old, and the oldest of what is too much.

    Args:
        now: in seconds since 1970; None: by the clock.
    """
    now = time.time() if now is None else now
    rooms: dict[str, list[_File]] = {}
    for room, file in _files(str(folder)):
        rooms.setdefault(room, []).append(file)
    for room, files in rooms.items():
        left = MOST_BYTES.get(room, MOST_OTHER_BYTES)
        for file in sorted(files, reverse=True):
            left -= file.size
            age = now - file.used
            if age > IN_USE_S and (left < 0 or age > MOST_DAYS * _DAY_S):
                with suppress(OSError):
                    os.unlink(file.path)  # noqa: PTH108 - of thousands
    for room in MOST_BYTES:
        _remove_empty(str(folder / room), now)


def _files(folder: str) -> Iterator[tuple[str, _File]]:
    """All files with the name of their folder within the cache; "" for those in the cache folder itself."""
    for here, _, names in os.walk(folder):
        room = Path(here).relative_to(folder).parts[:1]
        for name in names:
            path = os.path.join(here, name)  # noqa: PTH118 - of thousands
            if here == folder and name == STAMP:
                continue
            with suppress(OSError):  # somebody else has removed it
                status = os.lstat(path)
                used = max(status.st_atime, status.st_mtime)
                yield "".join(room), _File(used, status.st_size, path)


def _remove_empty(folder: str, now: float) -> None:
    """Folders in which nothing is left and nothing has just been done, the deepest ones first."""
    for here, _, _ in os.walk(folder, topdown=False):
        if here != folder:
            with suppress(OSError):  # there is something in it
                if now - os.stat(here).st_mtime > IN_USE_S:  # noqa: PTH116
                    os.rmdir(here)  # noqa: PTH106
