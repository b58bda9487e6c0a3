"""Where a cell is in a deadlock, the answer says what each of its programs waits for."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.small_cell import NET, write
from pn2code.cell.divide import divide
from pn2code.cli.main import app
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.game.token_game import Game
from pn2code.verify.answers.who_waits import supervisor_waits

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "here")]

FORGOTTEN = NET.replace("      out data : at n\n", "", 1).replace(
    "    place Going = 0\n",
    "    place Going = 0\n    trans Never guard [n > 10]\n      in Pieces : n\n      out data : at n\n",
    1,
)
"""Nobody sends the pose."""
SUPERVISOR = "The supervisor waits: `Arrived` needs a message in `done`."
ROBOT = "Robot `robot1` waits for `data` (robot1.tdl:33)."


@pytest.mark.parametrize("options", [(), ("--full",)])
def test_a_message_that_nobody_sends(tmp_path: Path, options: tuple[str, ...]) -> None:
    cell = write(tmp_path, FORGOTTEN)
    done = CliRunner().invoke(app, ["verify", str(cell), "--no-medium", *options])
    assert done.exit_code == 1, done.output
    lines = [line.strip() for line in done.output.splitlines()]
    at = lines.index("After that nothing can occur:")
    end = lines.index(ROBOT)
    assert lines[end - 1] == SUPERVISOR
    # The transitions that are nearest to occurring come before who waits for them.
    assert all("` cannot occur: " in line for line in lines[at + 1 : end - 1])
    # The steps that lead there are told all the same.
    assert any(line.endswith("Top.Robot.Accept  (k = 1)") for line in lines[:at])


def test_guards_that_do_not_depend_on_the_message_count(tmp_path: Path) -> None:
    """`Arrived` and `Skipped` wait for the same message: their guards say for which pieces."""
    for number, name in ((1, "Arrived"), (2, "Skipped")):
        net = FORGOTTEN.replace("place Pieces : INT = 1`1", f"place Pieces : INT = 1`{number}")
        opened = open_net(write(tmp_path / name, net), {})
        partition = divide(opened.flat, opened.config, Diagnostics())
        assert partition is not None
        game = Game(opened.flat)
        for _ in game.run(steps=10):
            pass
        assert supervisor_waits(game, partition) == SUPERVISOR.replace("Arrived", name)


def test_a_supervisor_that_does_not_wait(tmp_path: Path) -> None:
    """Of a program whose own tokens are in the way the transitions are named that lack least."""
    cell = write(tmp_path, NET.replace("trans Next guard [n <= 3]", "trans Next guard [n > 3]"))
    done = CliRunner().invoke(app, ["verify", str(cell), "--no-medium"])
    lines = [line.strip() for line in done.output.splitlines()]
    at = lines.index("After that nothing can occur:")
    assert lines[at + 1] == "`Next` cannot occur: its guard `n > 3` is false with n = 1."
    assert lines[at + 2].startswith("Robot `robot1` waits for `flag` (robot1.tdl:")


OCCUPIED = NET.replace(
    "    place Going = 0\n",
    "    place Going = 0\n    place Mode : INT = 1`1\n    place Zone = 1\n"
    "    trans Ask\n      both Mode : n\n      in done : 99\n",
    1,
).replace("      in Ready : ()\n", "      in Ready : ()\n      in Zone : ()\n", 1)
"""Nobody gives the zone back, and there is always a transition that waits for a message."""


@pytest.mark.parametrize("options", [(), ("--full",)])
def test_the_token_that_somebody_has_forgotten_is_named(
    tmp_path: Path, options: tuple[str, ...]
) -> None:
    cell = write(tmp_path, OCCUPIED)
    done = CliRunner().invoke(app, ["verify", str(cell), "--no-medium", *options])
    assert done.exit_code == 1, done.output
    lines = [line.strip() for line in done.output.splitlines()]
    at = lines.index("After that nothing can occur:")
    # Not the transitions for which the end of a run, and not only a zone, is missing.
    assert lines[at + 1 : at + 3] == [
        "`Next` cannot occur: place `Zone` is empty, which it was not at the start.",
        "The supervisor waits: `Ask` needs a message in `done`.",
    ]
    assert lines[at + 3].startswith("Robot `robot1` waits for `flag` (robot1.tdl:")
    assert lines[at + 4] == ""
