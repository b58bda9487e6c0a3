"""The reference evaluator against a real ML: the suite of tests/ml_suite."""

from __future__ import annotations

import pytest

from ml_suite import suite
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.data import UNIT, MlException, MlLimit

FEWEST = 1150


def outcomes(cases: list[suite.Case]) -> dict[str, str]:
    """Name -> result in the reference evaluator, or what is wrong."""
    session = suite.Session()
    found: dict[str, str] = {}
    defined = []
    for case in cases:
        try:
            session.define(case)
            defined.append(case)
        except suite.NotShowable as problem:
            found[case.name] = f"refused: {problem}"
    program = session.elaborator.program()
    evaluator = Evaluator(program)
    for case in defined:
        function = evaluator.globals[program.globals[case.function].uid]
        try:
            found[case.name] = str(evaluator.apply(function, UNIT))
        except (MlException, MlLimit) as problem:
            found[case.name] = f"stopped: {problem}"
    return found


@pytest.mark.parametrize("topic", suite.topics())
def test_results(topic: str) -> None:
    cases = suite.cases(topic)
    found = outcomes(cases)
    assert all(case.expected is not None for case in cases), "run ./dev ml-suite"
    wrong = [c for c in cases if found[c.name] != c.expected]
    assert not wrong, "\n".join(
        f"{c.name}: {c.text}\n  gives {found[c.name]}, not {c.expected}" for c in wrong
    )


def test_there_are_many() -> None:
    assert sum(len(suite.cases(topic)) for topic in suite.topics()) >= FEWEST


def test_cases_that_are_not_compiled_exist() -> None:
    names = {case.name for topic in suite.topics() for case in suite.cases(topic)}
    assert suite.not_compiled().keys() <= names
