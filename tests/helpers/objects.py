"""The runtime's object files of generated folders, compiled once for all tests that build a cell the same way.

A generated folder has the whole runtime with it, so that `make` compiles some thirty files that are the same in each
folder. None of them includes what is generated (`unit/tools/test_objects.py`): they depend on the runtime's own text,
on the rules of the Makefile, the compiler and the flags. Where all of these are the same, `make` finds the object files
of an earlier build in place, newer than their sources; what is generated it compiles itself.
"""

from __future__ import annotations

import hashlib
import os
import shlex
import shutil
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.toolchain.build import find_compiler

Build = Callable[..., Path | None]
FLAGS = ("CFLAGS", "SANITIZE", "LDFLAGS", "CC", "MAKEFLAGS", "CPATH", "C_INCLUDE_PATH")
"""What `make` and compilers look up in the environment."""


class Objects:
    """`toolchain.build.build`, which compiles the runtime once.

    Args:
        build: what builds.
        folder: where object files are kept, for all workers.
    """

    def __init__(self, build: Build, folder: Path) -> None:
        self._build = build
        self._folder = folder

    def __call__(
        self, folder: Path, files: Iterable[OutputFile], d: Diagnostics, **options: str
    ) -> Path | None:
        files = tuple(files)
        kept = self._folder / key(folder)
        put(kept, folder)
        made = self._build(folder, files, d, **options)
        if made is not None:
            keep(kept, folder)
        return made


def put(kept: Path, folder: Path) -> None:
    """The object files that are known, where `make` looks for them."""
    if kept.is_dir():
        for part in kept.rglob("*.o"):
            target = folder / part.relative_to(kept)
            if not target.exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(part, target)  # newer than the sources


def keep(kept: Path, folder: Path) -> None:
    """Those that are new; several workers may do this at the same time."""
    for part in sorted(folder.glob("build/**/runtime/**/*.o")):
        target = kept / part.relative_to(folder)
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile(dir=target.parent, delete=False) as room:
                room.write(part.read_bytes())
            Path(room.name).replace(target)


def key(folder: Path) -> str:
    """The name of all that goes into the object files of a generated folder."""
    rules = (folder / "Makefile").read_text(encoding="utf-8").splitlines()
    compiler = find_compiler() or ""
    found = shutil.which(shlex.split(compiler)[0]) if compiler else None
    parts = [repr((compiler, found)), *(f"{name}={os.environ.get(name)}" for name in FLAGS)]
    parts += [line for line in rules if not line.startswith("#")]
    for file in sorted((folder / "runtime").rglob("*.[ch]")):
        parts += [str(file.relative_to(folder)), file.read_text(encoding="utf-8")]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:32]
