"""Runs that the token game gives up to play again: a warning says so, and the answer is that of the explorer."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from helpers.processes import pn2code
from pn2code.semantics.evaluation import evaluate
from pn2code.semantics.game import token_game

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """net deep
  standard
  var n: INT;
  fun depth 0 = 0 | depth n = 1 + depth (n - 1)
  page Main
    place Start : INT = 1`{depth}
    place Deep : INT
    trans Dive
      in Start : n
      out Deep : depth n
"""


STEPS = 100_000


def impatient() -> None:
    """The token game gives up after a tenth of the steps that it takes for users."""
    fewer = partial(evaluate.Limits, steps=STEPS)
    evaluate.Limits = token_game.Limits = fewer  # type: ignore[misc, assignment]


@pytest.mark.usefixtures("as_delivered")  # how deep a compiled net goes depends on its compiler
@pytest.mark.parametrize(("depth", "is_played"), [(1000, True), (20_000, False)])
def test_a_run_that_takes_the_token_game_too_long(
    depth: int, is_played: bool, tmp_path: Path
) -> None:
    net = tmp_path / "deep.cpn"
    net.write_bytes(cpn(NET.format(depth=depth)))
    done = pn2code(
        "verify", net, "--traces", tmp_path, "--property", "reachable tokens(Deep) >= 1", "--json", prepare=impatient
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    (found,) = json.loads(done.stdout)["properties"]
    assert found["answer"] == "yes"
    assert found["evidence"]["confirmed"] == is_played
    assert ("warning[property-unplayed]: the run that shows why" in done.stderr) != is_played
    assert (f"was given up: no end after {STEPS} steps" in done.stderr) != is_played
    assert "bug" not in done.stderr
