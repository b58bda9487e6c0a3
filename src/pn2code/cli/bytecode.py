"""Compiled modules, kept where Python itself may not keep them.

Python keeps compiled modules beside their sources. Where it must not (`PYTHONDONTWRITEBYTECODE`) or cannot (sources
of somebody else), each start of a command would compile a hundred modules again, which is half of the time of
checking a typical net. Then they are kept in the user's own cache folder instead, by Python's own rules: those of a
source that has changed are compiled anew. Python knows a source by its size and its time; whoever replaces it removes
what was compiled, but nobody does so in this folder. Images give all their files the same time, so here it counts, too,
when a file was put where it is.

This concerns pn2code's modules, and those of its libraries that were installed without compiled ones beside them
(`pip install --no-compile`); installed ones are used where they are.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from importlib.util import cache_from_source
from pathlib import Path
from types import CodeType, ModuleType
from zlib import crc32

from pn2code.base.private_folder import private_folder

_PACKAGE = Path(__file__).parents[1]


def keep() -> None:
    """Keep what is compiled from now on, if Python does not."""
    if any(isinstance(finder, _Finder) for finder in sys.meta_path):
        return
    if sys.dont_write_bytecode or not os.access(_PACKAGE, os.W_OK):
        folder = private_folder()
        if folder is not None:
            sys.meta_path.insert(0, _Finder(str(folder / "modules")))


class _Finder:
    """Finds pn2code's modules as Python does, but has them compiled into a folder."""

    def __init__(self, folder: str) -> None:
        self._folder = folder

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        spec = PathFinder.find_spec(name, path, target)
        if (
            spec is not None
            and type(spec.loader) is SourceFileLoader
            and (name.startswith("pn2code.") or not _is_compiled(spec))
        ):
            spec.loader = _Loader(name, spec.loader.path, self._folder)
        return spec


def _is_compiled(spec: ModuleSpec) -> bool:
    return spec.cached is not None and os.path.exists(spec.cached)  # noqa: PTH110 - for each module


class _Loader(SourceFileLoader):
    """Loads a module from its source or what was compiled from it."""

    def __init__(self, name: str, path: str, folder: str) -> None:
        super().__init__(name, path)
        self._folder = folder

    def path_stats(self, path: str) -> dict[str, int]:
        """What is kept with the compiled module, to know its source by."""
        status = os.stat(path)  # noqa: PTH116 - for each module
        known = f"{status.st_mtime_ns} {status.st_ctime_ns}".encode()
        return {"mtime": crc32(known), "size": status.st_size}

    def get_code(self, fullname: str) -> CodeType | None:
        set_before = sys.pycache_prefix, sys.dont_write_bytecode
        sys.pycache_prefix, sys.dont_write_bytecode = self._folder, False
        try:
            try:
                return super().get_code(fullname)
            except (EOFError, ValueError, TypeError):  # the file is damaged
                Path(cache_from_source(self.path)).unlink()
                return super().get_code(fullname)
        finally:
            sys.pycache_prefix, sys.dont_write_bytecode = set_before
