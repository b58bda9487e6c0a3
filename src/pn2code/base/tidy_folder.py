"""What was not used for a long time leaves the user's cache folder, and so does the oldest of what is too much.

Programs and answers are counted where they are written (`toolchain.programs`, `kept_answers`). Everything else there,
compiled modules, templates, tables of parsers, libraries of the runtime, what killed processes have left, is named by
the place or the content of what it was made from, and stays behind when pn2code moves on. Once a day a command looks
at all of it when it ends. Nothing is lost by that: what is missing is made again.

Only what pn2code has made may go. A folder has its mark (`CACHEDIR.TAG`, which programs for backups know, too) when it
was new or had nothing in it but what is named as pn2code names it; in one without it, as where `XDG_CACHE_HOME` is a
folder of other things, nothing is touched. In a marked one, too, what has another name stays.

Other processes may use the folder meanwhile, or tidy it, too. Each of them makes again what it does not find, and what
somebody has used within the last hour stays, so that nothing goes between a look for a file and its use.
"""

from __future__ import annotations

import atexit
import os
import re
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
TAG = "CACHEDIR.TAG"
"""The mark of a folder that is pn2code's own (https://bford.info/cachedir)."""
_MARK = (
    "Signature: 8a477f597d28d172789f06886806bc55\n"  # that of all caches
    "# The cache of pn2code. What is here is made again when it is missing.\n"
)
_OWN = {
    "": r"[0-9a-f]{40}\.template(\w+\.tmp)?|(cpnml|hulls|property|tdl)-[0-9a-f]+(\.json|\.lark|-\w+\.tmp)",
    "modules": r".+\.pyc(\.\d+)?",
    "programs": r"[a-z]+(-runtime)?-[0-9a-f]{16,}(\.a)?(\.sum)?(-\w+\.tmp)?|build-\w{8}/.+",
    "answers": r"[a-z]+-[0-9a-f]{40}(\.json|-\w+\.tmp)",
}
"""How files are named that pn2code has made, by folder; their paths within it."""
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
    """Has the folder tidied when this process ends, if that was not done for a day. It costs a look at two files."""
    name = str(folder)
    if name in _looked_at:
        return
    _looked_at.add(name)
    if not folder.is_absolute() or folder.is_symlink() or not _is_marked(folder):
        return
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


def _is_marked(folder: Path) -> bool:
    """Whether a folder is pn2code's own; it is marked when nothing in it has another name than pn2code gives."""
    tag = folder / TAG
    try:
        if tag.is_file():
            return tag.read_text(encoding="utf-8", errors="replace").startswith(_MARK)
        for entry in os.scandir(folder):
            is_room = entry.is_dir(follow_symlinks=False) and entry.name in MOST_BYTES
            if not is_room and entry.name != STAMP and not re.fullmatch(_OWN[""], entry.name):
                return False
        tag.write_text(_MARK, encoding="utf-8")
    except OSError:
        return False
    return True


def _files(folder: str) -> Iterator[tuple[str, _File]]:
    """All files of pn2code's with the name of their folder within the cache; "" for those in the cache itself."""
    own = {room: re.compile(pattern) for room, pattern in _OWN.items()}
    for here, folders, names in os.walk(folder):
        if here == folder:
            folders[:] = [name for name in folders if name in own]
        room, *below = Path(here).relative_to(folder).parts or ("",)
        for name in names:
            if not own[room].fullmatch("/".join((*below, name))):
                continue
            path = os.path.join(here, name)  # noqa: PTH118 - of thousands
            with suppress(OSError):  # somebody else has removed it
                status = os.lstat(path)
                used = max(status.st_atime, status.st_mtime)
                yield room, _File(used, status.st_size, path)


def _remove_empty(folder: str, now: float) -> None:
    """Folders in which nothing is left and nothing has just been done, the deepest ones first."""
    for here, _, _ in os.walk(folder, topdown=False):
        if here != folder:
            with suppress(OSError):  # there is something in it
                if now - os.stat(here).st_mtime > IN_USE_S:  # noqa: PTH116 - for each file
                    os.rmdir(here)  # noqa: PTH106 - for each file
