"""Initial markings of the places of a fusion set: compared as the engine of CPN Tools was seen to do."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose
from pn2code.diagnostics import Severity

HEAD = """
    net Fused
      standard
      colset T = int timed;
      colset L = list INT;
      colset C = with a | b;
      val k = 3;
      val late = 4;
      val stamped = 1`3@+2 +++ 1`4@+1;
      globref g = 5;
      colset P = product INT * INT timed;
      colset U = UNIT timed;
      fun upto n = if n = 0 then empty else 1`n ++ upto (n - 1);
      fun clocked n = if n = 0 then empty else (1`n@+n) +++ clocked (n - 1);
"""


def found(colset: str, first: str, second: str) -> list[Severity]:
    """What is said of two places of one set."""
    places = f"""
      page Top
        place A fusion F : {colset} = {first}
        place B fusion F : {colset} = {second}
    """
    d = diagnose(HEAD + places)
    assert {x.code for x in d.items} <= {"fusion-mismatch"}
    return [x.severity for x in d.items]


@pytest.mark.parametrize(
    ("colset", "first", "second"),
    [
        ("INT", "1`1++1`2", "1`2++1`1"),
        ("INT", "1`3", "1`k"),
        ("INT", "3", "k"),
        ("INT", "3", "(3)"),
        ("INT", "2`3", "1`3++1`3"),
        ("INT", "empty", ""),
        ("INT", "0`3", ""),
        ("INT", "[3, 1, 2]", "upto 3"),
        ("INT", "1`3 (* this *)", "1`3"),
        ("UNIT", "2", "1`()++1`()"),
        ("L", "1`[1,2]", "[[1,2]]"),
        ("T", "1`3@+2 +++ 1`4@+1", "1`4@+1 +++ 1`3@+2"),
        ("T", "1`3@2", "1`3@+2"),
        ("T", "1`3@2+++1`4@1", "1`4@1+++1`3@2"),
        ("T", "1`3@2+++1`3@1", "1`3@1+++1`3@2"),
        ("T", "2`3@2", "1`3@2+++1`3@2"),
        ("T", "1`3@+late", "1`3@+4"),
        ("T", "stamped", "1`4@1 +++ 1`3@2"),
        ("T", "clocked 2", "1`2@2+++1`1@1"),
        ("T", "1`3@+(!g)", "1`3@+5"),
        ("T", "1`3@time()", "1`3@0"),
        ("T", "1`3@(~1)", "1`3@(0-1)"),
        ("T", "1`3@(ModelTime.fromInt k)", "1`3@3"),
        ("T", "if true then 1`3@1 else empty", "1`3@1"),
        ("T", "List.map (fn x => x) (1`3@1)", "1`3@1"),
        ("T", "(1`1++1`2)@++2", "1`2@2+++1`1@2"),
        ("T", "3", "k"),
        ("P", "1`(1,2)@2", "1`(1,1+1)@(1+1)"),
        ("U", "1`()@2", "1`()@+2"),
        ("T", "0`3@1", ""),
        ("T", "0`3@1", "[]"),
        ("T", "if k=3 then empty else []", "0`3@1"),
        ("T", "empty++empty", "0`3@1"),
        ("T", "empty@+3", ""),
        ("T", "clocked 0", "0`3@1"),
        ("C", "C.all()", "1`b++1`a"),
        ("INT", "1`(!g)", "1`5"),
    ],
)
def test_the_same_tokens(colset: str, first: str, second: str) -> None:
    assert not found(colset, first, second)


@pytest.mark.parametrize(
    ("colset", "first", "second"),
    [
        ("INT", "1`3", "2`3"),
        ("INT", "3", "1`3"),
        ("INT", "1`3", ""),
        ("T", "1`3@+2", "1`3@+1"),
        ("T", "3@+2", "1`3@+2"),
        ("T", "1`3", "1`3@+0"),
        ("T", "1`3@2", "1`3@1"),
        ("T", "2`3@2", "1`3@2+++1`3@1"),
        ("T", "1`3@+late", "1`3@+5"),
        ("T", "stamped", "1`4@1 +++ 1`3@3"),
        ("T", "clocked 2", "1`2@1+++1`1@1"),
        ("T", "1`3@+(!g)", "1`3@+6"),
        ("P", "1`(1,2)@2+++1`(1,3)@2", "1`(1,3)@2+++1`(1,2)@1"),
        ("T", "0`3@1", "0`3"),
        ("T", "0`3@1", "upto 0"),
        ("T", "0`3@1", "tl [3]"),
        ("T", "upto 0", "clocked 0"),
        ("T", "empty@+3", "0`3"),
        ("C", "C.all()", "1`a"),
        ("STRING", '1`"a b"', '1`"ab"'),
    ],
)
def test_other_tokens(colset: str, first: str, second: str) -> None:
    assert found(colset, first, second) == [Severity.ERROR]


@pytest.mark.parametrize(
    ("colset", "first", "second"),
    [
        ("T", "3@2", "3@2"),
        ("T", "3@+2", "3 @+2"),
        ("U", "()@2", "()@2"),
        ("P", "(1,2)@2", "(1,2)@2"),
    ],
)
def test_one_token_with_a_time_stamp_is_compared_with_nothing(
    colset: str, first: str, second: str
) -> None:
    assert found(colset, first, second) == [Severity.ERROR] * 2
    alone = diagnose(HEAD + f"\n      page Top\n        place A fusion F : {colset} = {first}\n")
    assert [x.code for x in alone.errors] == ["fusion-mismatch"]
    assert "1`" in alone.errors[0].hint


@pytest.mark.parametrize("second", ["1`(discrete (1, 1))", "1`(hd [])"])
def test_what_cannot_be_said(second: str) -> None:
    assert found("INT", "1`1", second) == [Severity.WARNING]


def test_each_place_is_compared_with_the_last_of_the_first_page() -> None:
    places = """
      page Top
        place A fusion F : INT = 1`2
        place B fusion F : INT = 1`1
      page Two
        place C fusion F : INT = 1`1
        place D fusion F : INT = 1`3
        place E fusion F : INT = 1`2
    """
    wrong = [e.origin.element for e in diagnose(HEAD + places).errors]
    assert [w.split("`")[1] for w in wrong] == ["A", "D", "E"]


def test_values_without_an_argument_are_not_computed() -> None:
    """`C.all ()` once ended in a KeyError, in bounds of colour sets, too; the evaluator computes both."""
    assert not found("C", "C.all()", "1`b ++ 1`a")
    d = diagnose(
        HEAD
        + "      val n = length (C.all ());\n      colset X = int with 0..n;\n      place A : X"
    )
    assert not d.errors
