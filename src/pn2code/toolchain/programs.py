"""Compiled programs of nets, kept from one run to the next: a host of the runtime (simulator, explorer) with a net.

    with program(Host("simulate"), files, d) as path:      # None after a diagnostic
        subprocess.run([path, "--steps", "100"])

A program is named by the SHA-256 of all that goes into it: the generated C, the C runtime, the compiler's own version,
its flags. It is built beside and renamed, so that processes that build the same at the same time do each other no harm,
and a full disk leaves nothing behind. Beside it is the SHA-256 of what was built (`.sum`): a program that has become
another one, as a power failure may leave it, would answer anything, and is built again. The runtime is kept as a
library of its own. Without a private cache folder, or without room in it, everything is built in a temporary folder
that goes with the process.
"""

from __future__ import annotations

import atexit
import errno
import os
import shlex
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from fnmatch import fnmatch
from functools import cache, lru_cache
from pathlib import Path

from pn2code.base.frozen import frozen, replace
from pn2code.base.os_reason import os_reason
from pn2code.base.private_folder import private_folder, without_folder
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.codes import register
from pn2code.emission import c_flags, runtime
from pn2code.emission.output import OutputFile
from pn2code.toolchain.build import (
    BUILD_FAILED,
    TOOL_MISSING,
    WITHOUT_ROOT,
    find_archiver,
    find_compiler,
    report_failure,
)
from pn2code.toolchain.kept_files import (
    digest,
    digest_of_runtime,
    is_sound,
    keep,
    note_use,
    put,
    sum_of,
)
from pn2code.toolchain.tool_runs import LOOK_S, BuildInterruptedError, never, run_tool

CACHE_UNUSABLE = register(
    "program-cache",
    "compiled nets cannot be kept",
    "Compiled nets are kept in `$XDG_CACHE_HOME/pn2code` or `~/.cache/pn2code`, so that a second run starts at once. "
    "There is no room, the folder cannot be written to, or it is not yours alone: the net is compiled for this run "
    "only. Set XDG_CACHE_HOME to a folder of your own.",
)

FLAGS = (c_flags.STANDARD, "-O2", "-pipe", *c_flags.FLOATS)
"""For all that is compiled here: what decides about the results is what the generated Makefile has, too."""
MOST_PROGRAMS = 64
"""Programs of a host that are kept; the ones that were not used for the longest time go first."""
STALE_S = 6 * 3600.0
"""After that a folder in which something is built belongs to a process that was killed."""
_BUILDS = "build-"
_RUNTIME = "runtime/src"


@frozen
class Host:
    """What is linked with a net.

    Args:
        name: the beginning of its sources' names, of its programs', and what diagnostics call it.
        flags: for the C compiler, added to `FLAGS`.
        own: those for the host's own sources alone, after the others, not for what computes the values of a net.
        net: those for the net alone, after the others; the runtime is compiled without them.
        libraries: for the linker.
        without: what to do without a C compiler, the end of a sentence.
        whole: a source of the host that can have the net as a part of itself (PN_NET_SOURCE); "" if there is none.
        also: hosts whose sources it has, too.
        instead: names of sources that are left out, since the host has others in their place.
        only: patterns for the names of all sources that it needs, if it does without most; () for all.
    """

    name: str
    flags: tuple[str, ...] = ()
    own: tuple[str, ...] = ()
    net: tuple[str, ...] = ()
    libraries: tuple[str, ...] = ("-lm",)
    without: str = ""
    whole: str = ""
    also: tuple[str, ...] = ()
    instead: tuple[str, ...] = ()
    only: tuple[str, ...] = ()

    def with_room(self, values: int) -> Host:
        """With room for so many values in a message."""
        return replace(self, flags=(*self.flags, *c_flags.for_messages(values)))

    def runtime(self) -> tuple[OutputFile, ...]:
        """The C runtime as this host needs it."""
        found = runtime.emit(self.name, *self.also)
        return tuple(f for f in found if self._needs(f.path.rpartition("/")[2]))

    def _needs(self, name: str) -> bool:
        is_wanted = not self.only or name.endswith(".h") or any(fnmatch(name, p) for p in self.only)
        return is_wanted and name not in self.instead


@frozen
class Compiler:
    """A C compiler.

    Args:
        command: what starts it, as a list.
        version: what it says of itself.
    """

    command: tuple[str, ...]
    version: str

    @staticmethod
    def find(host: Host, d: Diagnostics) -> Compiler | None:
        """The compiler that is there; None after a diagnostic."""
        name = find_compiler()
        if name is not None:
            command = (*shlex.split(name), *c_flags.for_compiler(name))
            with suppress(OSError):
                return Compiler(command, _version(command, os.environ.get("PATH", "")))
        d.error(
            TOOL_MISSING,
            "a C compiler is not installed",
            Origin(host.name),
            hint=f"on Debian or Ubuntu type: sudo apt-get install gcc libc6-dev; {WITHOUT_ROOT}{host.without}",
        )
        return None


@lru_cache(maxsize=8)
def _version(command: tuple[str, ...], _path: str) -> str:
    """What a compiler that is found on this path says of itself. It is asked once: a command needs several programs.

    Raises:
        OSError: it says nothing; the next time it is asked again.
    """
    said = run_tool([*command, "--version"])
    if said is None or said.returncode != 0:
        raise OSError(errno.ENOEXEC, "no compiler")
    return said.stdout


@contextmanager
def program(
    host: Host,
    files: Sequence[OutputFile],
    d: Diagnostics,
    *,
    interrupted: Callable[[], bool] = never,
) -> Iterator[Path | None]:
    """A host with a net, as long as the block lasts; None after a diagnostic, or when it was interrupted.

    Args:
        host: what is linked with the net.
        files: net.c and net.h, or whatever else is generated for the host.
        d: gets the errors.
        interrupted: asked while compilers run: they are ended when it says so.
    """
    compiler = Compiler.find(host, d)
    if compiler is None:
        yield None
        return
    kept = private_folder()
    if kept is not None:
        try:
            found = _Builder(kept / "programs", host, compiler, files, interrupted).kept(d)
        except BuildInterruptedError:
            yield None
            return
        if found is not None or d.has_errors:
            yield found
            return
    else:
        _not_kept(without_folder(), Origin(host.name), d)
    found = None
    try:
        builder = _Builder(_for_this_run(), host, compiler, files, interrupted)
        found = builder.program if builder.is_there() else builder.built(d)
    except OSError as problem:
        _no_room(host, problem, d)
    except BuildInterruptedError:
        pass
    yield found


@cache
def _for_this_run() -> Path:
    """A folder that lasts as long as the process: many a command needs several programs, all with one runtime.

    Raises:
        OSError: there is no room for it.
    """
    folder = tempfile.TemporaryDirectory(prefix="pn2code-")
    atexit.register(folder.cleanup)
    return Path(folder.name)


def net_flags(host: Host, compiler: Compiler, generated: str) -> tuple[str, ...]:
    """What a compiler is told about this C of a net, after `FLAGS` and those of the host."""
    is_large = c_flags.is_large(generated)
    own = c_flags.for_large_nets(compiler.version) if is_large else ()
    return (*c_flags.for_net(generated), *own, *host.net)


def is_kept(host: Host, files: Sequence[OutputFile]) -> bool:
    """Whether the program has been built and kept."""
    kept, compiler = private_folder(), Compiler.find(host, Diagnostics())
    if kept is None or compiler is None:
        return False
    return _Builder(kept / "programs", host, compiler, files, never).is_there()


def _not_kept(why: str, origin: Origin, d: Diagnostics) -> None:
    """Said once, however many programs a command needs."""
    if all(said.code != CACHE_UNUSABLE for said in d):
        d.warning(
            CACHE_UNUSABLE,
            f"the compiled net cannot be kept: {why}",
            origin,
            hint="it is compiled for this run only; XDG_CACHE_HOME says where compiled nets are kept",
        )


def _no_room(host: Host, problem: OSError, d: Diagnostics) -> None:
    d.error(
        BUILD_FAILED,
        f"there is no room to compile the net: {os_reason(problem)}",
        Origin(host.name),
    )


class _Builder:
    """Builds in a folder."""

    def __init__(
        self,
        folder: Path,
        host: Host,
        compiler: Compiler,
        files: Sequence[OutputFile],
        interrupted: Callable[[], bool],
    ) -> None:
        self._is_enough = interrupted
        self._is_given_up = False
        self.folder = folder
        self.host = host
        self.flags = (*FLAGS, *host.flags)
        self.compiler = compiler
        self.files = tuple(files)
        self.runtime = host.runtime()
        tools = [*compiler.command, compiler.version, *self.flags, *host.libraries]
        tools += ["own", *host.own] if host.own else []
        tools += ["runtime", digest_of_runtime(self.runtime)]
        self.library = folder / f"{host.name}-runtime-{digest(tools)}.a"
        generated = "".join(f.text for f in self.files)
        self.is_large = c_flags.is_large(generated)
        self.net_flags = net_flags(host, compiler, generated)
        tools += ["net", *self.net_flags] if self.net_flags else []
        self.program = folder / f"{host.name}-{digest(tools, self.files)}"

    def is_there(self) -> bool:
        """Whether the program has been built."""
        return os.access(self.program, os.X_OK) and is_sound(self.program)

    def kept(self, d: Diagnostics) -> Path | None:
        """The program from the cache, or built into it; None without room there, or after a diagnostic."""
        try:
            self.folder.mkdir(mode=0o700, exist_ok=True)
            if self.is_there():
                note_use(self.program)
                return self.program
            found = self.built(d)
            if found is not None:
                self._prune()
            return found
        except OSError as problem:
            _not_kept(os_reason(problem), Origin(str(self.folder)), d)
            return None

    def built(self, d: Diagnostics) -> Path | None:
        """The program, built now; None after a diagnostic.

        Raises:
            OSError: there is no room.
        """
        with tempfile.TemporaryDirectory(prefix=_BUILDS, dir=self.folder) as name:
            room = Path(name)
            # Sources of the runtime are a library already, mostly: they are written where they are compiled.
            put(room, [f for f in self.runtime if not self._is_of_library(f)])
            put(room, self.files)
            with ThreadPoolExecutor(2) as pool:
                library = pool.submit(self._library, room, d)
                try:
                    net = self._net(room, d)
                    # A signal that comes just before a thread waits without an end is heard only after that.
                    while wait([library], LOOK_S).not_done:
                        pass
                    if not library.result() or not net:
                        return None
                except BaseException:
                    self._is_given_up = True  # no tool works on in a folder that is removed
                    raise
            made = room / "program"
            own = [f"{Path(f.path).stem}.o" for f in self._sources()]
            parts = [*own, str(self.library), *self.host.libraries]
            done = self._compiler(room, "-o", made.name, *parts, d=d)
            if not done:
                return None
            keep(made, self.program)
        return self.program

    def _library(self, room: Path, d: Diagnostics) -> bool:
        """The runtime with the host's own parts."""
        if is_sound(self.library):
            with suppress(OSError):
                note_use(self.library)
            return True
        # A build that is given up leaves what it has compiled to the next one, which gets further.
        done_before = self.folder / f"{_BUILDS}{self.library.stem}"
        done_before.mkdir(mode=0o700, exist_ok=True)
        try:
            is_made = self._made(room, done_before, d)
        finally:
            with suppress(OSError):
                done_before.rmdir()  # where there is nothing in it
        if is_made:
            shutil.rmtree(done_before, ignore_errors=True)
        return is_made

    def _made(self, room: Path, done_before: Path, d: Diagnostics) -> bool:
        """The library, of objects that were there before and of others."""
        compiled_here = [f for f in self.runtime if f.path.endswith(".c")]
        put(room, [f for f in self.runtime if self._is_of_library(f)])
        sources = [f.path for f in compiled_here]
        objects = [f"{Path(s).stem}.o" for s in sources]
        # Large ones first, so that all processors are busy to the end.
        sources.sort(key=lambda name: -(room / name).stat().st_size)

        def compiled(source: str) -> bool:
            made, kept = (where / f"{Path(source).stem}.o" for where in (room, done_before))
            with suppress(OSError):
                os.link(kept, made)
                return True
            own = self.host.own if self._is_own(source) else ()
            if not self._compiler(room, *own, "-Iruntime/include", "-c", source, d=d):
                return False
            # Not where there is no room, or no links on this disk, or another process was as quick.
            with suppress(OSError):
                os.link(made, kept)
            return True

        with ThreadPoolExecutor(max(os.cpu_count() or 1, 1)) as pool:
            if not all(list(pool.map(compiled, sources))):
                return False
        made = room / "runtime.a"
        archiver = find_archiver() or ("ar",)
        done = run_tool([*archiver, "rcs", made.name, *objects], room, self.interrupted)
        if done is None or done.returncode != 0:
            said = "`ar` is not installed" if done is None else done.stderr.strip()
            d.error(
                BUILD_FAILED,
                f"the C runtime cannot be put together: {said}",
                Origin(self.host.name),
            )
            return False
        keep(made, self.library)
        return True

    def interrupted(self) -> bool:
        """Whether compilers that run are to be ended."""
        return self._is_given_up or self._is_enough()

    def _is_whole(self, source: OutputFile) -> bool:
        return source.path == f"{_RUNTIME}/{self.host.whole}"

    def _is_of_library(self, file: OutputFile) -> bool:
        """Whether only the runtime reads it; a source that has the net as a part of itself reads its headers, too."""
        if file.path.endswith(".c"):
            return not self._is_whole(file)
        return not self.host.whole and file.path.startswith(f"{_RUNTIME}/")

    def _is_own(self, source: str) -> bool:
        return Path(source).name.startswith(self.host.name)

    def _net(self, room: Path, d: Diagnostics) -> bool:
        """net.o: the net in one piece with the host's source that calls it, or alone.

        In one piece it is several times as fast, and takes longer to compile; a large net is compiled alone. Should a
        name of the net be one that the host has too, they are compiled apart: the library has that source as well.
        """
        includes = (*self.net_flags, "-Iruntime/include", "-I.")
        others = [f.path for f in self._sources() if f.path != "net.c"]
        # One a call: of several sources `zig cc` makes one object only.
        if not all(self._compiler(room, *includes, "-c", source, d=d) for source in others):
            return False
        if len(others) == len(self._sources()):
            return True  # a host that needs no net
        if self.host.whole and not self.is_large:
            source = f"{_RUNTIME}/{self.host.whole}"
            whole = ('-DPN_NET_SOURCE="net.c"', "-c", source, "-o", "net.o")
            if self._compiler(room, *includes, *whole, d=Diagnostics()):
                return True
        return self._compiler(room, *includes, "-c", "net.c", d=d)

    def _sources(self) -> list[OutputFile]:
        """What is compiled besides the runtime."""
        return [f for f in self.files if f.path.endswith(".c")]

    def _compiler(self, room: Path, *arguments: str, d: Diagnostics) -> bool:
        done = run_tool([*self.compiler.command, *self.flags, *arguments], room, self.interrupted)
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
        for path in self.folder.glob(f"{self.host.name}-[0-9a-f]*[0-9a-f]"):
            if path.suffix:
                continue  # the runtime
            with suppress(OSError):
                used.append((path.stat().st_mtime, path))
        for _, path in sorted(used, reverse=True)[MOST_PROGRAMS:]:
            for each in (path, sum_of(path)):
                with suppress(OSError):
                    each.unlink()
        for path in self.folder.glob(f"{_BUILDS}*"):
            with suppress(OSError):
                if time.time() - path.stat().st_mtime > STALE_S:
                    shutil.rmtree(path, ignore_errors=True)
