"""Compiled nets against a real ML: the suite of tests/ml_suite, one net a topic, one place a case."""

from __future__ import annotations

from dataclasses import replace

import pytest

from helpers.compiled import Workshop, lowered, run
from helpers.netbuilder import flat
from ml_suite import suite
from pn2code.ml import core
from pn2code.ml.types import STRING, UNIT, TFun
from pn2code.net.flat import FlatNet, Form

pytestmark = pytest.mark.cc

NET = 'net Suite\n  standard\n  place P : STRING = 1`""'


def net_of(session: suite.Session, cases: list[suite.Case]) -> FlatNet:
    """Each case is the initial marking of a place."""
    base = flat(NET)
    program = session.elaborator.program()
    [place] = base.places
    assert place.initial is not None
    span = place.initial[0].span
    places = []
    for i, case in enumerate(cases):
        symbol = program.globals[case.function]
        function = core.Var(symbol, TFun(UNIT, STRING), span)
        value = core.Apply(function, core.RecordExp((), UNIT, span), STRING, span)
        changed = replace(
            place, index=i, name=f"Top.P{i}", short=f"P{i}", initial=(value, Form.TOKEN)
        )
        places.append(changed)
    return replace(base, program=program, places=tuple(places))


def outcomes(cases: list[suite.Case], workshop: Workshop, name: str) -> dict[str, str]:
    """Name -> result in C, or what is wrong. Cases that stop all others are done by themselves."""
    session = suite.Session()
    found: dict[str, str] = {}
    defined = []
    for case in cases:
        try:
            session.define(case)
            defined.append(case)
        except suite.NotShowable as problem:
            found[case.name] = f"refused: {problem}"
    waiting = [defined]
    while waiting:
        part = waiting.pop()
        results = _results(net_of(session, part), workshop, f"{name}-{part[0].number}-{len(part)}")
        if isinstance(results, str):
            if len(part) == 1:
                found[part[0].name] = results
            else:
                middle = len(part) // 2
                waiting += [part[middle:], part[:middle]]
        else:
            found |= {case.name: text for case, text in zip(part, results, strict=True)}
    return found


def _results(net: FlatNet, workshop: Workshop, name: str) -> list[str] | str:
    """The texts in all places, or why there are none."""
    ir, d = lowered(net, capacity={p.name: 1 for p in net.places})
    if ir is None:
        return f"refused: {d.errors[0].message}"
    try:
        [line] = run(workshop.build(ir, workshop.folder / name), 1, 0)
    except AssertionError as problem:
        return f"failed: {problem}"
    if "error" in line:
        return f"stopped: {line['error']}"
    return [line["marking"][p.name][0][1] for p in net.places]


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Workshop:
    return Workshop.open(tmp_path_factory.mktemp("suite"))


@pytest.mark.parametrize("topic", suite.topics())
def test_results(topic: str, workshop: Workshop) -> None:
    skipped = suite.not_compiled()
    cases = suite.cases(topic)
    found = outcomes([c for c in cases if c.name not in skipped], workshop, topic)
    wrong = [c for c in cases if c.name in found and found[c.name] != c.expected]
    assert not wrong, f"{len(wrong)} of {len(found)}\n" + "\n".join(
        f"{c.name}: {c.text}\n  gives {found[c.name][:1500]}, not {c.expected}" for c in wrong
    )
