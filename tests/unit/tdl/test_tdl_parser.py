"""Scripts: text to tree, the messages about what is no script, and back to text."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.scripts import diagnosed, parsed, source
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.render import full
from pn2code.tdl import tree as t
from pn2code.tdl.check import check
from pn2code.tdl.grammar import KEYWORDS
from pn2code.tdl.parse import parse
from pn2code.tdl.pretty import expression, program
from pn2code.tdl.types import UNITS, Type

EVERYTHING = """
-- everything the language has
program robot1
input  flag "flag1.robcad" : int           -- a comment
input  go   "go.robcad"    : signal
output done "done.robcad"  : int, real
const JOINT = 1
const LIFT = 100 mm
var k, j : int := 0
var b : bool
var s : string := "a \\"quoted\\" \\\\ text\\n"
var p : pose single
var q : pose := pose(1 mm, 2 cm, 3 m, 90 deg, -1.5 rad, 0 deg)
var w : time := 2.5 s

procedure rest
  wait w
  return
end procedure

begin
  speed $joint 50 %
  speed $linear 250 mm/s
  speed $joint default
  loop
    wait until filled(flag) or filled(go) and not (k = 3)
    read flag into k
    clear flag
    mark Top.Robot1.Accept with k = k, p = {x = p.x, y = [1, null]}, "odd name" = true
    mark "a transition with blanks"
    if k = JOINT then
      move $joint p in world at 50 %
    elsif k <> 2 then
      move $linear p in tool at 2.5e2 mm/s
      move $linear q
      move $joint home
    else
      stop "bad command", k
    end if
    tool drill for 3 s
    tool "two words" for 500 ms
    measure p into q
    sense grip into k
    write done 1, 2.5e-3
    write done (k + j) * 2 - 3 div 4 mod 5, real(k) / 2
    b := if k > 1 then true else not b and k <= 3
    q := pose(p.x + LIFT, -p.y, p.z * 2, p.rx, p.ry, p.rz)
    call rest
    again:
    goto again
    exit when k > 3
    while k < 10 loop
      k := k + 1
      exit
    end loop
  end loop
end program
"""


def body(text: str) -> tuple[t.Statement, ...]:
    return parsed(f"program p begin {text} end program").body


def value(text: str) -> t.Expression:
    (statement,) = body(f"x := {text}")
    assert isinstance(statement, t.Assign)
    return statement.value


def test_everything_is_parsed_and_printed_and_parsed_again() -> None:
    tree = parsed(EVERYTHING)
    printed = program(tree)
    assert parsed(printed) == tree
    assert program(parsed(printed)) == printed


def test_statements_have_the_line_where_they_stand() -> None:
    tree = parsed("program p\nbegin\n  wait 1 s\n\n  wait 2 s\nend program\n")
    assert [s.span.origin.line for s in tree.body] == [3, 5]
    assert tree.body[1].span.text == "wait 2 s"


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("1 + 2 * 3", "1 + (2 * 3)"),
        ("1 - 2 - 3", "(1 - 2) - 3"),
        ("a or b and not c = d", "a or (b and (not (c = d)))"),
        ("-a.x * 2", "(-(a.x)) * 2"),
        ("if a then b else c + 1", "if a then b else (c + 1)"),
        ("7 div 2 mod 3", "(7 div 2) mod 3"),
    ],
)
def test_precedence(text: str, same: str) -> None:
    assert value(text) == value(same)


@pytest.mark.parametrize("unit", UNITS)
def test_every_unit_can_follow_a_number_with_and_without_blank(unit: str) -> None:
    assert value(f"1.5{unit}") == value(f"1.5 {unit}") == t.Quantity(1.5, unit)


def test_a_number_before_a_name_on_the_next_line_is_no_quantity() -> None:
    assert body("x := 5\n s := 3") == body("x := 5 \n\n s := 3")
    assert len(body("x := 5\n s := 3")) == 2


def test_exponents_are_no_units() -> None:
    assert value("2.5e-3") == t.Value(0.0025)
    assert value("2e3 mm") == t.Quantity(2000.0, "mm")


def test_mod_and_div_are_no_units() -> None:
    assert value("5 mod 2") == t.Binary("mod", t.Value(5), t.Value(2))


def test_key_words_of_docs_and_grammar_are_the_same(root: object) -> None:
    text = (root / "docs" / "tdl.md").read_text(encoding="utf-8")  # type: ignore[operator]
    section = text.split("Key words:")[1].split("\n\n")[0]
    assert set(re.findall(r"`([a-z]+)`", section)) == set(KEYWORDS)


def test_the_examples_of_the_documentation_are_right(root: object) -> None:
    text = (root / "docs" / "tdl.md").read_text(encoding="utf-8")  # type: ignore[operator]
    examples = re.findall(r"```tdl\n(program .*?)```", text, re.DOTALL)
    assert examples
    for example in examples:
        d = Diagnostics()
        tree = parse(source(example), d)
        assert tree is not None and check(tree, d) is not None, [i.message for i in d]
        assert not list(d)


# --- what is no script -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("program p begin", ["1:16 error[tdl-syntax] the script ends here, but a statement or `end` is expected"]),
        (
            "program p begin x = 3 end program",
            ["1:19 error[tdl-syntax] `=` cannot be used here: `:` or `:=` is expected"],
        ),
        (
            "program p begin if a loop end if end program",
            ["1:22 error[tdl-syntax] `loop` cannot be used here: `then` is expected"],
        ),
        (
            "program p begin x := § end program",
            ["1:22 error[tdl-syntax] `§` cannot be used here: a value is expected"],
        ),
        (
            "program if begin end program",
            ["1:9 error[tdl-syntax] `if` cannot be used here: a name is expected"],
        ),
        (
            "program p begin wait 3 furlong end program",
            ["1:24 error[tdl-unknown-unit] there is no unit `furlong`"],
        ),
        (
            "program p begin move $spline q end program",
            ["1:22 error[tdl-unknown-motion] there is no motion `$spline`"],
        ),
        (
            "program p var n : number begin end program",
            ["1:19 error[tdl-unknown-type] there is no type `number`"],
        ),
        (
            'program p begin stop "open end program',
            ["1:22 error[tdl-syntax] the text in quotes does not end on its line, or holds an unknown `\\` sequence"],
        ),
        (
            "program p begin x := 1073741824 end program",
            ["1:22 error[tdl-type] the integer is out of range"],
        ),
        (
            f"program p begin x := {'9' * 5000} end program",
            ["1:22 error[tdl-type] the integer is out of range"],
        ),
        (
            "program p begin x := 1e999 end program",
            ["1:22 error[tdl-type] the number is too large"],
        ),
        (
            f"program p begin x := {'(' * 150}1{')' * 150} end program",
            ["1:122 error[tdl-nesting] the expression is nested too deeply"],
        ),
        (
            f"program p begin {'loop ' * 50}{'end loop ' * 50}end program",
            ["1:217 error[tdl-nesting] blocks are nested too deeply"],
        ),
    ],
)  # fmt: skip
def test_each_mistake_has_its_message(text: str, expected: list[str]) -> None:
    assert diagnosed(text) == expected


def test_a_syntax_error_shows_line_and_caret() -> None:
    d = Diagnostics()
    assert parse(source("program p\nbegin\n  n = 3\nend program\n"), d) is None
    assert full(d.items[0]).split("\n")[1:] == [
        "   --> s.tdl:3:5",
        "  3 |    n = 3",
        "    |      ^",
        "    = help: assignment is written `:=`",
    ]


def test_several_mistakes_that_the_grammar_cannot_see_are_all_reported() -> None:
    text = "program p var n : number begin move $up q wait 1 ell end program"
    assert len(diagnosed(text)) == 3


# --- arbitrary text and trees ------------------------------------------------------------------

WORDS = st.sampled_from(
    [*KEYWORDS, "x", "p", "1", "2.5", "3 mm", "4 s", '"t"', "$joint", "$linear", ":=", ":", "=", "<", "(", ")", ",",
     ".", "{", "}", "[", "]", "+", "-", "*", "/", "&", "--", "\n", "filled", "pose", "%", '"', "\\", "é", "\x00"]
)  # fmt: skip


@settings(max_examples=amount(40, 150), deadline=None, derandomize=True)
@given(st.one_of(st.text(max_size=80), st.lists(WORDS, max_size=40).map(" ".join)))
def test_arbitrary_text_never_crashes_the_parser(text: str) -> None:
    for whole in (text, f"program p var x : int begin {text} end program"):
        d = Diagnostics()
        tree = parse(source(whole), d)
        assert (tree is None) == d.has_errors
        if tree is not None:
            check(tree, d)  # whatever it says
        assert all(i.message for i in d)


NUMBERS = st.one_of(
    st.integers(0, 2**30 - 1).map(t.Value),
    st.floats(0, 1e12, allow_nan=False).map(t.Value),
    st.builds(t.Quantity, st.floats(0, 1e6, allow_nan=False), st.sampled_from(sorted(UNITS))),
    st.sampled_from(["a", "b", "home_pose"]).map(t.Name),
    st.booleans().map(t.Value),
    st.text(
        st.characters(codec="utf-8", exclude_characters="\r", categories=["L", "N", "P", "Zs"]),
        max_size=5,
    ).map(t.Value),
)
EXPRESSIONS = st.recursive(
    NUMBERS,
    lambda inner: st.one_of(
        st.builds(t.Unary, st.sampled_from(["-", "not"]), inner),
        st.builds(
            t.Binary,
            st.sampled_from(["or", "and", "=", "<", "+", "-", "&", "*", "/", "div", "mod"]),
            inner,
            inner,
        ),
        st.builds(t.Field, inner, st.sampled_from(["x", "rz"])),
        st.builds(t.Conditional, inner, inner, inner),
        st.builds(
            t.CallExpression, st.just("pose"), st.lists(inner, min_size=1, max_size=2).map(tuple)
        ),
    ),
    max_leaves=12,
)


@settings(max_examples=amount(40, 150), deadline=None, derandomize=True)
@given(EXPRESSIONS)
def test_printed_expressions_parse_to_the_same_tree(e: t.Expression) -> None:
    assert value(expression(e)) == e


def test_types_are_spelled_as_the_enumeration() -> None:
    for kind in Type:
        tree = parsed(f'program p input f "f" : {kind} begin end program')
        (file,) = tree.declarations
        assert isinstance(file, t.File) and file.types[0].type is kind
