"""Writes the files of a new cell, all of them or none.

write(Path("press"), {"cell.toml": b"..."})
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from pn2code.base.writable import why_folder_unwritable


def why_unwritable(folder: Path) -> str:
    """Why a folder cannot become that of a new cell, as a clause; "": it can, as far as can be seen."""
    why = why_folder_unwritable(folder)
    if why or not folder.exists():
        return why
    try:
        first = next(iter(sorted(p.name for p in folder.iterdir())), "")
    except OSError as problem:
        return (problem.strerror or str(problem)).lower()
    return f"the folder is not empty: `{first}` is in it" if first else ""


def write(folder: Path, files: Mapping[str, bytes]) -> None:
    """Make the folder, with those above it, and write the files; what was made is removed if that fails.

    Raises:
        OSError: something cannot be written, or is there already.
    """
    made: list[Path] = []
    try:
        for above in reversed((folder, *folder.parents)):
            if not above.exists():
                above.mkdir()
                made.append(above)
        for name, data in files.items():
            path = folder / name
            with path.open("xb") as file:
                made.append(path)
                file.write(data)
    except BaseException:
        for path in reversed(made):
            with suppress(OSError):
                path.rmdir() if path.is_dir() else path.unlink()
        raise
