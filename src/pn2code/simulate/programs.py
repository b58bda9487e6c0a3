"""Compiled simulators, kept from one run to the next.

    with program(net, {}, d) as path:      # None after a diagnostic
        subprocess.run([path, "--steps", "100"])

A program is named by the SHA-256 of all that goes into it: the generated C, the C runtime, the compiler's own version,
its flags. It is built beside and renamed, so that processes that build the same at the same time do each other no harm,
and a full disk leaves nothing behind. The runtime is kept as a library of its own. Without a private cache folder, or
without room in it, everything is built in a temporary folder for the one run.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import pn2code
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.emission import c as emit_c
from pn2code.emission import runtime
from pn2code.emission.output import OutputFile
from pn2code.lowering import net as lower_net
from pn2code.net.flat import FlatNet
from pn2code.parser_cache import private_folder
from pn2code.simulate.codes import CACHE_UNUSABLE
from pn2code.toolchain.build import BUILD_FAILED, TOOL_MISSING, find_compiler, report_failure

FLAGS = ("-std=c11", "-O2", "-pipe", "-ffp-contract=off")
"""`-ffp-contract=off`: sums of products are rounded as in the token game, on every processor."""
ROOM = 1 << 14
"""Different tokens that a place can hold at first. What is not used costs address space only."""
MOST_PROGRAMS = 64
"""Programs that are kept; the ones that were not used for the longest time go first."""
_HOSTS = ("supervisor", "explore")
"""Sources of the runtime that belong to other hosts, by what their names begin with."""


@dataclass(frozen=True, slots=True)
class Compiler:
    """A C compiler.

    Args:
        command: what starts it, as a list.
        version: what it says of itself.
    """

    command: tuple[str, ...]
    version: str

    @staticmethod
    def find(d: Diagnostics) -> Compiler | None:
        """The compiler that is there; None after a diagnostic."""
        name = find_compiler()
        if name is not None:
            command = tuple(name.split())
            said = _run([*command, "--version"])
            if said is not None and said.returncode == 0:
                return Compiler(command, said.stdout)
        d.error(
            TOOL_MISSING,
            "a C compiler is not installed",
            Origin("simulate"),
            hint="on Debian or Ubuntu type: sudo apt-get install gcc libc6-dev; or use `--engine reference`",
        )
        return None


@contextmanager
def program(
    net: FlatNet, storage: Mapping[str, str], d: Diagnostics, *, room: int = ROOM
) -> Iterator[Path | None]:
    """The simulator of a net, as long as the block lasts; None after a diagnostic.

    Args:
        net: the net.
        storage: as for `Game`.
        d: gets the errors.
        room: different tokens that each place can hold.
    """
    compiler = Compiler.find(d)
    files = generated(net, storage, d, room) if compiler is not None else None
    if compiler is None or files is None:
        yield None
        return
    kept = private_folder()
    if kept is not None:
        found = _Builder(kept / "simulators", compiler, files).kept(d)
        if found is not None or d.has_errors:
            yield found
            return
    try:
        folder = tempfile.TemporaryDirectory(prefix="pn2code-")
    except OSError as problem:
        _no_room(problem, d)
        yield None
        return
    with folder as name:
        try:
            found = _Builder(Path(name), compiler, files).built(d)
        except OSError as problem:
            _no_room(problem, d)
            found = None
        yield found


def _no_room(problem: OSError, d: Diagnostics) -> None:
    d.error(
        BUILD_FAILED, f"there is no room to compile the net: {_reason(problem)}", Origin("simulate")
    )


def generated(
    net: FlatNet, storage: Mapping[str, str], d: Diagnostics, room: int = ROOM
) -> tuple[OutputFile, ...] | None:
    """net.c and net.h; None when the net cannot be compiled, which was reported."""
    partition = divide(net, None, d)
    if partition is None:
        return None
    ir = lower_net.lower(partition, storage, d, capacity={p.name: room for p in net.places})
    return None if ir is None or d.has_errors else emit_c.emit(ir, pn2code.__version__)


class _Builder:
    """Builds in a folder."""

    def __init__(self, folder: Path, compiler: Compiler, files: Sequence[OutputFile]) -> None:
        self.folder = folder
        self.compiler = compiler
        self.files = tuple(files)
        self.runtime = [f for f in runtime.emit() if not Path(f.path).name.startswith(_HOSTS)]
        tools = [*compiler.command, compiler.version, *FLAGS]
        self.library = folder / f"runtime-{_digest(tools, self.runtime)}.a"
        self.program = folder / f"simulate-{_digest(tools, [*self.runtime, *self.files])}"

    def kept(self, d: Diagnostics) -> Path | None:
        """The program from the cache, or built into it; None without room there, or after a diagnostic."""
        try:
            self.folder.mkdir(mode=0o700, exist_ok=True)
            if os.access(self.program, os.X_OK):
                os.utime(self.program)
                return self.program
            found = self.built(d)
            if found is not None:
                self._prune()
            return found
        except OSError as problem:
            d.warning(
                CACHE_UNUSABLE,
                f"the compiled net cannot be kept: {_reason(problem)}",
                Origin(str(self.folder)),
                hint="it is compiled for this run only",
            )
            return None

    def built(self, d: Diagnostics) -> Path | None:
        """The program, built now; None after a diagnostic.

        Raises:
            OSError: there is no room.
        """
        with tempfile.TemporaryDirectory(prefix="build-", dir=self.folder) as name:
            room = Path(name)
            for f in (*self.runtime, *self.files):
                path = room / f.path
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(f.text, encoding="utf-8")
            with ThreadPoolExecutor(2) as pool:
                library = pool.submit(self._library, room, d)
                net = self._compile(room, "net.c", d)
                if not library.result() or not net:
                    return None
            made = room / "simulate"
            done = self._compiler(room, "-o", made.name, "net.o", str(self.library), "-lm", d=d)
            if not done:
                return None
            made.replace(self.program)
        return self.program

    def _library(self, room: Path, d: Diagnostics) -> bool:
        """The runtime with the simulator's own parts."""
        if self.library.exists():
            with suppress(OSError):
                os.utime(self.library)
            return True
        sources = [f.path for f in self.runtime if f.path.endswith(".c")]
        objects = [f"{Path(s).stem}.o" for s in sources]
        if not self._compiler(room, "-Iruntime/include", "-c", *sources, d=d):
            return False
        made = room / "runtime.a"
        archiver = shutil.which("ar")
        done = _run([archiver or "ar", "rcs", made.name, *objects], room)
        if done is None or done.returncode != 0:
            said = "`ar` is not installed" if done is None else done.stderr.strip()
            d.error(
                BUILD_FAILED, f"the C runtime cannot be put together: {said}", Origin("simulate")
            )
            return False
        made.replace(self.library)
        return True

    def _compile(self, room: Path, source: str, d: Diagnostics) -> bool:
        return self._compiler(room, "-Iruntime/include", "-I.", "-c", source, d=d)

    def _compiler(self, room: Path, *arguments: str, d: Diagnostics) -> bool:
        done = _run([*self.compiler.command, *FLAGS, *arguments], room)
        if done is not None and done.returncode == 0:
            return True
        said = done.stderr if done is not None else "the compiler cannot be started"
        if "No space left on device" in said:
            raise OSError(28, "no space left on device")
        report_failure(
            room, said, self.files, "`pn2code generate` and `make` show everything it says", d
        )
        return False

    def _prune(self) -> None:
        """Forgets the programs that were used least recently. Another process may do the same."""
        used: list[tuple[float, Path]] = []
        for path in self.folder.glob("simulate-*"):
            with suppress(OSError):
                used.append((path.stat().st_mtime, path))
        for _, path in sorted(used, reverse=True)[MOST_PROGRAMS:]:
            with suppress(OSError):
                path.unlink()


def _digest(tools: Sequence[str], files: Sequence[OutputFile]) -> str:
    found = hashlib.sha256()
    for part in (*tools, *(text for f in files for text in (f.path, f.text))):
        data = part.encode("utf-8", "surrogateescape")
        found.update(f"{len(data)}:".encode())
        found.update(data)
    return found.hexdigest()[:32]


def _run(
    command: Sequence[str], folder: Path | None = None
) -> subprocess.CompletedProcess[str] | None:
    """Runs a tool to its end; None when it is not there."""
    try:
        return subprocess.run(
            command,
            cwd=folder,
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
            env={**os.environ, "LC_ALL": "C"},
        )
    except OSError:
        return None


def _reason(problem: OSError) -> str:
    return (problem.strerror or str(problem)).lower()
