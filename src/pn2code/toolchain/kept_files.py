"""Files that are kept from one run to the next: named by what goes into them, and known to be as they were kept."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from pn2code.base.private_folder import write_whole
from pn2code.base.sha256 import sha256_of
from pn2code.emission.output import OutputFile


def sum_of(path: Path) -> Path:
    """Where the SHA-256 of a file that is kept stands."""
    return path.with_name(f"{path.name}.sum")


def is_sound(path: Path) -> bool:
    """Whether a file is as it was kept."""
    try:
        return sum_of(path).read_bytes() == sha256_of(path).encode()
    except OSError:
        return False


def keep(made: Path, path: Path) -> None:
    """Puts a file in its place; another process that keeps the same meanwhile makes it anew at the worst.

    Raises:
        OSError: there is no room.
    """
    write_whole(sum_of(path), sha256_of(made).encode())
    made.replace(path)


def note_use(path: Path) -> None:
    """Notes that a file was used."""
    for each in (path, sum_of(path)):
        os.utime(each)


def put(room: Path, files: Sequence[OutputFile]) -> None:
    # Names are put together as texts: there are a hundred for each program.
    """Writes files below a folder."""
    for folder in sorted({f.path.rpartition("/")[0] for f in files}):
        (room / folder).mkdir(parents=True, exist_ok=True)
    for f in files:
        with open(f"{room}/{f.path}", "w", encoding="utf-8") as file:  # noqa: PTH123 - for each file
            file.write(f.text)


@lru_cache(maxsize=16)
def digest_of_runtime(runtime: tuple[OutputFile, ...]) -> str:
    """Most of a megabyte, the same for each program of a host."""
    return digest((), runtime)


def digest(tools: Sequence[str], files: Sequence[OutputFile] = ()) -> str:
    """Names what is made of these texts by these tools."""
    found = hashlib.sha256()
    for part in (*tools, *(text for f in files for text in (f.path, f.text))):
        data = part.encode("utf-8", "surrogateescape")
        found.update(f"{len(data)}:".encode())
        found.update(data)
    return found.hexdigest()[:32]
