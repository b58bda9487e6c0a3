"""Whatever the tests compile a second time, from the same sources in the same way, is a copy of the first object.

Most of what is compiled is the C runtime, for one program after the other. So there is a program in front of the
compiler, under its name, that remembers objects; `remembering_cc.c` says on what an object depends. `./dev test` keeps
them in the folder of the environment, for the next run: most nets do not change either. Otherwise they are kept for one
run of the tests. In a new environment, as in `.ci/run`, all is compiled.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

import pytest

from pn2code.emission.c_flags import STANDARD
from pn2code.emission.environment import c_string

KEPT = "PN2CODE_TEST_OBJECTS"
"""The variable with the folder where objects are kept from one run to the next."""
SOURCE = Path(__file__).with_suffix(".c")
NAMES = ("cc", "gcc", "clang", "aarch64-linux-gnu-gcc")
"""The first that is there compiles the program; tests compile the same runtime with each of them."""
MOST_BYTES = 1 << 30
"""Of objects that are kept; the ones that were not used for the longest time go first."""
_FLAGS = (STANDARD, "-O2", "-Wall", "-Wextra", "-Werror")
_SECONDS_LONG_AGO = 3600.0
_NATIVE = ("-march=native", "-###", "-S", "-o", "-", "-x", "c", os.devnull)
"""To this a compiler says for which processor it would compile."""


def made(folder: Path, store: Path) -> Path | None:
    """The folder with the programs that go in front of the compilers; None where there is none of them.

    Args:
        folder: is made, with the programs in it.
        store: where objects are kept.
    """
    found = {name: path for name in NAMES if (path := shutil.which(name))}
    if not found:
        return None
    store.mkdir(parents=True, exist_ok=True)
    folder.mkdir(exist_ok=True)
    compilers = ", ".join(
        ", ".join(map(c_string, (name, path, _same(path, found.values()))))
        for name, path in found.items()
    )
    what = {
        "COMPILERS": compilers,
        "VERSION": c_string(_version(found.values())),
        "STORE": c_string(str(store.resolve())),
    }
    program = folder / "remembering-cc"
    words = [f"-D{name}={text}" for name, text in what.items()]
    compiler = next(iter(found.values()))
    subprocess.run([compiler, *_FLAGS, *words, str(SOURCE), "-o", str(program)], check=True)
    for name in found:
        (folder / name).hardlink_to(program)
    return folder


def _same(compiler: str, compilers: Iterable[str]) -> str:
    """The first that is the same program and says the same of itself: `cc` is most often another name of `gcc`.

    What goes by several names may do as it is called (`ccache`), so the program alone does not decide.
    """

    def identity(path: str) -> tuple[Path, str]:
        # It begins with the name by which it was called.
        return Path(path).resolve(), _said(path, "--version").partition(" ")[2]

    own = identity(compiler)
    return next(path for path in compilers if identity(path) == own)


def _version(compilers: Iterable[str]) -> str:
    """What they are: an object of one that was installed anew, or for another machine, is another one."""
    parts = []
    for compiler in sorted(set(compilers)):
        said = _said(compiler, "--version")
        for program in (
            compiler,
            *(_said(compiler, f"-print-prog-name={n}") for n in ("cc1", "as")),
        ):
            path = Path(shutil.which(program.strip()) or program.strip()).resolve()
            about = path.stat() if path.exists() else None
            parts.append(f"{path} {about and (about.st_size, about.st_mtime_ns)} {said}")
        parts.append(_said(compiler, *_NATIVE, at=os.sep))  # clang names the folder
    return "\n".join(parts)


def _said(*command: str, at: str | None = None) -> str:
    """What a program prints; a compiler says on the other stream what it would do."""
    done = subprocess.run(command, cwd=at, capture_output=True, text=True, check=False)
    return done.stdout or done.stderr


def use(
    changed: pytest.MonkeyPatch, common: Path, once: Callable[[str, Callable[[Path], object]], Path]
) -> None:
    """Puts the programs in front of PATH.

    Args:
        changed: patches PATH.
        common: the folder of the session.
        once: makes a folder of that name, for all workers.
    """
    kept = os.environ.get(KEPT)
    store = Path(kept) if kept else common / "remembered"

    def make(folder: Path) -> None:
        made(folder, store)
        prune(store)

    folder = once("remembering-cc", make)
    if folder.is_dir():
        changed.setenv("PATH", str(folder), prepend=os.pathsep)


def prune(store: Path, most: int = MOST_BYTES) -> None:
    """Removes what was not used for the longest time, and what a process has left that was killed."""
    files = []
    for path in store.glob("*"):
        with suppress(OSError):
            about = path.stat()
            files.append((about.st_mtime, about.st_size, path))
    room = most
    for used, size, path in sorted(files, key=lambda file: file[0], reverse=True):
        room -= size
        is_left = path.suffix not in (".o", ".files") and time.time() - used > _SECONDS_LONG_AGO
        if room < 0 or is_left:
            path.unlink(missing_ok=True)
