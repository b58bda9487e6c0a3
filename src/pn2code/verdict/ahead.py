"""What a run of a cell would come upon, seen by `pn2code check` without running: what sensors say, where arms stand.

look_ahead(partition, config, programs, d)
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import assert_never

from pn2code.base.kept_answers import KeptAnswers
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.division import FINE, said_of_space
from pn2code.input_files import begin
from pn2code.robot_scripts.ir import Chain, Comment, Line, Node, Region, Repeat, RobotIR
from pn2code.run.sensors import load as load_sensors


def look_ahead(
    partition: Partition,
    config: CellConfig,
    programs: Iterable[RobotIR],
    d: Diagnostics,
    inputs: Path | None = None,
    kept: KeptAnswers | None = None,
) -> None:
    """Reports missing inputs, values of sensors that are none, arms that touch at HOME, constant poses out of reach.

    Args:
        partition: the net and its owners.
        config: the cell, which is right as far as it can be seen without its robots moving.
        programs: of its robots and devices.
        d: gets the errors.
        inputs: the input files of the run, if not those beside cell.toml; a folder with them may have files of sensors.
        kept: what earlier commands have found; nothing is loaded of a cell about whose space there was nothing to say.
    """
    begin(partition.net, config, d, is_started=True, given=inputs)
    folders = (config.folder,) if inputs is None else (inputs, config.folder)
    load_sensors(config, partition.net, folders, None, d)
    question = None
    if kept is not None and kept.is_settled(config.path):
        told = [_told(ir) for ir in programs]
        question = kept.question("space", *said_of_space(config), told)
        if question.answer() == FINE:
            return
    from pn2code.verdict.in_space import look_in_space  # loads NumPy and PyBullet

    before = d.reported
    files = look_in_space(config, programs, d)
    if question is not None and d.reported == before:
        question.keep(FINE, files)


def _told(ir: RobotIR) -> tuple[object, ...]:
    """All of a program that says where its arm goes, without where in the net it comes from."""
    constants = [c.declaration for c in ir.constants]
    procedures = [(name, _shape(body)) for name, body in ir.procedures]
    return ir.name, ir.kind, constants, procedures, _shape(ir.body)


def _shape(nodes: Iterable[Node]) -> list[object]:
    """Statements in their blocks; a region is one, too: a move is looked at beside the one before in its block."""
    out: list[object] = []
    for node in nodes:
        match node:
            case Line(statement):
                out.append(statement)
            case Region(body=body):
                out.append(("region", _shape(body)))
            case Repeat(condition, body):
                out.append(("repeat", condition, _shape(body)))
            case Chain(branches, otherwise):
                inner = [(condition, _shape(body)) for condition, body in branches]
                out.append(("if", inner, None if otherwise is None else _shape(otherwise)))
            case Comment():
                pass
            case _:
                assert_never(node)  # what is not told here would be taken for the same
    return out
