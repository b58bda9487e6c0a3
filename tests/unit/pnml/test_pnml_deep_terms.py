"""Conditions of thousands of cases, written as operators inside one another."""

from __future__ import annotations

import pytest

from helpers.coloured_nets import ColouredNet, Range, eq
from pn2code.diagnostics import Diagnostics
from pn2code.pnml.read import read_data
from pn2code.reading.document import Document


def read(guard: object) -> tuple[Document | None, Diagnostics]:
    net = ColouredNet(
        {"N": Range(0, 9)}, {"x": "N"}, {"A": ("N", 3)}, [("t", guard, {"A": "x"}, {"A": "x"})]
    )
    d = Diagnostics()
    return read_data(net.pnml().encode(), "net.pnml", d), d


def guard_of(document: Document | None) -> str:
    assert document is not None
    guard = document.pages[0].transitions[0].guard
    assert guard is not None
    assert guard.text is not None
    return guard.text.text


def nested(operator: str, count: int, *, left: bool) -> object:
    term: object = eq("x", 0)
    for i in range(1, count):
        case = eq("x", i % 10)
        term = (operator, term, case) if left else (operator, case, term)
    return term


@pytest.mark.parametrize("left", [True, False])
def test_a_chain_of_cases_is_no_nest(left: bool) -> None:
    document, d = read(nested("or", 150, left=left))
    assert document is not None, d.errors
    text = guard_of(document)
    cases = [f"x = {i % 10}" for i in range(150)]
    ordered = cases if left else [*cases[1:][::-1], cases[0]]
    assert text.replace("(", "").replace(")", "") == " orelse ".join(ordered)


def test_conjuncts_however_nested_are_parts_of_the_guard() -> None:
    document, d = read(nested("and", 150, left=True))
    assert document is not None, d.errors
    assert guard_of(document).count(", ") == 149


def test_what_is_a_nest_is_refused() -> None:
    term: object = eq("x", 0)
    for _ in range(150):
        term = ("not", term)
    document, d = read(term)
    assert document is None
    (error,) = d.errors
    assert (error.code, error.message) == (
        "unsupported-pnml",
        "operators are nested more than 100 levels deep",
    )


def test_only_terms_may_be_that_deep() -> None:
    sort = "<productsort>" * 300 + "<dot/>" + "</productsort>" * 300
    data = f'<pnml><net id="n" type="x/symmetricnet"><declaration>{sort}</declaration></net></pnml>'
    d = Diagnostics()
    assert read_data(data.encode(), "net.pnml", d) is None
    assert [e.code for e in d.errors] == ["xml-limit"]
