"""A few random cells: what `verify` proves of them holds in their runs. `./dev adversary` has them by the thousand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random

import pytest
from tools.adversary import bed, claims, wander
from tools.adversary.cells import random_cell
from tools.adversary.judge import Said, contradictions

from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics

SEEDS = (2, 4, *range(20, 60))[: amount(1, 42)]
STUCK = 2


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_proved_holds_in_runs(seed: int, tmp_path: Path) -> None:
    verdict = bed.judge(seed, tmp_path, runs=4)
    assert not verdict.wrong
    assert sum(verdict.counts[f"run {end}"] for end in ("finished", "stuck", "endless")) > 0


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
def test_a_false_yes_would_be_found(tmp_path: Path) -> None:
    """A cell that gets stuck, of which everything is said to be so."""
    claim = claims.at_most("Top.Supervisor.Idle1", 0)
    cell = replace(random_cell(Random(STUCK)), claims=(claim,))
    bed.write(cell, tmp_path)
    built = wander.prepare(tmp_path, Diagnostics())
    assert built is not None
    checks = dict.fromkeys(("non-blocking", "channels", "finite-response"), {"answer": "yes"})
    said = Said(0, checks, (), ("yes",), {})
    runs = [wander.run(built, seed) for seed in range(4)]
    found = "\n".join(contradictions(cell, said, runs, built))
    assert "non-blocking is yes" in found
    assert "is yes, but not after" in found
