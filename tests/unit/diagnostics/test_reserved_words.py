# ruff: noqa: E501 - rows of texts
"""Declarations that the engine of CPN Tools refuses though they are Standard ML; it was asked about each of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import cpn, diagnose
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load


def errors(declarations: str, rest: str = "") -> list[str]:
    """The codes of the errors in a net with these declarations, one a line."""
    lines = "\n".join(f"  {line}" for line in declarations.splitlines())
    text = f"net N\n  standard\n{lines}\n  place A : INT = 1`1\n{rest}"
    return [x.code for x in diagnose(text).errors]


@pytest.mark.parametrize(
    "text",
    [
        "var ms: INT;", "var Node, n: INT;", "colset product = int;", "colset E = with a | time;",
        "colset I = index ms with 1..3;", "colset U = union ms: INT + b;", "colset R = record all: INT * b: INT;",
        "colset E = with col | red;", "colset B = bool with (no, time);", "colset U = unit with ms;", "val size = 3", "fun color x = x", "fun f x = x and time y = y",
        "val (size, x) = (1, 2)", "val x as time = 3", "val {a = time} = {a = 3}", "val SOME time = SOME 3", "val rec size = fn x => x + 1",
        "val op size = 3", "type ms = int", "datatype d = A of int | Node", "datatype time = A", "exception ms of int",
        "structure Node = struct val x = 1 end", "local val q = 3 in val ms = q end", "fun size 0 = 1 | size n = 2",
    ],
)  # fmt: skip
def test_a_reserved_word_cannot_be_declared(text: str) -> None:
    assert "reserved-word" in errors(text)


@pytest.mark.parametrize(
    "text",
    [
        "globref size = 3;", "fun f time = time", "local val ms = 3 in val x = ms end", "val x = let val ms = 3 in ms end",
        "structure S = struct val ms = 3 fun size x = x end", "val {ms = y} = {ms = 3}", "type t = {ms: int, size: int}",
        "val x = #size {size = 3}", "fun f x = case x of ms => ms", "abstype t = MM of int with val time = 1 end",
        "datatype t = A of int withtype time = int", "val _ = 3", "structure S : sig val x : int end = struct val x = 3 end",
        "functor F (X : sig end) = struct val x = 3 end", "exception E = Fail", 'val x = "open Int"',
    ],
)  # fmt: skip
def test_inside_other_things_the_words_are_names(text: str) -> None:
    assert errors(text) == []


@pytest.mark.parametrize(
    "text",
    [
        "open Int", "local open Int in val y = abs 3 end", "structure S = struct open Int end", "val x = let open Int in abs 3 end",
        "signature S = sig val x : int end", "datatype t = datatype order", "3 + 4", "val x = ref 3; x := 4",
    ],
)  # fmt: skip
def test_what_is_no_declaration_of_cpn_ml(text: str) -> None:
    assert errors(text) == ["not-in-cpn-ml"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("datatype d = INT.mkstr", "syntax-error"), ("exception INT.x", "syntax-error"),
        ("fun INT.x y = 3", "fixity-error"), ("datatype d = A | INT.x", "syntax-error"),
    ],
)  # fmt: skip
def test_members_of_structures_cannot_be_declared(text: str, code: str) -> None:
    assert errors(text) == [code]


@pytest.mark.parametrize(
    "text",
    [
        "colset E = with v | w;", "datatype d = v | w", "exception v", "colset U = union v: INT + w;",
        "colset I = index v with 1..3;",
    ],
)  # fmt: skip
def test_a_variable_that_has_become_a_constructor(text: str) -> None:
    assert errors(f"var v: INT;\n{text}") == []
    use = "  trans T\n    in A : v\n"
    assert errors(f"var v: INT;\n{text}", use) == ["variable-named-as-value"]


@pytest.mark.parametrize(
    "text", ["val v = 3", "fun v x = x", "colset v = int;", "colset Q = unit with v;"]
)
def test_a_variable_beside_something_else_of_its_name(text: str) -> None:
    assert errors(f"var v: INT;\n{text}", "  trans T\n    in A : v\n    out A : v\n") == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", ["declaration-empty"]),
        ("(* nothing *)", ["declaration-empty"]),
        ("(* a *) val x = 3", []),
        ("val x = 3 (* b *)", []),
    ],
)
def test_a_declaration_that_says_nothing(tmp_path: Path, text: str, said: list[str]) -> None:
    path = tmp_path / "N.cpn"
    net = cpn("net N\n  standard\n  val marked = 1\n  place A : INT = 1`1\n")
    path.write_bytes(net.replace(b"val marked = 1", text.encode()))
    d = Diagnostics()
    assert load(path, d) is not None
    assert [x.code for x in d] == said


@pytest.mark.parametrize(
    ("bounds", "said"),
    [
        ("1..3", ["intinf-bound", "intinf-bound"]),
        ("(1 : IntInf.int)..(3 : IntInf.int)", []),
    ],
)
def test_bounds_of_unlimited_integers(bounds: str, said: list[str]) -> None:
    d = diagnose(f"net N\n  standard\n  colset I = intinf with {bounds};\n  place A : INT = 1`1\n")
    assert [x.code for x in d] == said and not d.errors
