"""Supervisors compiled to count which of their branches are taken, and what runs of them have taken so far.

lab = Lab(root, folder)
done = lab.run("odd", orders=3, failing="openat:2:24")     # code, out, err, and the shared directory
lab.taken()                                                # figures, by file and line (tools.coverage)

`rivet` is the deployed supervisor of the riveting cell, `rivet.traced` the traced one; `odd` is a cell that does what
it is told (`cnative/tests/odd_net.c`), and `odd.deployed` the same without a trace; further ones are made with options.
`supervisor/`, `channel/` and `port/` are compiled with `--coverage` and without optimization, everything else without.
"""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import zlib
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tools.coverage import Files, collect

from pn2code.emission import c_flags
from pn2code.run.supervisor import SupervisorProcess

COUNTED = ("supervisor", "channel", "port")
DEADLINE_S = 600.0  # ends what hangs


@dataclass(frozen=True, slots=True)
class Done:
    """A program that has ended.

    Args:
        code: its exit code; negative: the signal that killed it.
        out: what it printed.
        err: its messages.
        shared: the directory that it was given.
        reached: whether a call came that was to fail.
    """

    code: int
    out: str
    err: str
    shared: Path
    reached: bool = False

    @property
    def error(self) -> str:
        """Its one error."""
        (found,) = [line for line in self.err.splitlines() if line.startswith("error: ")]
        return found.removeprefix("error: ")

    def stopped(self, code: int, *words: str) -> Done:
        """It has stopped safely: with this code, for a reason with these words, and no file is torn."""
        assert self.code == code, self
        for word in words:
            assert word in self.error, self
        assert_whole(self.shared)
        status = self.shared / "supervisor.status"
        if status.is_file() and status.stat().st_size > 0:
            lines = status.read_text().splitlines()
            assert lines[0] in ("stopped", "running"), (lines, self)
            if lines[0] == "stopped":
                assert self.error[:150].startswith(lines[2][:150]), (lines, self)
        return self

    def finished(self) -> Done:
        """It has come to its end."""
        assert self.code == 0 and "error: " not in self.err, self
        assert_whole(self.shared)
        status = self.shared / "supervisor.status"
        assert not status.is_file() or status.read_text().startswith("finished\n"), self
        return self


def assert_whole(shared: Path) -> None:
    """No temporary file is left, and each channel is empty or holds a whole message."""
    for file in shared.glob("*") if shared.is_dir() else ():
        assert not file.name.endswith(".tmp")
        if file.suffix == ".robcad" and file.is_file():
            text = file.read_text("latin-1")
            assert text == "0\n" or (text.count("\n") == 2 and "\n# " in text), (file, text)
    if shared.is_dir():
        assert list(shared.glob(".*.supervisor.tmp")) == []


class Lab:
    """Programs and what they have done.

    Args:
        root: of the project.
        folder: an empty one, for all that is made.
    """

    def __init__(self, root: Path, folder: Path) -> None:
        self.root = root
        self._native = root / "cnative"
        self._store = folder / "counted"
        self._plain = folder / "plain"
        self._programs = folder / "programs"
        self._runs = folder / "runs"
        for made in (self._store, self._plain, self._programs, self._runs):
            made.mkdir()
        self._count = 0
        self._sources = {p.stem: p for p in (self._native / "src").glob("*/*.c")}
        self._make_objects()
        self.preloaded = self._programs / "failing.so"
        command = ["gcc", "-shared", "-fPIC", "-O1", "-fno-builtin", "-Wall", "-Werror"]
        run(*command, self._native / "tests" / "failing.c", "-o", self.preloaded, "-ldl")

    # --- compiling ---

    def _make_objects(self) -> None:
        """The runtime, once; the supervisor as it is deployed, and traced."""
        names = [n for n in self._sources if n.startswith(("pn_", "port_", "supervisor"))]
        jobs: list[tuple[Path, Path, tuple[str, ...]]] = []
        for name in names:
            source = self._sources[name]
            if source.parent.name not in COUNTED:
                jobs.append((source, self._plain / f"{name}.o", ()))
                continue
            for kind, flags in KINDS.items() if source.parent.name == "supervisor" else (("", ()),):
                jobs.append((source, self._counted(name, kind), ("--coverage", *flags)))
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(lambda job: self.compile(job[0], job[1], *job[2]), jobs))

    def _counted(self, name: str, kind: str = "") -> Path:
        return self._store / f"{name}{kind}" / f"{name}.o"

    def compile(self, source: Path, made: Path, *flags: str) -> Path:
        """An object file."""
        made.parent.mkdir(parents=True, exist_ok=True)
        include = ["-I", self._native / "include", "-I", source.parent]
        command = ["gcc", c_flags.STANDARD, *c_flags.FLOATS, "-O0", *include, *flags]
        run(*command, "-c", source, "-o", made)
        return made

    def host(self, kind: str = "") -> list[Path]:
        """The objects of a supervisor but for its net and cell; `kind`: "" or ".traced"."""
        return [
            self._counted(n, kind if p.parent.name == "supervisor" else "")
            if p.parent.name in COUNTED
            else self._plain / f"{n}.o"
            for n, p in self._sources.items()
            if n.startswith(("pn_", "port_", "supervisor"))
        ]

    def link(self, name: str, objects: Iterable[Path]) -> Path:
        """A program."""
        made = self._programs / name
        run("gcc", "--coverage", *objects, "-o", made, "-lm")
        return made

    def program(self, name: str, *flags: str) -> Path:
        """A program by its name, with further options of the compiler for its net and cell.

        Args:
            name: NAME or NAME.KIND; NAME: `odd`, `rivet`, `codec` or `scalars`; KIND: `deployed` or
                `traced`. What only the tests read is traced if nothing else is said.
        """
        made = self._programs / f"{name}.{zlib.crc32(repr(flags).encode()):08x}"
        if made.exists():
            return made
        first, _, kind = name.partition(".")
        tests = self._native / "tests"
        if first in ("codec", "scalars"):
            sources = [tests / f"{'codec_cell' if first == 'codec' else first}.c"]
            objects = [o for o in self.host() if o.stem == "pn_channel"]
            if first == "codec":
                objects.append(
                    self.compile(self._sources["messages"], self._counted("messages"), "--coverage")
                )
        elif first == "rivet":
            folder = self.root / "generated" / "riveting"
            sources = [folder / "net.c", folder / "cell_config.c"]
            objects = self.host(".traced" if kind == "traced" else "")
            flags += () if kind else ("-DPN_OWN_ONLY",)
        else:
            sources = [tests / "odd_net.c", tests / "odd_cell.c"]
            objects = self.host("" if kind == "deployed" else ".traced")
        return self.link(made.name, [*objects, *self._own(made.name, sources, flags)])

    def changed(self, name: str, file: str, text: str) -> Path:
        """The deployed riveting supervisor with another text in the place of one of its generated files."""
        folder = self._runs / name
        folder.mkdir(exist_ok=True)
        generated = self.root / "generated" / "riveting"
        for one in ("net.c", "net.h", "cell_config.c"):
            shutil.copy(generated / one, folder)
        (folder / file).write_text(text, encoding="utf-8")
        kept = self._programs / "rivet.net.o"
        if not kept.exists():
            self.compile(generated / "net.c", kept, "-DPN_OWN_ONLY")
        net = (
            kept
            if file != "net.c"
            else self.compile(folder / file, folder / "net.o", "-DPN_OWN_ONLY")
        )
        cell = self.compile(folder / "cell_config.c", folder / "cell.o")
        return self.link(f"changed {name}", [*self.host(), net, cell])

    def _own(self, name: str, sources: Sequence[Path], flags: Sequence[str]) -> Iterator[Path]:
        for source in sources:
            yield self.compile(source, self._programs / f"{name}.{source.stem}.o", *flags)

    # --- running ---

    def fresh(self) -> Path:
        """An empty folder with input files for `odd` (order 0: the end) and `rivet`."""
        self._count += 1
        folder = self._runs / str(self._count)
        folder.mkdir()
        (folder / "orders.txt").write_text("0\n")
        (folder / "name.txt").write_text('"nobody"\n')
        shutil.copy(self.root / "examples" / "riveting" / "coordenadas.robcad", folder)
        return folder

    def run(
        self,
        program: str | Path,
        *arguments: object,
        order: int | str | None = None,
        name: bytes | None = None,
        failing: str = "",
        stdin: str | bytes = "",
        folder: Path | None = None,
        env: dict[str, str] | None = None,
        directory: bool = True,
        limit: int | None = None,
    ) -> Done:
        """Runs a program to its end.

        Args:
            program: its name, or its path.
            arguments: after `--dir` and `--input`, which are given unless `directory` is False.
            order: what `odd` shall do.
            name: the content of its file `name.txt`.
            failing: rules of `cnative/tests/failing.c`.
            stdin: what it reads.
            folder: of `fresh`, in which it runs.
            env: more of the environment.
            limit: bytes that a file can have, as if the disk were full then.
        """
        folder = folder or self.fresh()
        shared = folder / "shared"
        if order is not None:
            (folder / "orders.txt").write_text(f"{order}\n")
        if name is not None:
            (folder / "name.txt").write_bytes(name)
        path = program if isinstance(program, Path) else self.program(program)
        given = ["--dir", shared, "--input", folder] if directory else []
        reached = folder / "reached"
        more = {}
        if failing or limit:
            more = {"LD_PRELOAD": str(self.preloaded), "FAILING": failing}
            more["FAILING_REACHED"] = str(reached)

        def fill() -> None:
            if limit is not None:
                resource.setrlimit(
                    resource.RLIMIT_FSIZE, (limit, resource.getrlimit(resource.RLIMIT_FSIZE)[1])
                )

        done = subprocess.run(
            [path, *map(str, [*given, *arguments])],
            input=stdin.encode() if isinstance(stdin, str) else stdin,
            cwd=folder, env={**os.environ, **more, **(env or {})}, capture_output=True, timeout=DEADLINE_S, check=False,
            preexec_fn=None if limit is None else fill,  # otherwise no copy of the tests has to be made
        )  # fmt: skip
        out, err = (text.decode("latin-1") for text in (done.stdout, done.stderr))
        return Done(done.returncode, out, err, shared, reached.exists())

    @contextmanager
    def started(
        self, program: str | Path, folder: Path, *, failing: str = "", **options: object
    ) -> Iterator[SupervisorProcess]:
        """A supervisor that robots of the test talk to, in `folder/shared`."""
        path = program if isinstance(program, Path) else self.program(program)
        (folder / "shared").mkdir(exist_ok=True)
        before = {name: os.environ.get(name) for name in ("LD_PRELOAD", "FAILING")}
        os.environ.update(
            {"LD_PRELOAD": str(self.preloaded), "FAILING": failing} if failing else {}
        )
        try:
            process = SupervisorProcess(path, folder / "shared", folder, **options)  # type: ignore[arg-type]
        finally:
            for name, value in before.items():
                os.environ.pop(name, None)
                os.environ.update({name: value} if value is not None else {})
        with process:
            yield process

    def taken(self) -> Files:
        """What has been counted so far."""
        return collect(self._store, "gcov")


KINDS = {"": (), ".traced": ("-DPN_TRACE",)}
"""Of supervisors: with which options they are compiled."""


def run(*command: object) -> None:
    """Runs a compiler, which has to be silent."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stderr == "", done.stderr
