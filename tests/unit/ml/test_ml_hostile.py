"""Texts that are made to break a checker: they are checked, or refused with a word about limits, in bounded work."""

from __future__ import annotations

import pytest

from helpers.ml import Ml
from pn2code.ml import library
from pn2code.ml.parsing.lexer import MAX_TOKENS
from pn2code.ml.typing.unifier import MAX_WORK

N = 1500


def codes_of(text: str) -> list[str]:
    m = Ml()
    m.ml(text)
    m.e.program()
    return [x.code for x in m.d if x.severity.value == "error"][:1]


@pytest.mark.parametrize(
    "text",
    [
        "#1(" * N + "y" + ")" * N,
        "#1 " * N + "y",
        "~ " * N + "5",
        "~(" * N + "5" + ")" * N,
        "(" * N + "5" + ")" * N,
        "[" * N + "5" + "]" * N,
        "if true then 1 else " * N + "5",
        "if " * N + "true" + " then true else false" * N,
        "let val a = 1 in " * N + "a" + " end" * N,
        "fn x => " * N + "x",
        "case 1 of y => " * N + "y",
        "1" + " handle _ => 1" * N,
        "1" + " : int" * N,
        "f " + " ".join(["1"] * N),
    ],
)
def test_deep_nesting_is_refused(text: str) -> None:
    assert codes_of("val x = " + text) == ["too-deep"]


@pytest.mark.parametrize(
    "text",
    [
        "val x = [" + ",".join(map(str, range(N))) + "]",
        'val x = "' + "a" * 1_000_000 + '"',
        "val x = " + " ^ ".join(['"a"'] * N),
        "val x = " + " ++ ".join(["1`1"] * N),
        "val x = (" + ";".join(["()"] * N) + ")",
        "val x = let " + " ".join(f"val a{i} = {i}" for i in range(N)) + " in a1 end",
        " ".join(f"val a{i} = {i}" for i in range(N)),
        "fun " + " | ".join(f"f {i} = {i + 1}" for i in range(N)) + " | f _ = 0",
        "datatype t = " + " | ".join(f"C{i}" for i in range(N)) + " fun f C0 = 0 | f _ = 2",
        "val x = 1 " + "(* " * N + " *)" * N,
        "val x : " + "(" * N + "int" + ")" * N + " = 3",
        "fun f (x : " + "int -> " * 1000 + "int) = 3",
        "fun f [" + ",".join(f"x{i}" for i in range(1000)) + "] = 3 | f _ = 4",
        "fun f " + " ".join(f"x{i}" for i in range(1000)) + " = 3",
        " ".join(f"structure A{i} = struct val x = {i} end" for i in range(1000)),
    ],
)
def test_long_texts_are_checked(text: str) -> None:
    assert codes_of(text) == []


def test_a_text_is_searched_for_names_of_the_library_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many declarations it has."""
    pattern = library._pattern()
    searched: list[int] = []

    class Watched:
        def findall(self, text: str) -> list[str]:
            searched.append(len(text))
            return pattern.findall(text)

    monkeypatch.setattr(library, "_pattern", Watched)
    text = " ".join(f"val once{i} = {i}" for i in range(50))
    assert codes_of(text) == []
    assert searched.count(len(text)) == 1


def _twice(n: int, form: str) -> str:
    """Each function applies the one before twice: the type doubles each time."""
    return " ".join(form.format(i=i, j=i - 1) for i in range(1, n))


@pytest.mark.parametrize(
    "text",
    [
        "fun f0 x = (x, x) " + _twice(40, "fun f{i} x = f{j} (f{j} x)"),
        "val x = let val f0 = fn x => (x, x) "
        + _twice(40, "val f{i} = fn x => f{j} (f{j} x)")
        + " in f39 end",
        "val x = fn z => let val x0 = z " + _twice(60, "val x{i} = (x{j}, x{j})") + " in x59 end",
        "type t0 = int " + _twice(60, "type t{i} = t{j} * t{j}") + " fun f (x : t59) = x",
        "type 'a t0 = 'a "
        + _twice(60, "type 'a t{i} = 'a t{j} * 'a t{j}")
        + " val x : int t59 = 3",
    ],
)
def test_types_that_double_are_refused(text: str) -> None:
    assert codes_of(text) == ["ml-type-too-large"]
    assert MAX_WORK <= 5_000_000


def test_a_text_with_too_many_symbols_is_refused() -> None:
    assert codes_of("val x = [" + "1," * (MAX_TOKENS // 2 + 1) + "1]") == ["text-too-long"]


def test_many_unknown_names_are_all_reported() -> None:
    m = Ml()
    m.ml(" ".join(f"val b{i} = undefined{i}" for i in range(1000)))
    assert len(m.d.errors) == 1000
