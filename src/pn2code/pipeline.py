"""The compiler as a recipe: from a `.cpn` file (and the `cell.toml` beside it) to files in memory.

    read -> link -> check -> flatten -> divide -> lower -> prove -> emit

Each stage is a function from one immutable value to the next; it reports into `Diagnostics`, and
the driver stops between stages when there are errors. Every verb starts with `cell.locate` and `net.front`; `generate`
is the whole of it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pn2code
from pn2code import registers
from pn2code.base.frozen import frozen
from pn2code.base.kept_answers import KeptAnswers
from pn2code.cell.config import CellConfig
from pn2code.cell.locate import locate
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Severity
from pn2code.division import divided
from pn2code.emission import arena_size, manifest, needs, runtime
from pn2code.emission import c as emit_c
from pn2code.emission import supervisor as emit_supervisor
from pn2code.emission import tdl as emit_tdl
from pn2code.emission.output import OutputFile
from pn2code.input_files import Begun, begin
from pn2code.lowering.nets import net as lower_net
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.net.reached import unused_functions
from pn2code.properties.failing import Failing
from pn2code.robot_scripts import translate as lower_robot
from pn2code.semantics.evaluation.constants import compute
from pn2code.verify.controller import kept_proofs
from pn2code.verify.controller.proofs import prove
from pn2code.verify.exploring.place_capacity import PlaceCapacity, with_place_capacities

if TYPE_CHECKING:
    from pn2code.arms import Arms

Examine = Callable[[FlatNet, CellConfig | None, Diagnostics], None]


def _nobody(stage: str) -> None:
    """Nobody is told."""


@frozen
class Generated:
    """What the generator gives.

    Args:
        files: everything that belongs into the output folder, sorted by path.
        partition: the net and its owners.
        config: the cell, None for a net without one.
        digest: SHA-256 of the net and of what the cell contributes to the programs.
        place_capacities: how many tokens each place can hold, and why.
        arena: bytes that the supervisor has for lists, strings and the moves of a firing.
        is_checked: whether the supervisor was checked, with the input files that were there.
        failing: conditions that mean that the cell has failed when it has come to its end.
    """

    files: tuple[OutputFile, ...]
    partition: Partition
    config: CellConfig | None
    digest: str
    place_capacities: tuple[PlaceCapacity, ...]
    arena: int
    is_checked: bool
    failing: Failing = Failing()


def generate(
    path: Path,
    d: Diagnostics,
    *,
    layout: str | None = None,
    values: Mapping[str, str] | None = None,
    int_bits: int = 31,
    checked: bool = True,
    examine: Examine | None = None,
    inputs: Path | None = None,
    kept: KeptAnswers | None = None,
    stage: Callable[[str], None] = _nobody,
) -> Generated | None:
    """Everything from files to files in memory; None when an error was reported.

    `values` replaces `val`s of the net (over those of cell.toml).

    The supervisor of a cell is checked (docs/execution.md) with the tokens of its input files, and its places get room
    for what is proven to come, with more room where other files may lead to more; without `checked` nothing is refused
    for that.

    `inputs` is a folder with other input files than those beside cell.toml, or the one file: what is checked, and what
    there is room for, is the cell with these.

    `kept` is what earlier commands have proved; what is proved now is added to it.

    `examine` looks at net and cell before anything that takes long; nothing is done after an error of it.

    `stage` is told what takes the time.

    What a net may have but cannot do here (sockets, processes) is an error: a supervisor must not stop there.
    """
    found = locate(path, d, layout=layout)
    if found is None:
        return None
    net_path, config = found
    replaced = {**(config.values if config else {}), **(values or {})}

    examined = front.examine(net_path, d, replaced, int_bits=int_bits, compute=compute)
    net, typed = examined.flat, examined.typed
    _refuse_unsupported(d, net)
    if net is None or d.has_errors:
        return None
    net, config = registers.as_messages(net, config, d)
    if net is None or d.has_errors:
        return None
    partition = divided(net, config, d, kept=kept)
    if partition is not None and examine is not None:
        examine(net, config, d)
    failing = Failing.of(config, net, typed.elaborator if typed is not None else None, d)
    if partition is None or d.has_errors:
        return None

    stage("translating the net")
    storage = config.storage if config else {}
    digest = program_digest(net, config, replaced, int_bits)
    ir = lower_net.lower(partition, storage, d, digest=digest)
    robots = lower_robot.lower_robots(partition, config, d) if config else ()
    if ir is None or robots is None or d.has_errors:
        return None
    begun = Begun(net)
    if checked or inputs is not None:
        begun = begin(net, config, d, given=inputs)
    if d.has_errors:
        return None
    begun_as = replace(partition, net=begun.net)
    given = begun.given, sorted(begun.checksums.items())
    stage("proving what the programs rely on")
    question = kept_proofs.asked(kept if checked else None, begun_as, config, replaced, given)
    proofs = kept_proofs.recalled(question)
    if proofs is None:
        before = d.reported
        arms = _arms(config, d)
        proofs = prove(
            begun_as,
            config,
            d,
            checked=checked,
            arms=arms,
            tokens={g.place: g.says for g in begun.given},
        )
        if question is not None and proofs is not None and d.reported == before:
            kept_proofs.keep(question, proofs, arms.files if arms is not None else ())
    if proofs is None or d.has_errors:
        return None

    stage("writing the programs")
    version = pn2code.__version__
    deployed = with_place_capacities(ir, proofs.place_capacities)
    net_files = emit_c.emit(deployed, version)
    arena = arena_size.of(deployed, proofs.arena)
    files = [
        *net_files,
        *emit_supervisor.emit(
            partition,
            name=net.name,
            reply_timeout_s=config.supervisor.reply_timeout_s if config else 0.0,
            digest=digest,
            version=version,
            verdicts=proofs.verdicts,
            checked_inputs=begun.checksums if checked else None,
            arena=arena,
            compiled=deployed,
            net_text=net_files[0].text,
        ),
        *emit_tdl.emit(robots, source=Path(net.file).name, digest=digest, version=version),
        *runtime.emit("supervisor", "simulate", "exercise"),
        *_inputs(config, inputs),
    ]
    nesting = needs.nesting(deployed)
    files.append(manifest.emit(partition, files, digest=digest, version=version, nesting=nesting))
    return Generated(
        files=tuple(sorted(files, key=lambda f: f.path)),
        partition=partition,
        config=config,
        digest=digest,
        place_capacities=proofs.place_capacities,
        arena=arena.bytes,
        is_checked=checked,
        failing=failing,
    )


def _arms(config: CellConfig | None, d: Diagnostics) -> Arms | None:
    if config is None:
        return None
    from pn2code.arms import Arms  # loads NumPy, which nets without a cell do not need

    return Arms.of(config, d)


def _refuse_unsupported(d: Diagnostics, net: FlatNet | None) -> None:
    """Make the warnings of unsupported things errors, but for functions that no run of the net comes to."""
    is_unused = unused_functions(net) if net is not None else lambda warning: False
    d.items = [
        replace(i, severity=Severity.ERROR, hint="a supervisor must not stop there: remove it")
        if i.severity is Severity.WARNING and i.code.startswith("unsupported-") and not is_unused(i)
        else i
        for i in d.items
    ]


def _inputs(config: CellConfig | None, given: Path | None) -> Iterator[OutputFile]:
    """Copies of the input files that the programs were generated with, so that `make && ./supervisor` works where it
    stands.

    A file that is missing or is no text is left out: the supervisor says so when it starts, where it can be mended.
    """
    for entry in config.inputs if config else ():
        with suppress(OSError, UnicodeDecodeError):
            assert config is not None
            path = config.input_path(entry, given)
            yield OutputFile(entry.file, path.read_text(encoding="utf-8"))


def program_digest(
    net: FlatNet, config: CellConfig | None, values: Mapping[str, str], int_bits: int = 31
) -> str:
    """What the generated programs depend on, as their heads and traces say: the net's bytes and those of files that it
    uses, the logic of the cell, replaced values, other integers."""
    parts = [net.sha256, config.logic_digest() if config else "", repr(sorted(values.items()))]
    if int_bits != 31:
        parts.append(f"int {int_bits}")
    parts += [f"uses {sha256}" for _, sha256 in net.program.used]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()
