"""A sample of the collected nets, compiled and walked through next to the token game; `./dev walks` takes them all."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop
from helpers.thorough import amount
from helpers.walks import Walk, nets, walk

pytestmark = pytest.mark.cc

EVERY = amount(122, 17)
"""One net of so many; one of those of so many again with sanitizers."""


def sample(shared: Path, every: int, first: int) -> list[Path]:
    return nets(shared)[first::every]


def walked(shared: Path, workshop: Workshop, paths: list[Path], steps: int) -> list[Walk]:
    results = []
    for path in paths:
        name = path.relative_to(shared).as_posix()
        results.append(walk(path, name, workshop, steps=steps, seconds=3.0))
    return results


def assert_agree(results: list[Walk]) -> None:
    assert results
    for result in results:
        assert result.verdict in ("agrees", "rejected"), result
    assert sum(r.verdict == "agrees" for r in results) > len(results) // 2


def test_nets_agree(shared: Path, fast_workshop: Workshop) -> None:
    assert_agree(walked(shared, fast_workshop, sample(shared, EVERY, 3), 100))


def test_nets_agree_with_sanitizers(shared: Path, workshop: Workshop) -> None:
    assert_agree(walked(shared, workshop, sample(shared, EVERY * 3, 5), 30))
