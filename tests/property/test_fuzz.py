"""Half a minute of fuzzing, always the same cases; `make fuzz` goes on for ten minutes, `make thorough` takes more."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.helpers.netbuilder import cpn
from tests.helpers.thorough import amount
from tools.fuzz.__main__ import Worker, fuzz, make
from tools.fuzz.nets import MIXED, TIMED, bases

ROOT = Path(__file__).resolve().parents[2]

NOWHERE = Path("/nonexistent")
CASES = amount(8, 400)
FIRST = [0, 1_000, 2_000][: amount(1, 3)]
"""In the ordinary run one worker, which takes as long to start as twenty cases do, has all of the examples' cases."""


def test_base_nets_are_accepted(tmp_path: Path) -> None:
    worker = Worker()
    try:
        for i, text in enumerate((MIXED, TIMED)):
            path = tmp_path / f"net{i}.cpn"
            path.write_bytes(cpn(text))
            assert worker.ask(path) == "ok accepted"
    finally:
        worker.close()


def test_a_case_is_always_the_same() -> None:
    nets = bases(ROOT, NOWHERE)
    assert [make(case, nets) for case in range(20)] == [make(case, nets) for case in range(20)]


def test_a_worker_survives_nothing_silently(tmp_path: Path) -> None:
    worker = Worker()
    try:
        assert "FileNotFoundError" not in worker.ask(tmp_path / "missing.cpn")
        assert worker.ask(tmp_path / "missing.cpn") == "ok rejected"
    finally:
        worker.close()


@pytest.mark.parametrize("first", FIRST)
def test_changed_nets_are_diagnosed(first: int) -> None:
    cases = range(first, first + CASES * amount(3, 1))
    outcome = fuzz(bases(ROOT, NOWHERE), cases, seconds=600.0)
    assert sum(outcome.counts.values()) == len(cases)
    assert not outcome.failures, "\n\n".join(f"case {f.case}: {f.why}" for f in outcome.failures)


def test_changed_nets_of_strangers_are_diagnosed(shared: Path) -> None:
    outcome = fuzz(bases(ROOT, shared), range(5_000, 5_000 + CASES), seconds=600.0)
    assert not outcome.failures, "\n\n".join(
        f"case {f.case} of {f.base}: {f.why}" for f in outcome.failures
    )
