"""Compiled nets against a real ML: the suite of tests/ml_suite, but for what `not_compiled.txt` lists."""

from __future__ import annotations

import pytest

from helpers.compiled import Workshop
from ml_suite import compiled, suite

pytestmark = pytest.mark.cc


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Workshop:
    return Workshop.open(tmp_path_factory.mktemp("ml_suite"), compiled.FLAGS)


@pytest.mark.parametrize("topic", suite.topics())
def test_results(topic: str, workshop: Workshop) -> None:
    known = suite.not_compiled()
    cases = [case for case in suite.cases(topic) if case.name not in known]
    found = compiled.outcomes(cases, workshop)
    wrong = [c for c in cases if found[c.name] != c.expected]
    assert not wrong, "\n".join(
        f"{c.name}: {c.text}\n  gives {found[c.name]}, not {c.expected}" for c in wrong
    )
