"""SHA-256 of what a report is about, and of what it consists of."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

CHUNK = 1 << 20


def sha256(path: Path) -> str:
    """Of a file's bytes, as hexadecimal digits.

    Raises:
        OSError: it cannot be read.
    """
    found = hashlib.sha256()
    with path.open("rb") as file:
        while chunk := file.read(CHUNK):
            found.update(chunk)
    return found.hexdigest()


def of_files(folder: Path, paths: Iterable[Path]) -> list[tuple[str, str]]:
    """Names relative to a folder, sorted, with hashes; what is no file is passed over."""
    files = sorted({p.relative_to(folder).as_posix() for p in paths if p.is_file()})
    return [(name, sha256(folder / name)) for name in files]


def listing(rows: Iterable[tuple[str, str]]) -> str:
    """In the form that `sha256sum --check` reads."""
    return "".join(f"{digest}  {name}\n" for name, digest in rows)
