"""What would keep a file or folder from being written, found before any work is done for it.

why_file_unwritable(Path("missing/report.html"))     # "there is no folder `missing`"
why_folder_unwritable(Path("net.cpn/out"))           # "`net.cpn` is not a folder"
"""

from __future__ import annotations

import os
from pathlib import Path


def why_file_unwritable(path: Path, *, makes_folders: bool = False) -> str:
    """Why a file cannot be written, as a clause; "": it can, as far as can be seen.

    Args:
        path: the file; a device or a pipe can be written.
        makes_folders: missing folders will be made.
    """
    try:
        if path.is_dir():
            return "it is a folder"
        if path.exists() and not path.is_file():
            return ""
        if not path.parent.is_dir():
            missing = f"there is no folder `{path.parent}`"
            return why_folder_unwritable(path.parent) if makes_folders else missing
        is_refused = path.exists() and not os.access(path, os.W_OK)
        return "permission denied" if is_refused else why_folder_unwritable(path.parent)
    except OSError as problem:  # a name that is too long, a folder that must not be entered
        return (problem.strerror or str(problem)).lower()


def why_folder_unwritable(folder: Path) -> str:
    """The same for a folder that is made with all that is missing above it."""
    try:
        there = next(p for p in (folder, *folder.parents) if p.exists() or p.is_symlink())
        if not there.is_dir():
            return f"`{there}` is not a folder"
        return "" if os.access(there, os.W_OK | os.X_OK) else "permission denied"
    except OSError as problem:
        return (problem.strerror or str(problem)).lower()
