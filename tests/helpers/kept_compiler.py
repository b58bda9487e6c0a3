"""The C compiler as the tests see it: what one of them has compiled, the others need not compile again (kept_cc.c).

    with kept(folder):                 # processes that share the folder share the object files
        subprocess.run(["gcc", "-O2", "-c", "a.c"])

Most tests compile the same runtime beside their own net. The commands `cc` and `gcc` that are found in PATH keep their
object files, by the hash of what goes into them; what comes out is the compiler's.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SOURCE = Path(__file__).with_name("kept_cc.c")
NAMES = ("cc", "gcc")


@contextmanager
def kept(folder: Path) -> Iterator[None]:
    """As long as the block lasts; nothing changes where there is no compiler, or no /proc."""
    real = {name: _real(path) for name in NAMES if (path := shutil.which(name))}
    if not real or not Path("/proc/self/exe").exists():
        yield
        return
    commands, objects = folder / "commands", folder / "objects"
    with (folder.parent / f"{folder.name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not commands.exists():
            _make(folder, real)
    own = {"PATH": f"{commands}:{os.environ['PATH']}", "KEPT_OBJECTS": str(objects)}
    before = {name: os.environ.get(name) for name in own}
    os.environ.update(own)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _real(path: str) -> str:
    """The compiler itself, also within another such block."""
    link = Path(path).parent.parent / "real" / Path(path).name
    return str(link.readlink()) if link.is_symlink() else path


def _make(folder: Path, real: dict[str, str]) -> None:
    for name in ("made", "objects", "real"):
        (folder / name).mkdir(parents=True)
    program = folder / "program"
    compiler, *_ = real.values()
    command = [compiler, "-std=gnu11", "-O1", str(SOURCE), "-o", str(program)]
    subprocess.run(command, check=True)
    for name, path in real.items():
        (folder / "real" / name).symlink_to(path)
        shutil.copy(program, folder / "made" / name)
    (folder / "made").rename(folder / "commands")


@contextmanager
def as_it_stands() -> Iterator[None]:
    """Everything is compiled, as without `kept`: for tests that look at compiling itself."""
    objects = os.environ.pop("KEPT_OBJECTS", None)
    try:
        yield
    finally:
        if objects is not None:
            os.environ["KEPT_OBJECTS"] = objects
