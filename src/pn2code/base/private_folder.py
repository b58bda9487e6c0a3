"""The user's own cache folder: `$XDG_CACHE_HOME/pn2code` or `~/.cache/pn2code`; `tidy_folder` keeps it small."""

from __future__ import annotations

import os
from pathlib import Path

from pn2code.base.os_reason import os_reason
from pn2code.base.tidy_folder import tidy_when_due


def private_folder() -> Path | None:
    """A folder that only this user can write to, or None: what is loaded must not come from anyone else."""
    folder, _ = _found()
    if folder is not None:
        tidy_when_due(folder)
    return folder


def without_folder() -> str:
    """Why there is no such folder, the end of a sentence; "" when there is one."""
    return _found()[1]


def _found() -> tuple[Path | None, str]:
    try:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:
        return None, "the home folder is not known"
    folder = base / "pn2code"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = folder.stat()
    except OSError as problem:
        return None, f"`{folder}` cannot be made: {os_reason(problem)}"
    if not hasattr(os, "getuid") or status.st_uid != os.getuid() or status.st_mode & 0o022:
        return None, f"`{folder}` is not this user's alone"
    if not os.access(folder, os.W_OK):
        return None, f"`{folder}` cannot be written to"
    return folder, ""


def write_whole(path: Path, data: bytes) -> None:
    """Write a file of the folder so that no other process reads half of it."""
    temporary = new_beside(path)
    temporary.write_bytes(data)
    temporary.replace(path)


def new_beside(path: Path) -> Path:
    """A new, empty file beside one that is to be replaced by it."""
    import tempfile  # loads a good deal, and is rarely needed

    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f"{path.stem}-", suffix=".tmp")
    os.close(handle)
    return Path(name)
