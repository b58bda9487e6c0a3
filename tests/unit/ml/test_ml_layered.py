"""Arc inscriptions `x as pattern`, and guards that compute a list."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.terms import PAs
from pn2code.net.flat import FlatNet
from pn2code.net.front import load

NET = """net N
  standard
  colset P = product INT * STRING;
  colset U = union A:INT + B;
  colset Q = product INT * STRING timed;
  var x : P;
  var q : Q;
  var n,m : INT;
  var s : STRING;
  var u : U;
  place A : P = 1`(1,"a")++1`(2,"b")
  place Z : Q
  place B : INT
  place D : U = 1`(A 3)++1`B
  trans T
    """


def loaded(tmp_path: Path, arcs: str) -> tuple[FlatNet | None, list[str]]:
    path = tmp_path / "net.cpn"
    path.write_bytes(cpn(NET + arcs))
    d = Diagnostics()
    return load(path, d), [f"{x.code} | {x.message}" for x in d]


@pytest.mark.parametrize(
    ("arc", "variables"),
    [
        ("in A : x as (n, s)", ["n", "s", "x"]),
        ("in A : x as (n, _)", ["n", "x"]),
        ("in A : x : P as (_, s)", ["s", "x"]),
        ("in D : u as A n", ["n", "u"]),
        ("both A : x as (1, s)", ["s", "x"]),
    ],
)
def test_binds_the_token_and_its_parts(tmp_path: Path, arc: str, variables: list[str]) -> None:
    flat, said = loaded(tmp_path, arc)
    assert flat is not None, said
    (transition,) = flat.transitions
    assert [v.name for v in transition.variables] == variables
    assert transition.arcs[0].inscription is not None
    (term,) = transition.arcs[0].inscription.terms
    assert isinstance(term.pattern, PAs)
    assert len(transition.guards) == 1  # that the parts fit, where they are bound elsewhere


@pytest.mark.parametrize(
    ("arc", "expected"),
    [
        ("in A : x as (n, k)", "unbound-identifier | `k` is not a variable of the net"),
        ("in A : k as (n, _)", "unbound-identifier | `k` is not declared"),
        ("in A : x as (n, m)", "type-mismatch | `m` is `string`, but `int` is expected"),
        (
            "in A : n as (m, _)",
            "type-mismatch | inscription is `int`, but `int * string` is expected",
        ),
        ("out A : x as (n, _)", "syntax-error | `as` cannot be used here"),
        ("in Z : q as (n, _)", "syntax-error | `as` cannot be used here"),
        ("in A : 1`(x as (n, _))", "syntax-error | `as` cannot be used here"),
    ],
)
def test_errors(tmp_path: Path, arc: str, expected: str) -> None:
    flat, said = loaded(tmp_path, arc)
    assert flat is None
    assert said == [expected]


def test_as_inside_an_expression_is_one_of_a_rule(tmp_path: Path) -> None:
    _, said = loaded(tmp_path, "out A : case (1, s) of y as (_, _) => y\n    in A : (n, s)")
    assert said == []


def test_a_guard_may_compute_a_list(tmp_path: Path) -> None:
    guard = "in A : (n, s)\n    guard [n > 1] ^^ map (fn k => n = k) [1, 2]"
    flat, said = loaded(tmp_path, guard)
    assert flat is not None, said
    assert len(flat.transitions[0].guards) == 1


def test_cpn_tools_refuses_as_on_arcs(tmp_path: Path) -> None:
    net, said = loaded(tmp_path, "in A : x as (n, _)")
    assert net is not None
    assert [x for x in said if x.startswith("arc-as-pattern")] == [
        "arc-as-pattern | CPN Tools refuses `as` on an arc: arc `A` -> `T` is accepted by pn2code only"
    ]
