"""SHA-256 of what a report is about, and of what it consists of."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from pn2code.base.sha256 import sha256_of


def name_of(folder: Path, path: Path) -> str:
    """A path as seen from a folder."""
    return Path(os.path.relpath(path, folder)).as_posix()


def of_files(folder: Path, paths: Iterable[Path]) -> list[tuple[str, str]]:
    """Names as seen from a folder, sorted, with hashes; what is no file is passed over."""
    files = {name_of(folder, p): p for p in paths if p.is_file()}
    return [(name, sha256_of(files[name])) for name in sorted(files)]


def listing(rows: Iterable[tuple[str, str]]) -> str:
    """In the form that `sha256sum --check` reads."""
    return "".join(f"{digest}  {name}\n" for name, digest in rows)
