"""Infix operators whose names the engine of CPN Tools uses in code of its own; what it says of them was asked."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose

NET = """
net Infix
  colset INT = int;
  {first};
  colset E = with red | green;
  colset P2 = product INT * E;
  {second};
  var n, m : INT;
  place A : INT = 1`1
  trans T
    in A : n
    out A : n + 1
"""


def said(first: str = "val one = 1", second: str = "val two = 2") -> list[tuple[str, str]]:
    d = diagnose(NET.format(first=first, second=second))
    return [(i.severity.value, i.code) for i in d.items]


@pytest.mark.parametrize("name", ["lt", "ord", "size", "mkstr_ms", "input", "cmp"])
def test_a_colour_set_cannot_be_declared_after_its_own_function_became_infix(name: str) -> None:
    found = said(first=f"infix 5 {name}")
    assert found.count(("error", "engine-infix")) == 2
    assert ("error", "engine-infix") not in said(second=f"infix 5 {name}")


def test_products_have_one_more() -> None:
    assert said(first="infixr mult").count(("error", "engine-infix")) == 1


def test_other_kinds_have_no_functions_of_their_own() -> None:
    others = ("int with 1..3", "list INT", "subset INT by (fn n => n > 1)", "INT timed", "string")
    lines = "\n".join(f"  colset X{i} = {kind};" for i, kind in enumerate(others))
    d = diagnose(f"net Others\n  colset INT = int;\n  infix lt;\n  infix size;\n{lines}\n")
    assert d.items == []
    for name, count in (("lt", 1), ("size", 1), ("ord", 0), ("cmp", 0)):
        d = diagnose(f"net Index\n  infix {name};\n  colset X = index ix with 1..2;\n")
        assert len(d.errors) == count


@pytest.mark.parametrize("name", ["cmp", "time", "not", "ref"])
def test_transitions_cannot_be_compiled(name: str) -> None:
    assert said(second=f"infix 5 {name}") == [("warning", "engine-infix")]


@pytest.mark.parametrize(
    "text",
    [
        "infix 5 max; fun a max b = if a > b then a else b : int",
        "structure S = struct infix cmp fun a cmp b = a < b end",
        "infix lt; nonfix lt",
        "nonfix mod; fun lastOf n = mod (n, 10); infix 7 mod",
    ],
)
def test_others_may_be_infix(text: str) -> None:
    assert said(first=text.replace("; ", ";\n  ")) == []
