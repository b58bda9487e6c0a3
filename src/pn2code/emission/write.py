"""Writing an output folder: all or nothing, unchanged files untouched (so that `make` rebuilds only what changed)."""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.os_reason import os_reason
from pn2code.emission.manifest import NAME as MANIFEST
from pn2code.emission.output import OutputFile


@frozen
class Written:
    """What writing did (or, with `check`, would do): relative paths."""

    changed: tuple[str, ...]
    removed: tuple[str, ...]


class OutputFolderError(Exception):
    """The folder cannot be written, or holds something that is not ours; the message says what to do."""


def expect_writable(folder: Path) -> None:
    """Finds out that a folder cannot be written before the work is done that would fill it; leaves nothing behind.

    Raises:
        OutputFolderError: not writable, or not a folder.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputFolderError(f"`{folder}` is not a folder; give another one with -o")
    created = [p for p in (folder, *folder.parents) if not p.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as problem:
        raise OutputFolderError(
            f"cannot write `{folder}`: {os_reason(problem)}; nothing was changed"
        ) from problem
    finally:
        with suppress(OSError):  # not made
            for made in created:
                made.rmdir()


def write(folder: Path, files: Iterable[OutputFile], *, check: bool = False) -> Written:
    """Writes the files into `folder`.

    Everything is first written beside it and then moved into place, so that a full disk leaves the
    old files as they were. Files of
    an earlier generation that are no longer produced are removed; files that pn2code did not write are left alone.

    Raises:
        OutputFolderError: not writable, full, or not a folder.
    """
    files = list(files)
    new = {f.path: f.text.encode("utf-8") for f in files}
    if folder.exists() and not folder.is_dir():
        raise OutputFolderError(f"`{folder}` is not a folder; give another one with -o")
    for path in new:
        if (folder / path).is_dir():
            raise OutputFolderError(
                f"`{folder / path}` is a folder, but a file belongs there; nothing was changed"
            )
    try:
        changed = [path for path, data in new.items() if _differs(folder / path, data)]
        removed = [p for p in _previous(folder) if p not in new and (folder / p).is_file()]
        if not check:
            _replace(folder, {path: new[path] for path in changed}, removed)
    except OSError as problem:
        raise OutputFolderError(
            f"cannot write `{folder}`: {os_reason(problem)}; nothing was changed"
        ) from problem
    return Written(tuple(sorted(changed)), tuple(sorted(removed)))


def _differs(path: Path, data: bytes) -> bool:
    try:
        return path.read_bytes() != data
    except FileNotFoundError:
        return True


def _previous(folder: Path) -> list[str]:
    """The files that the manifest of an earlier generation lists."""
    try:
        listed = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["files"]
        return [
            p
            for p in listed
            if isinstance(p, str) and not Path(p).is_absolute() and ".." not in Path(p).parts
        ]
    except (FileNotFoundError, ValueError, KeyError, TypeError):
        return []


def _replace(folder: Path, changed: dict[str, bytes], removed: list[str]) -> None:
    if not changed and not removed:
        return
    created = [p for p in (folder, *folder.parents) if not p.exists()]
    staging: Path | None = None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        staging = Path(tempfile.mkdtemp(prefix=".pn2code-", dir=folder))
        for path, data in changed.items():
            target = staging / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(data)
        for path in changed:
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
        for path in changed:
            (staging / path).replace(folder / path)
        for path in removed:
            (folder / path).unlink()
    except BaseException:  # also when interrupted
        if staging is not None:
            shutil.rmtree(staging, ignore_errors=True)
        with suppress(OSError):  # not there, or not empty: somebody else's
            for made in created:
                made.rmdir()
        raise
    shutil.rmtree(staging, ignore_errors=True)
