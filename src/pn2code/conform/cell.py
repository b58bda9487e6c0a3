"""The whole comparison: the compiled net, the supervisor, the robots' scripts.

found = conform_cell(Path("examples/riveting"), d)      # Conformance(core, supervisor, robots)
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.how_far import Say, silent
from pn2code.base.kept_answers import KeptAnswers
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Owner
from pn2code.conform import core, data, declared, folder, robot, supervisor
from pn2code.conform.codes import PROBE_FAILED
from pn2code.conform.folder import PROGRAM, Folder
from pn2code.conform.probe import HOST, PATIENCE_S, Probe, ProbeError
from pn2code.conform.scheme import MOST_STATES
from pn2code.conform.script_state import RobotReport
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.emission.output import OutputFile
from pn2code.input_files import begin, folder_of
from pn2code.net.flat import FlatNet
from pn2code.pipeline import Generated, generate
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import place_from_json, place_text
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import JsonError
from pn2code.tdl.check import check
from pn2code.tdl.parse import parse
from pn2code.toolchain import programs


@frozen
class Conformance:
    """What was compared.

    Args:
        core: the compiled net.
        supervisor: None for a net without a cell.
        robots: the scripts.
        folder: the files that were given; None: all are fresh.
    """

    core: core.CoreReport
    supervisor: supervisor.Report | None
    robots: tuple[RobotReport, ...]
    folder: Folder | None = None

    @property
    def deviates(self) -> bool:
        """Whether anything differs."""
        return (
            self.core.deviation is not None
            or (self.folder is not None and self.folder.deviates)
            or (self.supervisor is not None and self.supervisor.deviation is not None)
            or any(r.deviation is not None for r in self.robots)
        )

    @property
    def complete(self) -> bool:
        """Whether every state was compared."""
        return (
            self.core.complete
            and (self.folder is None or self.folder.complete)
            and (self.supervisor is None or self.supervisor.complete)
            and all(r.complete for r in self.robots)
        )


def conform_cell(
    path: Path,
    d: Diagnostics,
    *,
    values: Mapping[str, str] | None = None,
    int_bits: int = 31,
    most: int = MOST_STATES,
    generated: Path | None = None,
    checked: bool = True,
    inputs: Path | None = None,
    kept: KeptAnswers | None = None,
    stage: Callable[[str], None] = lambda _: None,
    say: Say = silent,
) -> Conformance | None:
    """Compares all programs of a cell, or the compiled net alone; None after an error that was reported.

    Args:
        path: a net, a cell.toml, or its folder.
        d: gets the errors.
        values: replace `val`s of the net.
        int_bits: width of `int`.
        most: states up to which all are compared.
        generated: a folder with generated files, which may have been edited; None: they are generated now.
        checked: whether the supervisor must pass its checks (docs/execution.md).
        inputs: other input files than those beside cell.toml, as for `input_files.begin`.
        kept: what earlier commands have proved of the supervisor.
        stage: hears what is done next; say: and how far it is.
    """

    def examine(net: FlatNet, config: CellConfig | None, d: Diagnostics) -> None:
        # What the supervisor would refuse when it starts is said before anything that takes long.
        begin(net, config, d, is_started=True, given=inputs)

    made = generate(
        path,
        d,
        values=values,
        int_bits=int_bits,
        checked=checked,
        examine=examine,
        inputs=inputs,
        kept=kept,
    )
    if made is None:
        return None
    found: Folder | None = None
    files: Sequence[OutputFile] = made.files
    if generated is not None:
        given = folder.compare(generated, made.files, d)
        if given is None:
            return None
        found, files = given
    storage = made.config.storage if made.config else {}
    begun = begin(made.partition.net, made.config, Diagnostics(), given=inputs).net
    try:
        stage("comparing net.c with the token game ...")
        compared = core.compare(begun, storage, d, most=most, say=say)
        if compared is None:
            return None
        if made.config is None or not made.partition.channels:
            return Conformance(compared, None, (), found)
        done = _programs(ProgramComparison(made, most, inputs, say), files, d, stage)
        return None if done is None else Conformance(compared, *done, found)
    except GameError as error:
        error.report(d)
    except ProbeError as problem:
        d.error(
            PROBE_FAILED,
            f"the program under test cannot be asked: {problem}",
            Origin(made.partition.net.file),
        )
    return None


def _programs(
    comparison: ProgramComparison,
    files: Sequence[OutputFile],
    d: Diagnostics,
    stage: Callable[[str], None],
) -> tuple[supervisor.Report, tuple[RobotReport, ...]] | None:
    stage("comparing the supervisor with the net ...")
    own = [f for f in files if f.path in PROGRAM]
    with programs.program(
        HOST.with_room(comparison.made.partition.message_room), own, d
    ) as program:
        if program is None:
            return None
        supervised = comparison.supervisor(program)
    texts = {f.path: f.text for f in files}
    robots = []
    for owner in comparison.made.partition.owners[1:]:
        stage(f"comparing {owner.name}.tdl with its page ...")
        report = comparison.script(owner, texts[f"{owner.name}.tdl"], d)
        if report is None:
            return None
        robots.append(report)
    return supervised, tuple(robots)


class ProgramComparison:
    """Compares the programs of one cell with its net, which begins with the tokens of the cell's input files.

    Args:
        made: what is generated from the cell.
        most: states up to which all are compared.
        inputs: other input files, with which it was generated; None: those beside cell.toml.
        say: hears in words how far a comparison is.
    """

    def __init__(
        self,
        made: Generated,
        most: int = MOST_STATES,
        inputs: Path | None = None,
        say: Say = silent,
    ) -> None:
        assert made.config is not None, "only a cell has programs"
        self.made = made
        self._config = made.config
        self._most = most
        self._inputs, self._say = inputs, say
        self._begun = begin(made.partition.net, made.config, Diagnostics(), given=inputs)
        self._partition = replace(made.partition, net=self._begun.net)

    def supervisor(
        self, program: Path, patience: float = PATIENCE_S, *, tables_first: bool = False
    ) -> supervisor.Report:
        """Compares a supervisor that was compiled with `probe.HOST`: in all states, then its tables.

        Args:
            program: the supervisor.
            patience: seconds of processor time that it may take for an answer.
            tables_first: where these differ, no state is looked at.

        Raises:
            ProbeError: it does not answer, or takes longer than `patience` seconds for an answer.
            GameError: a declaration or an initial marking raises an exception.
        """
        with (
            tempfile.TemporaryDirectory(prefix="pn2code-") as name,
            folder_of(self._config, self._inputs) as folder,
        ):
            trace = Path(name) / "supervisor.trace.jsonl"
            options = ["--input", str(folder), "--trace", str(trace)]
            with closing(Probe(program, options, patience)) as probe:
                game = self._game()
                difference = data.compare(self.made, game, probe.tables)
                report = supervisor.Report()
                misread = self._misread(trace, game)
                if misread is not None:  # whatever else differs may come from this
                    difference = misread
                elif difference is None or not tables_first:
                    report = supervisor.explore(self._partition, game, probe, self._most, self._say)
                if report.deviation is None and difference is not None:
                    report.deviation = supervisor.Deviation(difference, ())
                    report.complete, report.why = False, "deviation"
                return report

    def script(self, owner: Owner, text: str, d: Diagnostics) -> RobotReport | None:
        """Compares the script of a robot or device; None after an error in it that was reported."""
        parsed = parse(SourceText(text, Origin(f"{owner.name}.tdl", 1, 1)), d)
        checked = check(parsed, d, self._config.frame_names) if parsed is not None else None
        if checked is None:
            return None
        partition, game = self._partition, self._game()
        difference = declared.compare(partition, self._config, owner.index, checked, game)
        if difference is not None:
            return RobotReport(owner.name, 0, 0, 0, 0, 0, complete=False, deviation=difference)
        return robot.explore(
            partition, self._config, owner.index, checked, game, most=self._most, say=self._say
        )

    def _misread(self, trace: Path, game: Game) -> str | None:
        """Where the header of the program's trace says that it has read something else from its input files."""
        with trace.open(encoding="utf-8") as lines:
            told = json.loads(lines.readline()).get("initial", {})
        for given in self._begun.given:
            colset = self._partition.net.places[given.place].colset
            expected = game.marking.places[given.place]
            try:
                found = place_from_json(colset, told.get(given.name, []))
            except JsonError as error:
                return f"place `{given.name}` in the program: {error}"
            if found != expected:
                is_, should = (place_text(game.colours, colset, x) for x in (found, expected))
                return f"place `{given.name}` begins with {is_}, but its input file holds {should}"
        return None

    def _game(self) -> Game:
        return Game(self._begun.net, self._config.storage, files=Files(None))
