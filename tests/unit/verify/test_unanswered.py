"""Which way a script takes a message and gives no answer: back to where it waits, or to its end."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.small_cell import NET, write
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.robot_scripts.machine import Machine, analyse
from pn2code.verdict.opened import read
from pn2code.verify.controller.unanswered import ADVICE, unanswered

REPORT = """    trans Report
      in Over : ()
      out Waiting : ()
      out done : 1
"""
ENDS = REPORT.replace("trans Report", "place Gone\n    trans Report").replace(
    "out Waiting", "out Gone"
)
DRILL = "code action drill ()\n      in Told : k\n      out Over : ()\n"


def program(folder: Path, net: str) -> Machine:
    d = Diagnostics()
    opened = read(write(folder, net), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    machine = analyse(partition, partition.owners[1], d)
    assert machine is not None, [x.message for x in d.errors]
    return machine


def test_scripts_that_answer(tmp_path: Path) -> None:
    assert unanswered(program(tmp_path / "on", NET)) == ""
    assert unanswered(program(tmp_path / "end", NET.replace(REPORT, ENDS))) == ""


@pytest.mark.parametrize(
    ("report", "does"),
    [
        (ENDS, "`Top.Robot.Report` is the end of the script"),
        (REPORT, "`Top.Robot.Report` leads back to where the script waits for the next message"),
    ],
    ids=["ends", "goes back"],
)
def test_where_a_script_goes_without_an_answer(report: str, does: str, tmp_path: Path) -> None:
    """Drill answers at once, the other commands do not."""
    silent = report.replace("      out done : 1\n", "")
    net = NET.replace(REPORT, silent).replace(DRILL, f"{DRILL}      out done : 1\n")
    assert unanswered(program(tmp_path, net)) == (
        f"after a message of `flag.robcad` {does}, and no answer has been given: {ADVICE}"
    )
