"""The front end and the token game against what the real CPN Tools engine recorded of nets that people published."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from pn2code.engine_comparison.compare import Compared, compare, paths
from pn2code.engine_comparison.document import document
from pn2code.engine_comparison.finding import State

pytestmark = pytest.mark.shared

LARGEST_SPACE = 100
FEWEST_SAME = {
    "verdict": 151,
    "elements": 151,
    "initial marking": 125,
    "run": 85,
    "state space": 37,
}
"""So many nets simply agree at least: one that is suddenly passed over does not go unnoticed."""
FEWEST_RUNNING = 0.97
"""Of the nets that the engine accepts."""


@cache
def all_compared(shared: Path) -> tuple[Compared, ...]:
    corpus = shared / "corpus"
    return tuple(compare(corpus, path, max_nodes=LARGEST_SPACE) for path in paths(corpus))


@pytest.mark.parametrize("question", FEWEST_SAME)
def test_agreement(shared: Path, question: str) -> None:
    wrong, same = [], 0
    for net in all_compared(shared):
        finding = net.findings[question]
        same += finding.state is State.AGREES
        if finding.state is State.DIFFERS:
            wrong.append(f"{net.path}: {finding.note}")
    assert not wrong, "\n".join(wrong)
    assert same >= FEWEST_SAME[question]


def test_nets_run(shared: Path) -> None:
    accepted = [net for net in all_compared(shared) if net.accepted]
    still = [net.path for net in accepted if not net.runs and not net.surroundings]
    assert not still
    assert sum(net.runs for net in accepted) >= FEWEST_RUNNING * len(accepted)


def test_what_is_random_is_little(shared: Path) -> None:
    """Where a net draws, most is determined all the same: not every place is taken as recorded."""
    drawn = [n for n in all_compared(shared) if n.findings["run"].state is State.RANDOM]
    assert 10 < len(drawn) < 30
    assert sum("and" not in n.findings["run"].note for n in drawn) > 5


def test_the_document_tells_what_was_found(shared: Path) -> None:
    nets = all_compared(shared)
    text = document(nets, {}, {}, {})
    assert text == document(nets, {}, {}, {})
    assert f"* {len(nets)} nets; the engine accepts" in text
    assert all(f"| `{net.path}` |" in text for net in nets)
