"""The whole comparison: the compiled net, the supervisor, the robots' scripts.

found = conform_cell(Path("examples/riveting"), d)      # Conformance(core, supervisor, robots)
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pn2code.conform import core, robot, supervisor
from pn2code.conform.codes import GENERATED_UNREADABLE, PROBE_FAILED
from pn2code.conform.probe import HOST, Probe, ProbeError
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.emission.output import OutputFile
from pn2code.pipeline import Generated, generate
from pn2code.semantics.files import Files
from pn2code.semantics.game import Game, GameError
from pn2code.semantics.marking import PlaceMarking, place_from_json
from pn2code.tdl.check import check
from pn2code.tdl.parse import parse
from pn2code.toolchain import programs

PROGRAM = ("net.c", "net.h", "cell_config.c")
"""The supervisor's own files."""


@dataclass(frozen=True, slots=True)
class Conformance:
    """What was compared. `supervisor` is None for a net without a cell."""

    core: core.CoreReport
    supervisor: supervisor.Report | None
    robots: tuple[robot.RobotReport, ...]

    @property
    def deviates(self) -> bool:
        """Whether anything differs."""
        return (
            self.core.deviation is not None
            or (self.supervisor is not None and self.supervisor.deviation is not None)
            or any(r.deviation is not None for r in self.robots)
        )

    @property
    def complete(self) -> bool:
        """Whether every state was compared."""
        return (
            self.core.complete
            and (self.supervisor is None or self.supervisor.complete)
            and all(r.complete for r in self.robots)
        )


def conform_cell(
    path: Path,
    d: Diagnostics,
    *,
    values: Mapping[str, str] | None = None,
    int_bits: int = 31,
    most: int = core.MOST_NODES,
    generated: Path | None = None,
) -> Conformance | None:
    """Compares all programs of a cell, or the compiled net alone; None after an error that was reported.

    Args:
        path: a net, a cell.toml, or its folder.
        d: gets the errors.
        values: replace `val`s of the net.
        int_bits: width of `int`.
        most: states up to which all are compared.
        generated: a folder with generated files, which may have been edited; None: they are generated now.
    """
    made = generate(path, d, values=values, int_bits=int_bits)
    if made is None:
        return None
    files = made.files if generated is None else _files(generated, made.files, d)
    if files is None:
        return None
    net = made.partition.net
    storage = made.config.storage if made.config else {}
    try:
        compared = core.compare(net, storage, d, most=most)
        if compared is None:
            return None
        if made.config is None or not made.partition.channels:
            return Conformance(compared, None, ())
        supervised = _supervisor(made, files, most, d)
        if supervised is None:
            return None
        report, initial = supervised
        robots = _robots(made, files, initial, most, d)
    except GameError as error:
        error.report(d)
        return None
    return None if robots is None else Conformance(compared, report, robots)


def _files(
    folder: Path, fresh: Sequence[OutputFile], d: Diagnostics
) -> tuple[OutputFile, ...] | None:
    """The same files as they are in a folder."""
    wanted = [f for f in fresh if f.path in PROGRAM or f.path.endswith(".tdl")]
    try:
        return tuple(
            OutputFile(f.path, (folder / f.path).read_text(encoding="utf-8")) for f in wanted
        )
    except (OSError, UnicodeDecodeError) as problem:
        d.error(
            GENERATED_UNREADABLE,
            f"a generated file cannot be read: {problem}",
            Origin(str(folder)),
            hint="generate it again: `pn2code generate NET -o DIR`",
        )
        return None


def _supervisor(
    made: Generated, files: Sequence[OutputFile], most: int, d: Diagnostics
) -> tuple[supervisor.Report, dict[str, PlaceMarking]] | None:
    """The report, and the markings that the program has read from its input files."""
    assert made.config is not None
    own = [f for f in files if f.path in PROGRAM]
    with programs.program(HOST, own, d) as program:
        if program is None:
            return None
        with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
            trace = Path(name) / "supervisor.trace.jsonl"
            options = ["--input", str(made.config.folder), "--trace", str(trace)]
            try:
                with Probe(program, options) as probe:
                    initial = _initial(made, trace)
                    game = _game(made, initial)
                    limits = supervisor.Limits(states=most)
                    return supervisor.explore(made.partition, game, probe, limits), initial
            except ProbeError as problem:
                d.error(
                    PROBE_FAILED,
                    f"the program under test cannot be asked: {problem}",
                    Origin(made.partition.net.file),
                )
                return None


def _initial(made: Generated, trace: Path) -> dict[str, PlaceMarking]:
    """What the program has read from its input files, from the header of its trace."""
    with trace.open(encoding="utf-8") as lines:
        header = json.loads(lines.readline())
    colsets = {p.name: p.colset for p in made.partition.net.places}
    found = header.get("initial", {})
    return {name: place_from_json(colsets[name], data) for name, data in found.items()}


def _game(made: Generated, initial: Mapping[str, PlaceMarking]) -> Game:
    assert made.config is not None
    return Game(made.partition.net, made.config.storage, initial, files=Files(None))


def _robots(
    made: Generated,
    files: Sequence[OutputFile],
    initial: Mapping[str, PlaceMarking],
    most: int,
    d: Diagnostics,
) -> tuple[robot.RobotReport, ...] | None:
    assert made.config is not None
    texts = {f.path: f.text for f in files}
    reports = []
    for owner in made.partition.owners[1:]:
        name = f"{owner.name}.tdl"
        parsed = parse(SourceText(texts[name], Origin(name, 1, 1)), d)
        checked = check(parsed, d) if parsed is not None else None
        if checked is None:
            return None
        game = _game(made, initial)
        reports.append(
            robot.explore(made.partition, made.config, owner.index, checked, game, most=most)
        )
    return tuple(reports)
