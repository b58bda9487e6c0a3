"""Proofs of a supervisor that an earlier command has found, kept by the content of everything that they depend on.

    question = asked(kept, partition, config, ...)     # None: the net is one whose states are not all there is to it
    proofs = recalled(question)                        # None: it has to be proved
    keep(question, proofs, files)

Only what was proved without anything to report is kept: whatever is refused, or could not be decided, is looked at
again, and reported again, by each command.
"""

from __future__ import annotations

import os
import shlex
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

from pn2code.base.kept_answers import KeptAnswers, Question
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.toolchain.build import find_compiler
from pn2code.verify.controller.proofs import Proofs
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.place_capacity import PlaceCapacity


def asked(
    kept: KeptAnswers | None,
    partition: Partition,
    config: CellConfig | None,
    values: Mapping[str, str],
    given: object,
) -> Question | None:
    """What is asked; None where nothing is kept.

    Args:
        kept: what earlier commands have found.
        partition: the net as a run begins it, and its owners.
        config: the cell; of a net without one the structure alone is looked at, which takes no time.
        values: replaced `val`s of the net.
        given: what input files bring, in a form that `repr` tells apart.
    """
    net = partition.net
    if kept is None or config is None or not kept.is_settled(config.path):
        return None
    if nondeterminism.undetermined(net):
        return None
    source = net.sha256, net.program.used, net.program.int_bits, sorted(values.items()), given
    cell = str(config.path.absolute()), config.path.read_bytes(), config.layout
    return kept.question("proofs", source, *cell, _compiler())


def recalled(question: Question | None) -> Proofs | None:
    """The proofs that were kept; None: there are none."""
    found = question.answer() if question is not None else None
    if found is None:
        return None
    capacities = tuple(PlaceCapacity(*row) for row in found["place_capacities"])
    return Proofs(capacities, tuple(found["verdicts"]), None, found["arena"])


def keep(question: Question, proofs: Proofs, files: Iterable[Path]) -> None:
    """Keeps proofs.

    Args:
        question: what was asked.
        proofs: of which nothing was reported.
        files: models of arms that were read for them.
    """
    rows = [(c.bound, c.kind, c.proof, c.seen) for c in proofs.place_capacities]
    answer = {"place_capacities": rows, "verdicts": proofs.verdicts, "arena": proofs.arena}
    question.keep(answer, files)


def _compiler() -> tuple[object, ...]:
    """That which compiles explorers."""
    name = find_compiler() or ""
    path = shutil.which(shlex.split(name)[0]) if name else None
    if path is None:
        return (name,)
    status = os.stat(path)  # noqa: PTH116 - for each file
    return name, os.path.realpath(path), status.st_size, status.st_mtime_ns, status.st_ctime_ns
