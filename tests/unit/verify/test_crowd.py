"""What makes the states of a cell so many: which programs, registers and places differ among some of its markings."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers import register_pairs
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.opened import read
from pn2code.verdict.programs import partition_of
from pn2code.verify.controller.crowd import Crowd, counted
from pn2code.verify.controller.running import Running


@pytest.fixture
def running(tmp_path: Path) -> Running:
    d = Diagnostics()
    opened = read(register_pairs.write(tmp_path, register_pairs.TOLD), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = partition_of(opened, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    return Running.of(partition)


def test_each_part_is_counted_by_its_own_places(running: Running) -> None:
    """A copy of the register belongs to it; whatever is marked in one way alone makes nothing larger."""
    markings = [
        {
            "Top.First.Idle": [[1]],
            "Top.Second.Told": [[1, 0]] if i % 2 else [],
            "Top.Second.Idle": [] if i % 2 else [[1, 0]],
            "Top.First.limit_seen": [[1, i]],
            "Top.limit": [[1, 7]],
            "cell.supervisor.idle": [[1]] if i < 2 else [],
            "cell.supervisor.calm": [] if i < 2 else [[1]],
        }
        for i in range(5)
    ]
    found = counted(running, markings)
    assert found.states == 5
    assert dict(found.parts) == {
        "register `limit`": 5,
        "`second`": 2,
        "messages and who has seen them": 2,
    }
    assert found.parts[0][0] == "register `limit`"
    assert found.values == () and found.registers == ("limit",)


def test_what_is_told_and_what_helps() -> None:
    found = Crowd(6000, (("`camera`", 17), ("the supervisor", 9)), (("Viewed", 7),), ("speed",))
    (_, why), (_, what) = found.lines()
    assert why.startswith("`camera` in 17, the supervisor in 9: in so many ways")
    assert "`--set`" in what and "`Viewed` 7" in what and "`speed`" in what
    assert "register" not in "".join(x for _, x in Crowd(1, (), (), ()).lines())
