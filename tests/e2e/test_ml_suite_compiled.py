"""Compiled nets against a real ML: the suite of tests/ml_suite, but for what `not_compiled.txt` lists."""

from __future__ import annotations

import pytest

from helpers.compiled import Workshop
from helpers.thorough import amount
from ml_suite import compiled, suite

pytestmark = pytest.mark.cc


@pytest.mark.parametrize("topic", suite.topics()[:: amount(6, 1)])
def test_results(topic: str, workshop: Workshop) -> None:
    known = suite.not_compiled()
    cases = [case for case in suite.cases(topic) if case.name not in known]
    found = compiled.outcomes(cases, workshop, topic)
    wrong = [c for c in cases if found[c.name] != c.expected]
    assert not wrong, f"{len(wrong)} of {len(found)}\n" + "\n".join(
        f"{c.name}: {c.text}\n  gives {found[c.name][:1500]}, not {c.expected}" for c in wrong
    )
