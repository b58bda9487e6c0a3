"""A run of a cell whose arms stand elsewhere than cell.toml says."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from pn2code.diagnostics import Diagnostics
from pn2code.input_files import folder_of
from pn2code.robot.robot_cell import RobotCell
from pn2code.run.cell import run_once, sensors_of
from pn2code.run.prepare import RunOptions, prepare
from pn2code.run.record import RunRecord
from pn2code.run.results import summary_of, write_results


def run_placed(
    path: Path, cell: RobotCell, options: RunOptions, d: Diagnostics
) -> RunRecord | None:
    """Runs the programs of a cell with these arms, and writes the results; None after an error that was reported."""
    prepared = prepare(path, options, d)
    if prepared is None:
        return None
    # What is generated does not depend on where arms stand.
    prepared = replace(prepared, robot_cell=cell)
    with ExitStack() as stack:
        inputs = stack.enter_context(folder_of(prepared.config, options.input))
        sensors = sensors_of(prepared, options, inputs, d)
        if sensors is None:
            return None
        record = run_once(prepared, options, inputs, sensors, d, [])
    if record is not None:
        write_results(record, summary_of(record, prepared), prepared, options.out)
    return record
