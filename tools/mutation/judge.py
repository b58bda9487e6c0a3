"""One cell, ready to be mutated: its generated files, its runtime as object files, and the comparison.

with judge_of(folder) as judge:
    judge.verdict(mutant)      # "killed: ...", "survived", "no mutant: it does not compile"
"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

from tools.mutation.mutants import Mutant

from pn2code.conform import robot
from pn2code.conform.cell import ProgramComparison
from pn2code.conform.folder import PROGRAM
from pn2code.conform.places_as_files import Script
from pn2code.conform.probe import HOST, ProbeError
from pn2code.diagnostics import Diagnostics
from pn2code.emission import c_flags
from pn2code.pipeline import Generated, generate
from pn2code.tdl.requests import Request

SECONDS = 10.0
"""A mutant that takes longer for one answer does not come to rest."""
FLAGS = (c_flags.STANDARD, "-O0", "-w", *c_flags.FLOATS)
MONITOR = "-DPN_MONITOR"
SURVIVED = "survived"
NONE = "no mutant"


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of a mutant: "killed" (`why` says by what), "survived", "no mutant" (it is not even a program)."""

    result: str
    why: str = ""


@contextmanager
def judge_of(cell: Path, *flags: str) -> Iterator[Judge]:
    """Generates a cell's programs and builds them in a folder that is there as long as the block lasts.

    Args:
        cell: its folder.
        flags: for the C compiler, added to `FLAGS`.
    """
    d = Diagnostics()
    made = generate(cell, d)
    assert made is not None, [str(i) for i in d]
    with tempfile.TemporaryDirectory(prefix="pn2code-") as room:
        own = (
            () if MONITOR in flags else HOST.net
        )  # the monitored program has the net.o of all transitions
        yield Judge(cell, made, Path(room), (*FLAGS, *HOST.flags, *own, *flags))


class Judge:
    """A cell and its programs.

    Args:
        cell: its folder.
        made: what is generated from it.
        room: an empty folder.
        flags: for the C compiler.

    Attributes:
        occurring: transitions of the supervisor that occur in states that can be reached.
        lines: of each script those that are carried out there.
    """

    def __init__(self, cell: Path, made: Generated, room: Path, flags: tuple[str, ...]) -> None:
        self.cell = cell
        self.made = made
        self.files = {f.path: f.text for f in made.files}
        self._comparison = ProgramComparison(made)
        self._flags = flags
        self._room = room
        self._build_all()
        self.occurring: set[int] = set()
        first = self.verdict(None)
        assert first.result == SURVIVED, f"{cell}: without a mutation: {first}"
        self.lines = {name: self._carried_out(name) for name in self.files if ".tdl" in name}

    def verdict(self, mutant: Mutant | None) -> Verdict:
        """What `conform` says of the programs with one file changed; None: as they are."""
        if mutant is not None and mutant.file.endswith(".tdl"):
            return self._of_script(mutant)
        name = "program"
        if mutant is not None:
            source = self._room / "mutant.c"
            source.write_text(mutant.text, encoding="utf-8")
            if not self._compiled(source, "mutant.o"):
                return Verdict(NONE, "it does not compile")
            name = "mutated"
            own = f"{Path(mutant.file).stem}.o"
            objects = [o for o in self._objects if o != own] + ["mutant.o"]
            if not self._linked(objects, name):
                return Verdict(NONE, "it does not link")
        is_table = mutant is not None and mutant.file == "cell_config.c"
        return self._of_supervisor(self._room / name, tables_first=is_table)

    def _carried_out(self, name: str) -> frozenset[int]:
        lines: set[int] = set()

        class Noting(Script):
            def _step(self) -> Request | None:
                request = super()._step()
                lines.add(self.line)
                return request

        with patch.object(robot, "Script", Noting):
            own = self._of_script(Mutant(name, 0, "", "", self.files[name]))
        assert own.result == SURVIVED, f"{self.cell}: {name} without a mutation: {own}"
        assert lines, f"{self.cell}: no line of {name} is carried out"
        return frozenset(lines)

    # --- building ----------------------------------------------------------------------------------

    def _build_all(self) -> None:
        for f in (*HOST.runtime(), *(x for x in self.made.files if x.path in PROGRAM)):
            path = self._room / f.path
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f.text, encoding="utf-8")
        sources = sorted([*self._room.glob("runtime/src/**/*.c"), *self._room.glob("*.c")])
        for source in sources:
            assert self._compiled(source, f"{source.stem}.o"), source
        self._objects = [f"{source.stem}.o" for source in sources]
        assert self._linked(self._objects, "program")

    def _compiled(self, source: Path, name: str) -> bool:
        command = [
            "cc",
            *self._flags,
            "-Iruntime/include",
            "-Iruntime/src/supervisor",
            "-I.",
            "-c",
            str(source),
        ]
        return self._run([*command, "-o", name])

    def _linked(self, objects: list[str], name: str) -> bool:
        return self._run(["cc", *objects, *HOST.libraries, "-o", name])

    def _run(self, command: list[str]) -> bool:
        done = subprocess.run(command, cwd=self._room, capture_output=True, check=False)
        return done.returncode == 0

    # --- judging -----------------------------------------------------------------------------------

    def _of_supervisor(self, program: Path, *, tables_first: bool) -> Verdict:
        try:
            report = self._comparison.supervisor(program, SECONDS, tables_first=tables_first)
        except ProbeError as problem:
            return Verdict("killed", str(problem))
        if report.deviation is not None:
            return Verdict("killed", report.deviation.what)
        self.occurring |= report.transitions
        return Verdict(SURVIVED) if report.complete else Verdict("killed", report.why)

    def _of_script(self, mutant: Mutant) -> Verdict:
        owner = next(o for o in self.made.partition.owners if o.name == Path(mutant.file).stem)
        report = self._comparison.script(owner, mutant.text, Diagnostics())
        if report is None:
            return Verdict(NONE, "it is refused")
        if report.deviation is not None:
            return Verdict("killed", report.deviation)
        return Verdict(SURVIVED) if report.complete else Verdict("killed", "it never ends")
