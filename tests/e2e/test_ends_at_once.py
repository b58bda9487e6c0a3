"""A supervisor that waits for nobody may have come to its end before anybody joins it."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.small_cell import write
from pn2code.diagnostics import Diagnostics
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

NET = """
net cell
  standard
  var k: INT;
  page Top
    place flag : INT
    place done : INT
    subst Supervisor = Sup (flag -> flag, done -> done)
    subst Device = Dev (flag -> flag, done -> done)
  page Sup
    place flag port out : INT
    place done port in : INT
    place Start = 1
    place Finished
    place Heard
    trans Ask
      in Start : ()
      out flag : 1
      out Finished : ()
    trans Got
      in done : k
      out Heard : ()
  page Dev
    place flag port in : INT
    place done port out : INT
    place Waiting = 1
    trans Answer
      both Waiting : ()
      in flag : k
      out done : k
"""
TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "flag"
file = "flag.txt"
kind = "data"
[[channel]]
place = "done"
file = "done.txt"
[devices.device]
instance = "Device"
"""


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
def test_a_cell_that_ends_at_once_has_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On the wall clock, too: that the supervisor has gone before the device came is no failure."""
    monkeypatch.setattr("pn2code.run.cell.ROBOT_START_S", 0.5)  # nobody comes any more
    cell = write(tmp_path / "cell", NET, TOML)
    for k, realtime in enumerate((False, True, True, True)):
        d = Diagnostics()
        options = RunOptions(
            out=tmp_path / f"out{k}", backend="fake", looks=False, realtime=realtime
        )
        result = run_cell(cell, options, d)
        assert result is not None, [x.message for x in d]
        assert (result.record.verdict, result.summary["final"]) == (
            "finished",
            ["Top.Supervisor.Finished"],
        )
