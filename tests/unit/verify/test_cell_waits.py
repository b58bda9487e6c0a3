"""What is said of a time that the net does not know: whose, and moves only where an arm makes some."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers import record_list_cell
from pn2code.cell.divide import divide
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.properties.meaning import Atom, Response
from pn2code.verify.controller.cell_answers import waits

CAMERA, MOVES = "what device `camera` does takes", "moves take"


@pytest.mark.parametrize(
    ("first", "second", "words"),
    [
        ("Top.Camera.Begin", "Top.Camera.Tell", CAMERA),
        ("Top.Robot.Begin", "Top.Robot.Report", MOVES),
        ("Top.Supervisor.Ask", "Top.Supervisor.Seen", MOVES),
        ("Top.Camera.Begin", "Top.Supervisor.Seen", MOVES),
        ("Top.Camera.Begin", "", MOVES),
    ],
)
def test_whose_time_is_not_known(tmp_path: Path, first: str, second: str, words: str) -> None:
    folder = record_list_cell.write(tmp_path)
    d = Diagnostics()
    config, flat = load(folder / "cell.toml", d), front.load(folder / "cell.cpn", d)
    assert config is not None and flat is not None
    partition = divide(flat, config, d)
    assert partition is not None, [str(i) for i in d]
    numbers = {x.name: i for i, x in enumerate(partition.net.transitions)}
    other = Atom("fires", numbers[second]) if second else Atom("dead")
    asked = Response(Atom("fires", numbers[first]), other, None, "5")
    measured = "moves" if words == MOVES else "it"
    assert waits(asked, partition) == (
        f"the net knows neither how long {words} nor how late the supervisor is "
        f"(`--durations` measures {measured})"
    )
