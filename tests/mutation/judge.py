"""One cell, ready to be mutated: its generated files, its runtime as object files, and the comparison.

with Judge.of(folder) as judge:
    judge.verdict(mutant)      # "killed: ...", "survived", "no mutant: it does not compile"
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self
from unittest.mock import patch

from tests.mutation.mutants import Mutant

from pn2code.conform import robot, supervisor
from pn2code.conform.cell import PROGRAM
from pn2code.conform.probe import HOST, Probe, ProbeError
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.pipeline import Generated, generate
from pn2code.semantics.files import Files
from pn2code.semantics.game import Game
from pn2code.semantics.marking import PlaceMarking, place_from_json
from pn2code.tdl.check import check
from pn2code.tdl.interpret import Interpreter, Request
from pn2code.tdl.parse import parse

SECONDS = 10.0
"""A mutant that takes longer for one answer does not come to rest."""
FLAGS = ("-std=c11", "-O0", "-w", "-ffp-contract=off")
SURVIVED = "survived"
NONE = "no mutant"


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of a mutant: "killed" (`why` says by what), "survived", "no mutant" (it is not even a program)."""

    result: str
    why: str = ""


class Judge:
    """A cell and its programs in a temporary folder.

    Args:
        cell: its folder.
        made: what is generated from it.
        flags: for the C compiler, added to `FLAGS`.

    Attributes:
        occurring: transitions of the supervisor that occur in states that can be reached.
        lines: of each script those that are carried out there.
    """

    def __init__(self, cell: Path, made: Generated, flags: tuple[str, ...] = ()) -> None:
        assert made.config is not None
        self.cell = cell
        self.made = made
        self.files = {f.path: f.text for f in made.files}
        self._flags = (*FLAGS, *flags)
        self._folder = tempfile.TemporaryDirectory(prefix="pn2code-")
        self._room = Path(self._folder.name)
        self._build_all()
        self._initial: dict[str, PlaceMarking] = {}
        self.occurring: set[int] = set()
        first = self.verdict(None)
        assert first.result == SURVIVED, f"{cell}: without a mutation: {first}"
        self.lines = {name: self._carried_out(name) for name in self.files if ".tdl" in name}

    @staticmethod
    def of(cell: Path, *flags: str) -> Judge:
        """Generates the cell's programs and builds them."""
        d = Diagnostics()
        made = generate(cell, d)
        assert made is not None, [str(i) for i in d]
        return Judge(cell, made, flags)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._folder.cleanup()

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
        return self._of_supervisor(self._room / name)

    def _carried_out(self, name: str) -> frozenset[int]:
        lines: set[int] = set()

        class Noting(Interpreter):
            def _step(self) -> Request | None:
                request = super()._step()
                lines.add(self.line)
                return request

        with patch.object(robot, "Interpreter", Noting):
            own = self._of_script(Mutant(name, 0, "", "", self.files[name]))
        assert own.result == SURVIVED, f"{self.cell}: {name} without a mutation: {own}"
        return frozenset(lines)

    # --- building ----------------------------------------------------------------------------------

    def _build_all(self) -> None:
        for f in (*HOST.runtime(), *(x for x in self.made.files if x.path in PROGRAM)):
            path = self._room / f.path
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f.text, encoding="utf-8")
        sources = sorted([*self._room.glob("runtime/src/*.c"), *self._room.glob("*.c")])
        for source in sources:
            assert self._compiled(source, f"{source.stem}.o"), source
        self._objects = [f"{source.stem}.o" for source in sources]
        assert self._linked(self._objects, "program")

    def _compiled(self, source: Path, name: str) -> bool:
        command = [
            "cc",
            *self._flags,
            "-Iruntime/include",
            "-Iruntime/src",
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

    def _of_supervisor(self, program: Path) -> Verdict:
        assert self.made.config is not None
        trace = self._room / "trace.jsonl"
        options = ["--input", str(self.made.config.folder), "--trace", str(trace)]
        try:
            with Probe(program, options, SECONDS) as probe:
                if not self._initial:
                    self._initial = self._read(trace)
                game = self._game()
                report = supervisor.explore(self.made.partition, game, probe)
        except ProbeError as problem:
            return Verdict("killed", str(problem))
        if report.deviation is not None:
            return Verdict("killed", report.deviation.what)
        self.occurring |= report.transitions
        return Verdict(SURVIVED) if report.complete else Verdict("killed", report.why)

    def _read(self, trace: Path) -> dict[str, PlaceMarking]:
        header = json.loads(trace.read_text(encoding="utf-8").splitlines()[0])
        colsets = {p.name: p.colset for p in self.made.partition.net.places}
        return {k: place_from_json(colsets[k], v) for k, v in header.get("initial", {}).items()}

    def _game(self) -> Game:
        assert self.made.config is not None
        storage = self.made.config.storage
        return Game(self.made.partition.net, storage, self._initial, files=Files(None))

    def _of_script(self, mutant: Mutant) -> Verdict:
        assert self.made.config is not None
        d = Diagnostics()
        parsed = parse(SourceText(mutant.text, Origin(mutant.file, 1, 1)), d)
        checked = check(parsed, d) if parsed is not None else None
        if checked is None:
            return Verdict(NONE, "it is refused")
        owner = next(o for o in self.made.partition.owners if o.name == Path(mutant.file).stem)
        partition, config = self.made.partition, self.made.config
        report = robot.explore(partition, config, owner.index, checked, self._game())
        if report.deviation is not None:
            return Verdict("killed", report.deviation)
        return Verdict(SURVIVED) if report.complete else Verdict("killed", "it never ends")


def quietly(judge: Judge, mutant: Mutant) -> Verdict:
    """The verdict; a crash of the comparison itself is no kill but an error."""
    with suppress(BrokenPipeError):
        return judge.verdict(mutant)
    return Verdict("killed", "the program ended")
