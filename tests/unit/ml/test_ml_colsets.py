# ruff: noqa: E501  (tables: one case a line)
"""Colour sets: all kinds, bounds, constructors, and what is said of wrong ones."""

from __future__ import annotations

from typing import Any

import pytest

from helpers.ml import Ml
from pn2code.diagnostics import Origin
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.dump import dump_exp
from pn2code.ml.typing.colset_members import member_type, members_of


@pytest.mark.parametrize(
    ("kind", "ids", "more", "expected"),
    [
        ("unit", (), {}, "unit : unit"),
        ("unit", ("e",), {}, "unit with e : unit"),
        ("bool", (), {}, "bool : bool"),
        ("bool", ("no", "yes"), {}, "bool with (no, yes) : bool"),
        ("int", (), {}, "int : int"),
        ("int", (), {"texts": ("~2", "N * 2")}, "int with ~2..10 : int"),
        ("intinf", (), {}, "intinf : IntInf.int"),
        ("intinf", (), {"texts": ("0", "123456789012")}, "intinf with 0..123456789012 : IntInf.int"),
        ("time", (), {"timed": True}, "time timed : IntInf.int"),
        ("real", (), {"texts": ("0.0", "~1.5 + 3.0")}, "real with 0.0..1.5 : real"),
        ("string", (), {}, "string : string"),
        ("string", (), {"texts": ('"a"', '"z"')}, 'string with "a".."z" : string'),
        ("string", (), {"texts": ('"a"', '"c"', "1", "2")}, 'string with "a".."c" and 1..2 : string'),
        ("enum", ("one", "two"), {"timed": True}, "with one | two timed : X"),
        ("index", ("ph",), {"texts": ("1", "N")}, "index ph with 1..5 : X"),
        ("product", ("INT", "P"), {}, "product INT * P : int * (int * string)"),
        ("record", (), {"fields": (("z", "INT"), ("a", "L"))}, "record z:INT * a:L : {a: int list, z: int}"),
        ("list", ("P",), {}, "list P : (int * string) list"),
        ("list", ("E",), {"texts": ("0", "2")}, "list E with 0..2 : E list"),
        ("union", (), {"fields": (("A", "INT"), ("B", ""), ("C", "P"))}, "union A:INT + B + C:P : X"),
        ("subset", ("INT",), {"texts": ("even",), "by": True}, "subset INT by even : int"),
        ("subset", ("INT",), {"texts": ("(fn n => n > 3)",), "by": True}, "subset INT by fn n => Int.>(n, 3) : int"),
        ("subset", ("E",), {"texts": ("[red, blue]",)}, "subset E with [red, blue] : E"),
        ("alias", ("R",), {"timed": True}, "R timed : {a: string, b: int}"),
    ],
)  # fmt: skip
def test_kinds(kind: str, ids: tuple[str, ...], more: dict[str, Any], expected: str) -> None:
    m = Ml()
    m.ml("val N = 5; fun even n = n mod 2 = 0")
    colset = m.colset("X", kind, *ids, **more)
    assert colset is not None, m.messages()
    assert m.shown("X") == f"colset X = {expected}"
    assert colset.kind is Kind(kind)


def test_constructors_are_known_in_declarations_and_inscriptions() -> None:
    m = Ml()
    m.colset("BW", "bool", "no", "yes")
    m.colset("UW", "unit", "e")
    m.colset("PH", "index", "ph", texts=("1", "5"))
    m.ml("fun f (ph i) = if i = 1 then yes else no fun g e = 1 fun h yes = 1 | h no = 2")
    assert m.type_of("f") == "PH -> bool"
    assert m.dump("g") == "fun g : 'a -> int = fn e => 1"
    assert m.dump("h") == "fun h : bool -> int = fn true => 1 | false => 2"
    assert (
        m.inscription("1`ph 3 ++ 1`ph(n)", "PH")
        == "multi-set Ms.++(Ms.`(1, ph(3)), Ms.`(1, ph(n)))"
    )
    assert m.inscription("e", "UW") == "token ()"
    assert m.inscription("yes", "BW") == "token true"


def test_datatypes_of_colour_sets_are_declared() -> None:
    m = Ml()
    program = m.e.program()
    assert [c.name for c, _ in program.datatypes["E"].constructors] == ["red", "green", "blue"]
    assert [str(t) for _, t in program.datatypes["U"].constructors] == ["int", "None"]
    assert {"bool", "list", "option", "order", "E", "U"} == {
        n for n in program.datatypes if "." not in n
    }
    assert list(program.colsets) == [
        "INT",
        "STRING",
        "BOOL",
        "REAL",
        "UNIT",
        "E",
        "P",
        "L",
        "R",
        "U",
    ]


def test_resolved_looks_through_aliases() -> None:
    m = Ml()
    m.colset("A", "alias", "R", timed=True)
    m.colset("B", "alias", "A")
    b = m.e.program().colsets["B"]
    assert (b.resolved.name, b.timed, b.resolved.labels) == ("R", False, ("b", "a"))


def test_a_colour_set_can_be_declared_again() -> None:
    m = Ml()
    m.colset("E", "enum", "red", "black")
    m.ml("fun f red = 1 | f _ = 2 fun g green = 1 | g _ = 2")
    assert (m.type_of("f"), m.type_of("g")) == ("E#2 -> int", "E -> int")


def test_members_of_colour_sets() -> None:
    m = Ml()
    p, r, u = (m.e.program().colsets[n] for n in "PRU")
    assert "mult" in members_of(p) and "mult" not in members_of(u)
    assert str(member_type(p, "mult")) == "int list * string list -> (int * string) list"
    assert str(member_type(r, "mult")) == "int list * string list -> {a: string, b: int} list"
    assert str(member_type(r, "set_a")) == "{a: string, b: int} -> string -> {a: string, b: int}"
    assert str(member_type(u, "of_Ack")) == "U -> bool"
    assert str(member_type(u, "cmp")) == "U * U -> order"


def test_bounds_may_use_values_declared_before() -> None:
    m = Ml()
    m.ml("val low = 1 val high = if low > 0 then low + 7 else 0")
    assert m.colset("X", "int", texts=("low", "high div 2")) is not None
    assert m.shown("X") == "colset X = int with 1..4 : int"


@pytest.mark.parametrize(
    ("kind", "ids", "more", "expected"),
    [
        ("int", (), {"texts": ("5", "1")}, "colour-set-range | lower bound `5` of colour set `X` is above the upper bound `1` | 5"),
        ("int", (), {"texts": ("1",)}, "colour-set-definition | colour set `X` needs a lower and an upper bound | "),
        ("int", (), {"texts": ("1", "true")}, "type-mismatch | upper bound is `bool`, but `int` is expected | true"),
        ("int", (), {"texts": ("1", "List.hd [1] div 0")}, "colour-set-range | upper bound is not a constant that can be computed here | List.hd [1] div 0"),
        ("int", (), {"texts": ("1", "n")}, "unbound-identifier | `n` is not declared | n"),
        ("subset", ("INT",), {"texts": ("fn n => n > 3",), "by": True}, "subset-bare-fn | the predicate of the subset `X` is a `fn` without parentheses | fn n => n > 3"),
        ("int", (), {"texts": ("1", "2 +")}, "fixity-error | operator `+` has no right operand | +"),
        ("string", (), {"texts": ('"aa"', '"z"')}, 'colour-set-range | bound of the characters of colour set `X` is not one character | "aa"'),
        ("bool", ("no",), {}, "colour-set-definition | colour set `X` needs a name for false and one for true, or none | "),
        ("enum", (), {}, "colour-set-definition | colour set `X` is an enumeration without values | "),
        ("enum", ("a", "b", "a"), {}, "duplicate-name | colour set `X` has `a` twice | "),
        ("product", ("INT",), {}, "colour-set-definition | colour set `X` is a product of fewer than two colour sets | "),
        ("product", ("INT", "INTT"), {}, "unknown-colour-set | colour set `X` is made of `INTT`, which is not declared | "),
        ("record", (), {"fields": (("a", "INT"), ("a", "INT"))}, "duplicate-name | colour set `X` has a field twice | "),
        ("list", (), {}, "colour-set-definition | colour set `X` needs exactly one colour set that it is made of | "),
        ("union", (), {}, "colour-set-definition | colour set `X` is a union without constructors | "),
        ("subset", ("INT",), {}, "colour-set-definition | colour set `X` is a subset without a predicate or list | "),
        ("subset", ("INT",), {"texts": ("3",), "by": True}, "type-mismatch | predicate of the subset is `int`, but a function `int -> bool` is expected | 3"),
        ("index", ("a", "b"), {"texts": ("1", "2")}, "colour-set-definition | colour set `X` is an index without a name for its values | "),
        ("tuple", (), {}, "unsupported-colour-set | colour set `X`: kind `tuple` is not supported | "),
        ("", (), {}, "unsupported-colour-set | colour set `X`: this form is not supported | "),
    ],
)  # fmt: skip
def test_errors(kind: str, ids: tuple[str, ...], more: dict[str, Any], expected: str) -> None:
    m = Ml()
    assert m.colset("X", kind, *ids, **more) is None
    assert m.messages() == [expected]
    m.colset("Y", "list", "X")  # no consequences
    m.ml("fun f (x : Y) = x")
    assert len(m.d.items) == 1


def test_unknown_colour_sets_are_suggested() -> None:
    m = Ml()
    m.colset("X", "list", "STRNG")
    m.e.variables(["v"], "INTT", Origin("net.cpn"))
    assert [x.hint for x in m.d] == ["did you mean `STRING`?", "did you mean `INT`?"]


def test_a_variable_declared_again_with_another_colour_set_gives_a_warning() -> None:
    m = Ml()
    m.e.variables(["n"], "INT", Origin("net.cpn"))
    m.e.variables(["n"], "STRING", Origin("net.cpn"))
    assert m.messages() == [
        "variable-of-other-colour-set | variable `n` of colour set `INT` is declared again, now of `STRING` | "
    ]
    assert not m.d.has_errors
    assert m.inscription("n", "INT") == "token n", "the first declaration counts, as in CPN Tools"


def test_a_variable_has_the_last_colour_set_of_the_name() -> None:
    """As in CPN Tools, which looks for the colour set when a variable is used."""
    m = Ml()
    m.colset("E", "enum", "one", "two")
    m.colset("OF_E", "alias", "E")
    m.e.variables(["e"], "E", Origin("net.cpn"))
    m.e.variables(["f"], "OF_E", Origin("net.cpn"))
    m.colset("E", "int")
    assert not m.messages()
    assert m.inscription("e", "E") == "token e"
    assert m.inscription("f", "OF_E") == "token f"
    assert m.e.program().variables["e"].colset == m.e.program().colsets["E"]


def test_members_list_of_a_subset_is_core() -> None:
    m = Ml()
    colset = m.colset("X", "subset", "INT", texts=("[1, 2 + 3]",))
    assert colset is not None and colset.members is not None
    assert dump_exp(colset.members) == "[1, Int.+(2, 3)]"


def test_of_a_variable_and_a_value_of_one_name_the_first_counts() -> None:
    m = Ml()
    m.ml("fun ok x = x val n = 3")
    m.e.variables(["ok"], "INT", Origin("net.cpn"))
    both = "is both a variable of the net and a value or function: inscriptions mean the"
    assert m.messages() == [
        f"variable-named-as-value | `n` {both} variable, which was declared first; initial markings and declarations mean the value | val n = 3",
        f"variable-named-as-value | `ok` {both} value, which was declared first | ",
    ]
    assert not m.d.has_errors
    assert m.inscription("1`n", "INT") is not None
    assert m.inscription("1`ok", "INT") is None  # a function
