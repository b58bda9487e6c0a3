"""The same inscription at another place: the same meaning, other positions."""

from __future__ import annotations

import pytest

from helpers.ml import Ml
from pn2code.diagnostics import Diagnostics, Origin, SourceText, Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.dump import dump_exp
from pn2code.ml.core.types import INT, list_of


def at(text: str, line: int, part: str = "inscription") -> SourceText:
    return SourceText(text, Origin("cell.cpn", line, 5, part=part))


def token(m: Ml, text: SourceText) -> core.Exp:
    found = m.e.expression(text, (INT, list_of(INT)), expected_name="INT")
    assert found is not None, m.messages()
    return found[1]


def spans(e: object) -> list[Span]:
    """All places in an expression."""
    if isinstance(e, Span):
        return [e]
    if isinstance(e, tuple):
        return [s for x in e for s in spans(x)]
    fields = getattr(e, "__dataclass_fields__", {}) if not isinstance(e, core.Symbol) else {}
    return [s for name in fields for s in spans(getattr(e, name))]


@pytest.mark.parametrize(
    "text",
    ["n", "1`n ++ 2`3", "if n > 3 then 1`(n + 1) else empty", "#1 p", "[n, hd [m]]", "(n; m)"],
)
def test_what_is_moved_stands_where_its_text_stands(text: str) -> None:
    m = Ml()
    first, second = token(m, at(text, 1)), token(m, at(text, 20))
    assert dump_exp(first) == dump_exp(second)
    assert first == second
    own = at(text, 20)
    assert {s.source for s in spans(second)} == {own}
    assert [(s.start, s.end) for s in spans(first)] == [(s.start, s.end) for s in spans(second)]


def test_names_bound_inside_are_others_each_time() -> None:
    m = Ml()
    first, second = (token(m, at("let val k = n in k + k end", line)) for line in (1, 2))
    assert isinstance(first, core.Let)
    assert dump_exp(first) == dump_exp(second)
    assert first != second


def test_the_same_mistake_is_reported_at_each_place() -> None:
    m = Ml()
    for line in (1, 2):
        assert m.e.expression(at("n + s", line), (INT,), expected_name="INT") is None
    assert [x.origin.line for x in m.d] == [1, 2]


def test_a_declaration_between_changes_the_meaning() -> None:
    m = Ml()
    m.e.declarations(SourceText("fun g x = x + 1", Origin("cell.cpn", 1, 1)))
    before = token(m, at("g 1", 2))
    m.e.declarations(SourceText("fun g x = x + 2", Origin("cell.cpn", 3, 1)))
    after = token(m, at("g 1", 4))
    assert isinstance(before, core.Apply)
    assert isinstance(after, core.Apply)
    assert before.function != after.function


def test_what_is_declared_aside_is_forgotten_afterwards() -> None:
    m = Ml()
    before = token(m, at("n", 1))
    with m.e.aside(Diagnostics()):
        m.e.declarations(SourceText("val limit = 3", Origin("cell.cpn", 2, 1)))
        assert isinstance(token(m, at("limit", 3)), core.Var)
    assert m.e.expression(at("limit", 4), (INT,), expected_name="INT") is None
    assert token(m, at("n", 5)) == before


def test_an_initial_marking_knows_no_variables_of_the_net() -> None:
    m = Ml()
    token(m, at("n", 1))
    assert m.e.expression(at("n", 2, "initial marking"), (INT,), expected_name="INT") is None
    assert [x.origin.line for x in m.d] == [2]


def test_guards_and_delays() -> None:
    m = Ml()
    for ask in (m.e.guard, m.e.delay):
        text = "[n > 3, b]" if ask == m.e.guard else "@+ n"
        first, second = ask(at(text, 1)), ask(at(text, 9))
        assert first == second is not None
        assert {s.source.origin.line for s in spans(second)} == {9}
