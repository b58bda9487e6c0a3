"""Parsers whose tables are computed once for each user and grammar, not in each run.

Lark's LALR tables take some tenths of a second to compute. They are kept in the user's own cache folder
(`$XDG_CACHE_HOME/pn2code` or `~/.cache/pn2code`), named by a digest of the grammar. Without such a folder they are
computed anew.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lark import Lark


def kept_lark(name: str, grammar: str, **options: Any) -> Lark:
    """An LALR parser; `name` is the stem of its file in the cache."""
    from lark import Lark  # takes a while, and not every verb parses

    options = {"parser": "lalr", **options}
    folder = private_folder()
    if folder is None:
        return Lark(grammar, **options)
    shown = repr(
        sorted((k, repr(v)) for k, v in options.items() if isinstance(v, str | bool | list))
    )
    digest = hashlib.sha256(f"{grammar}\n{shown}".encode()).hexdigest()[:16]
    kept = folder / f"{name}-{digest}.lark"
    if kept.exists():
        return Lark(grammar, cache=str(kept), **options)
    temporary = _beside(kept)
    temporary.unlink()
    parser = Lark(grammar, cache=str(temporary), **options)
    if temporary.exists():
        temporary.replace(kept)
    return parser


def write_whole(path: Path, data: bytes) -> None:
    """Write a file of the cache so that no other process reads half of it."""
    temporary = _beside(path)
    temporary.write_bytes(data)
    temporary.replace(path)


def _beside(path: Path) -> Path:
    """A new file beside one that is to be replaced by it."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f"{path.stem}-", suffix=".tmp")
    os.close(handle)
    return Path(name)


def private_folder() -> Path | None:
    """A folder that only this user can write to, or None: a pickle must not come from anyone else."""
    try:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
        folder = base / "pn2code"
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = folder.stat()
    except (OSError, RuntimeError):
        return None
    if not hasattr(os, "getuid") or status.st_uid != os.getuid() or status.st_mode & 0o022:
        return None
    return folder if os.access(folder, os.W_OK) else None
