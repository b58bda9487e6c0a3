# ruff: noqa: E501  (tables: one case a line)
"""The table of built-in names is consistent."""

from __future__ import annotations

import pytest

from helpers.ml import Ml
from helpers.netbuilder import diagnose
from pn2code.ml.core.types import INTINF, REAL, TFun
from pn2code.ml.library import builtins as b


def test_every_type_of_the_table_can_be_read() -> None:
    assert len(b.BUILTINS) > 250
    for info in (*b.BUILTINS.values(), *b.COLSET_MEMBERS.values()):
        assert info.type() is not None
        assert info.meaning


def test_short_names_stand_for_entries() -> None:
    for full in (*b.TOP_LEVEL.values(), *b.QUALIFIED.values()):
        assert full in b.BUILTINS
    for choices in b.OVERLOADED.values():
        assert all(full in b.BUILTINS for full in choices)
    assert not b.OVERLOADED.keys() & b.TOP_LEVEL.keys()
    assert b.BUILTINS.keys() >= b.HIDDEN
    assert not b.UNSUPPORTED_NAMES & b.TOP_LEVEL.keys()


def test_overloads_have_the_same_shape() -> None:
    for choices in b.OVERLOADED.values():
        shapes = set()
        for full in choices:
            t = b.BUILTINS[full].type()
            assert isinstance(t, TFun)
            own = t.argument if not hasattr(t.argument, "fields") else t.argument.fields[0][1]
            shapes.add(str(t).replace(str(own), "x"))
        assert len(shapes) == 1


def test_time_follows_the_clock() -> None:
    t = b.BUILTINS["Time.time"].type()
    assert isinstance(t, TFun) and t.result == INTINF
    r = b.BUILTINS["Time.time"].type(real_time=True)
    assert isinstance(r, TFun) and r.result == REAL


def test_every_infix_operator_means_something() -> None:
    known = {*b.TOP_LEVEL, *b.OVERLOADED, "::", "=", "<>"}
    assert set(b.INFIX) <= known


@pytest.mark.parametrize(
    ("name", "expected"),
    [("++", (6, "left")), ("@", (9, "left")), ("`", (8, "left")), ("^^", (5, "left")), ("::", (5, "right")), (":=", (3, "left"))],
)  # fmt: skip
def test_fixities_of_cpn_tools(name: str, expected: tuple[int, str]) -> None:
    assert b.INFIX[name] == expected


NAMES = sorted({*b.TOP_LEVEL, *b.OVERLOADED, *b.QUALIFIED} | {n for n in b.BUILTINS if n[0].isalpha()} - b.HIDDEN)  # fmt: skip


def structure_of(name: str) -> str:
    return name.rpartition(".")[0]


@pytest.mark.parametrize("structure", sorted({structure_of(name) for name in NAMES}))
def test_every_name_can_be_used(structure: str) -> None:
    """A structure at a time: a test of its own for each of a thousand names takes as long as what it looks at."""
    own = [name for name in NAMES if structure_of(name) == structure]
    assert {name: said for name in own if (said := said_beside_what_must_be(name))} == {}


def said_beside_what_must_be(name: str) -> list[str]:
    """Messages about the use of a name that are wrong or missing."""
    m = Ml()
    m.ml(f"val f = op {name}")
    full = b.TOP_LEVEL.get(name, name)
    unsupported = full in b.BUILTINS and b.BUILTINS[full].unsupported
    messages = m.messages()
    expected = []
    if name == "null":
        expected.append("null-is-time | ")
    if unsupported:
        expected.append(f"unsupported-function | `{name}` is not available here: {unsupported}")
    while expected and messages and messages[-1].startswith(expected[-1]):
        messages.pop()
        expected.pop()
    return [
        *messages,
        *(f"not said: {text}" for text in expected),
        *(["an error"] if m.d.has_errors else []),
    ]


@pytest.mark.parametrize("name", sorted(b.HIDDEN))
def test_internal_names_cannot_be_written(name: str) -> None:
    m = Ml()
    m.ml(f"val f = op {name}")
    assert m.d.has_errors


def test_warnings_come_once_for_each_element_and_function() -> None:
    m = Ml()
    m.ml(
        'fun f s = (ConnManagementLayer.send ("a", s, stringEncode); ConnManagementLayer.send ("b", s, stringEncode))'
    )
    assert len(m.messages()) == 1


@pytest.mark.parametrize(
    ("text", "ok"),
    [
        ("val x : TextIO.outstream option ref = ref NONE", True),
        ("val x = Int.fmt StringCvt.HEX 10", True),
        ("val x = Real.fmt (StringCvt.FIX (SOME 2)) 1.5", True),
        ("val x = HEX", False),
        ("fun f s = TextIO.openIn s handle IO.Io {name, function, cause} => raise cause", True),
        ("fun f s = TextIO.openIn s handle Io _ => TextIO.stdIn", False),
        ('val {dir, file} = OS.Path.splitDirFile "a/b"', True),
        ("val x = LargeInt.fromInt 3 + LargeInt.toLarge 4", True),
        ("val x = TextIO.stdIn = TextIO.stdIn", False),
        ("val x : Time.time = Time.now ()", True),
    ],
)
def test_types_and_constructors_of_structures(text: str, ok: bool) -> None:
    m = Ml()
    m.ml(text)
    assert m.d.has_errors != ok, m.messages()


def test_null_is_the_time_0_in_cpn_tools() -> None:
    net = "net N\n  standard\n  fun f l = {};\n  place P : BOOL = 1`(f [1])"
    assert [x.code for x in diagnose(net.format("null l orelse null (tl l)")).items] == [
        "null-is-time"
    ]
    assert not diagnose(net.format("List.null l")).items
    assert not diagnose(
        net.replace("  fun", "  fun null (x : int list) = true;\n  fun").format("null l")
    ).items
