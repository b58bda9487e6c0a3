"""When the supervisor has finished, a robot ends where it notices that (I9), in runs as by itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.carrying_cell import NET, TOML, write
from pn2code.diagnostics import Diagnostics
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

# After its report the arm sways to and fro, whatever the supervisor does; it would do so eight times.
SWAYING = (
    NET.replace("parts = 2", "parts = 1")
    .replace("    place Done : PART\n", "    place Done : PART\n    place Swaying : PART\n", 1)
    .replace(
        "      out placed : n\n      out Waiting : ()\n",
        "      out placed : n\n      out Swaying : 1\n"
        "    trans Sway guard [n < 9] code action (moveHome (); moveJoint (up infeed))\n"
        "      in Swaying : n\n      out Swaying : n + 1\n",
    )
)


@pytest.mark.parametrize("backend", ["fake", pytest.param("bullet", marks=pytest.mark.bullet)])
def test_a_robot_ends_when_the_supervisor_has(tmp_path: Path, backend: str) -> None:
    assert SWAYING.count("Sway guard") == 1
    d = Diagnostics()
    options = RunOptions(tmp_path / "run", backend=backend, looks=False, checked=False)  # type: ignore[arg-type]
    found = run_cell(write(tmp_path / "cell", SWAYING, TOML), options, d)
    assert found is not None, [e.message for e in d.errors]
    record = found.record
    assert record.verdict == "finished", record.reason
    events = record.events
    end = next(i for i, e in enumerate(events) if e.get("transition") == "Top.Supervisor.Finish")
    assert not [e for e in events[end:] if e.get("transition", "").endswith("Sway")]
    last = events[end]["t"]
    # What was under way then goes to its end, and nothing else begins.
    assert [a.start for a in record.actions if a.start > last] == []
    assert record.time - last < 10.0
