"""Colour sets: order, enumeration, legality, texts, storage, JSON."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from helpers.netbuilder import flat
from pn2code.ml.core.colsets import Colset
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.colour_json import JsonError, from_json, to_json
from pn2code.semantics.values.colours import Colours, NotFinite
from pn2code.semantics.values.data import Data, MlException, MlLimit, Timed

NET = """
    net Colours
      standard
      colset E = with red | green | blue;
      colset SMALL = int with 1..3;
      colset NEG = int with ~2..1;
      colset IDX = index ph with 1..3;
      colset P = product E * BOOL;
      colset R = record b: SMALL * a: E;
      colset L = list E with 0..2;
      colset LI = list INT;
      colset U = union Ack: SMALL + Nil + Dat: E;
      fun even n = n mod 2 = 0;
      colset EVEN = subset SMALL by even;
      colset SOME3 = subset INT with [5, 1, 3];
      colset SW = string with "a".."b" and 1..2;
      colset AL = SMALL;
      colset YN = bool with (no, yes);
      colset UE = unit with e;
      colset COORD = real;
      colset XY = record y: COORD * x: REAL;
      colset ALC = COORD;
      colset PATH = list XY;
      colset UC = union At: XY + Away;
      page Top
        place Q : INT
"""


@pytest.fixture(scope="module")
def world() -> tuple[Colours, dict[str, Colset]]:
    net = flat(NET)
    return Evaluator(net.program).colours, net.program.colsets


def con(name: str, tag: int, argument: Any = None) -> Data:
    return Data(name, tag, argument)


RED, GREEN, BLUE = (Data(name, tag) for tag, name in enumerate(("red", "green", "blue")))


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("E", "red green blue"),
        ("BOOL", "false true"),
        ("YN", "no yes"),
        ("UE", "e"),
        ("UNIT", "()"),
        ("NEG", "(~2) (~1) 0 1"),
        ("IDX", "ph(1) ph(2) ph(3)"),
        ("P", "(red,false) (red,true) (green,false) (green,true) (blue,false) (blue,true)"),
        ("U", "Ack(1) Ack(2) Ack(3) Nil Dat(red) Dat(green) Dat(blue)"),
        ("AL", "1 2 3"),
    ],
)
def test_all_values_in_order(
    world: tuple[Colours, dict[str, Colset]], name: str, text: str
) -> None:
    colours, sets = world
    c = sets[name]
    everything = colours.all(c)
    assert " ".join(colours.text(c, x) for x in everything) == text
    assert colours.size(c) == len(everything)
    assert [colours.ord(c, x) for x in everything] == list(range(len(everything)))
    assert [colours.col(c, i) for i in range(len(everything))] == list(everything)
    assert colours.sorted(c, reversed(everything)) == list(everything)
    assert all(colours.legal(c, x) for x in everything)
    assert colours.base(c) in everything
    assert colours.ran(c) in everything


@pytest.mark.parametrize(
    ("name", "text", "size", "positions"),
    [
        ("SW", '"a" "b" "aa" "ab" "ba" "bb"', 6, [0, 1, 2, 3, 4, 5]),
        ("EVEN", "2", 3, [0]),
        ("SOME3", "5 1 3", 3, [0, 1, 2]),
        (
            "L",
            "[] [red] [green] [blue] [red,red] [green,red] [blue,red] [red,green] [green,green] [blue,green] "
            "[red,blue] [green,blue] [blue,blue]",
            13,
            [0, 1, 2, 3, 4, 6, 8, 5, 7, 9, 6, 8, 10],
        ),
    ],
)
def test_numbers_that_cpn_tools_gives(
    world: tuple[Colours, dict[str, Colset]], name: str, text: str, size: int, positions: list[int]
) -> None:
    colours, sets = world
    c = sets[name]
    everything = colours.all(c)
    assert " ".join(colours.text(c, x) for x in everything) == text
    assert colours.size(c) == size
    assert [colours.ord(c, x) for x in everything] == positions
    assert [colours.col(c, i) for i in range(len(everything))] == list(everything)
    assert all(colours.legal(c, x) for x in everything)
    assert colours.ran(c) in everything


def test_lists_are_ordered_with_prefixes_first(world: tuple[Colours, dict[str, Colset]]) -> None:
    colours, sets = world
    c = sets["L"]
    texts = [colours.text(c, x) for x in colours.sorted(c, colours.all(c))]
    assert texts[:5] == ["[]", "[red]", "[red,red]", "[red,green]", "[red,blue]"]


def test_records_are_ordered_as_declared(world: tuple[Colours, dict[str, Colset]]) -> None:
    colours, sets = world
    # stored in SML's order of labels (a, b); declared and compared as b, a
    values = colours.all(sets["R"])
    assert values[:2] == ((RED, 1), (GREEN, 1))
    assert colours.text(sets["R"], (RED, 1)) == "{b=1,a=red}"
    assert colours.with_component(sets["R"], "b", (RED, 1), 2) == (RED, 2)
    assert colours.mult(sets["R"], ((1, 2), (RED, BLUE)))[:2] == ((RED, 1), (BLUE, 1))


@pytest.mark.parametrize("name", ["INT", "REAL", "STRING", "LI", "INTINF", "TIME"])
def test_unbounded_sets_cannot_be_enumerated(
    world: tuple[Colours, dict[str, Colset]], name: str
) -> None:
    colours, sets = world
    with pytest.raises(MlException) as info:
        colours.all(sets[name])
    assert info.value.name == "CPN'Error"


def test_positions_out_of_range(world: tuple[Colours, dict[str, Colset]]) -> None:
    colours, sets = world
    with pytest.raises(MlException):
        colours.col(sets["E"], 3)
    with pytest.raises(MlException):
        colours.ord(sets["SMALL"], 9)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("SMALL", 0),
        ("AL", 4),
        ("IDX", con("ph", 0, 4)),
        ("P", None),
        ("R", (RED, 9)),
        ("L", (RED, RED, RED)),
        ("U", con("Ack", 0, 7)),
        ("EVEN", 3),
        ("EVEN", 4),
        ("SOME3", 2),
        ("SW", ""),
        ("SW", "ac"),
        ("SW", "aaa"),
    ],
)
def test_illegal_values(world: tuple[Colours, dict[str, Colset]], name: str, value: Any) -> None:
    colours, sets = world
    if value is None:
        assert colours.illegal_message(sets[name], (RED, True)) == ""
        return
    assert not colours.legal(sets[name], value)
    assert colours.illegal_message(sets[name], value).lstrip().startswith("Illegal ")


def test_multisets_are_printed_sorted(world: tuple[Colours, dict[str, Colset]]) -> None:
    colours, sets = world
    assert colours.multiset_text(sets["INT"], (3, 1, 2, 1)) == "2`1++\n1`2++\n1`3"
    assert colours.multiset_text(sets["INT"], ()) == "empty"
    assert colours.multiset_text(sets["STRING"], ('a"\n',)) == '1`"a"\n"'
    tokens = (Timed(1, 2), Timed(1, 5), Timed(0, 9), Timed(1, 2))
    assert colours.multiset_text(sets["INT"], tokens) == "1`0@9+++\n1`1@5+++\n2`1@2"
    early = colours.multiset_text(sets["INT"], tokens, earlier_first=True)
    assert early == "1`0@9+++\n2`1@2+++\n1`1@5"


# --- storage -------------------------------------------------------------------------------------

XY = (0.1, 0.2)  # x, y: SML's order


def test_only_reals_of_the_named_sets_are_narrowed(
    world: tuple[Colours, dict[str, Colset]],
) -> None:
    colours, sets = world
    narrow = frozenset({"COORD"})
    x, y = 0.1, 0.20000000298023224  # y is the COORD
    assert colours.stored(sets["XY"], XY, narrow) == (x, y)
    assert colours.stored(sets["PATH"], (XY,), narrow) == ((x, y),)
    assert colours.stored(sets["UC"], con("At", 0, XY), narrow) == con("At", 0, (x, y))
    assert colours.stored(sets["UC"], con("Away", 1), narrow) == con("Away", 1)
    assert colours.stored(sets["ALC"], 0.2, narrow) == y
    assert colours.stored(sets["COORD"], 0.2, frozenset({"ALC"})) == 0.2
    assert colours.stored(sets["ALC"], 0.2, frozenset({"ALC"})) == y
    assert colours.stored(sets["XY"], XY, frozenset()) == XY


def test_what_is_not_finite_cannot_be_stored(world: tuple[Colours, dict[str, Colset]]) -> None:
    colours, sets = world
    for x in (1e300, math.inf, math.nan):
        with pytest.raises(NotFinite):
            colours.stored(sets["COORD"], x, frozenset({"COORD"}))
        assert colours.stored(sets["REAL"], x, frozenset({"COORD"})) is x


# --- JSON ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("UNIT", (), "null"),
        ("BOOL", True, "true"),
        ("YN", False, "false"),
        ("INT", -3, "-3"),
        ("INTINF", 2**70, str(2**70)),
        ("TIME", 5, "5"),
        ("REAL", 0.1, "0.1"),
        ("REAL", 2.0, "2.0"),
        ("REAL", 1e300, "1e+300"),
        ("REAL", -math.inf, '"-inf"'),
        ("STRING", 'a"é', '"a\\"é"'),
        ("E", GREEN, '"green"'),
        ("IDX", con("ph", 0, 2), "2"),
        ("P", (RED, True), '["red", true]'),
        ("R", (RED, 2), '{"b": 2, "a": "red"}'),
        ("LI", (1, 2), "[1, 2]"),
        ("U", con("Nil", 1), '["Nil"]'),
        ("U", con("Dat", 2, BLUE), '["Dat", "blue"]'),
        ("AL", 2, "2"),
        ("EVEN", 2, "2"),
    ],
)
def test_json_both_ways(
    world: tuple[Colours, dict[str, Colset]], name: str, value: Any, text: str
) -> None:
    c = world[1][name]
    assert json.dumps(to_json(c, value), ensure_ascii=False) == text
    back = from_json(c, json.loads(text))
    assert back == value
    assert type(back) is type(value)


def test_nan_survives_json(world: tuple[Colours, dict[str, Colset]]) -> None:
    c = world[1]["REAL"]
    assert to_json(c, math.nan) == "nan"
    back = from_json(c, "nan")
    assert isinstance(back, float)
    assert math.isnan(back)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("UNIT", "[]"),
        ("BOOL", "1"),
        ("INT", "true"),
        ("INT", "1.0"),
        ("REAL", '"1.0"'),
        ("REAL", "true"),
        ("E", '"pink"'),
        ("P", '["red"]'),
        ("R", '{"b": 1}'),
        ("R", '{"a": "red", "b": 1, "c": 2}'),
        ("U", '["Ack"]'),
        ("U", '["Nil", 1]'),
        ("U", '["None"]'),
        ("U", "[]"),
        ("LI", "{}"),
        ("STRING", "1"),
    ],
)
def test_json_of_another_form_is_refused(
    world: tuple[Colours, dict[str, Colset]], name: str, text: str
) -> None:
    with pytest.raises(JsonError, match=name):
        from_json(world[1][name], json.loads(text))


def test_large_colour_sets_are_counted_without_being_listed() -> None:
    net = flat(
        """
        net Large
          standard
          colset BIG = int with 0..1000000000;
          colset PAIR = product BIG * BIG;
        """
    )
    colours = Evaluator(net.program).colours
    big, pair = net.program.colsets["BIG"], net.program.colsets["PAIR"]
    assert colours.size(pair) == 1000000001**2
    assert colours.ord(pair, (2, 3)) == 2 * 1000000001 + 3
    assert colours.col(pair, 2 * 1000000001 + 3) == (2, 3)
    assert colours.legal(big, colours.ran(big))
    with pytest.raises(MlLimit, match="more than"):
        colours.all(pair)


def test_an_enumeration_is_not_looked_through(
    world: tuple[Colours, dict[str, Colset]], monkeypatch: pytest.MonkeyPatch
) -> None:
    colours, sets = world
    c = sets["E"]
    monkeypatch.setattr(Colours, "all", None)
    assert colours.size(c) == 3
    assert [colours.ord(c, v) for v in (RED, GREEN, BLUE)] == [0, 1, 2]
    assert [colours.col(c, i) for i in range(3)] == [RED, GREEN, BLUE]
    with pytest.raises(MlException):
        colours.ord(c, con("blue", 0))
    with pytest.raises(MlException):
        colours.col(c, 3)
