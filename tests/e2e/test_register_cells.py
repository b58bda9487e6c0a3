"""A few random cells with registers, asked in several ways and run. `./dev registers` has them by the hundred."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random

import pytest
from tools.adversary import bed as adversary
from tools.adversary import wander
from tools.adversary.judge import Said, ask, contradictions
from tools.register_cells.bed import judge, without_passes
from tools.register_cells.cells import random_cell, seen_late

from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]
SEEDS = tuple(range(2000, 2000 + amount(1, 40)))


@pytest.mark.parametrize("seed", SEEDS)
def test_all_ways_agree_and_runs_contradict_none(seed: int, tmp_path: Path) -> None:
    verdict = judge(seed, tmp_path, runs=amount(4, 8))
    assert not verdict.wrong
    assert verdict.counts["claim yes"] > 0


def test_a_false_yes_would_be_found(tmp_path: Path) -> None:
    """That a device has always seen the value of the moment is false, and in most runs it is seen to be."""
    cell = random_cell(Random(2))
    cell = replace(cell, claims=(seen_late("First"),))
    adversary.write(cell, tmp_path)
    built = wander.prepare(tmp_path, Diagnostics())
    assert built is not None
    said = Said(0, {}, (), ("yes",), {})
    runs = [wander.run(built, seed) for seed in range(8)]
    assert "is yes, but not after" in "\n".join(contradictions(cell, said, runs, built))


def test_without_passes_less_is_known(tmp_path: Path) -> None:
    """Where a device looks after it was told to: else the comparison would compare a model with itself."""
    answers = []
    cell = next(c for c in map(random_cell, map(Random, range(99))) if "in Told" in c.net)
    adversary.write(cell, tmp_path)
    said = ask(tmp_path, cell, ("--no-medium",))
    with without_passes():
        loose = ask(tmp_path, cell, ("--no-medium",))
    assert not isinstance(said, str) and not isinstance(loose, str)
    answers = [said.claims[0], loose.claims[0]]  # that it is fresh
    assert answers == ["yes", "inconclusive"]
