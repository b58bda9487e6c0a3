"""Names that keep the state-space tool of CPN Tools from loading: warned of where they are declared at top level."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose


def said(declarations: str) -> list[str]:
    d = diagnose(f"net N\n  standard\n  {declarations}\n  place P : INT\n")
    assert not d.errors
    return [x.message.split(":")[0] for x in d if x.code == "state-space-name"]


@pytest.mark.parametrize(
    ("declarations", "what"),
    [
        ("colset ANSWER = with asks | left | parked;", "the constant `left`"),
        ("colset MSG = union first: INT + Other;", "the constant `first`"),
        ("colset IX = index item with 1..3;", "the constant `item`"),
        ("colset EV = with start | stop;", "the constant `start`"),
        ("colset OUT2 = union result: INT + none;", "the constant `result`"),
        ("colset KV = with label | value;", "the constant `value`"),
        ("exception key", "the exception `key`"),
        ("colset Date = int;", "the colour set `Date`"),
        ("colset TI = with ta | tb;", "the colour set `TI`"),
        ("colset Mark = INT;", "the colour set `Mark`"),
        ("colset Inst = product INT * INT;", "the colour set `Inst`"),
        ("val length = 7", "the value `length`"),
        ("fun rev (a : int, b : int) = a", "the function `rev`"),
        ("globref map = 3;", "the value `map`"),
    ],
)
def test_a_name_that_the_tool_uses(declarations: str, what: str) -> None:
    (message,) = said(declarations)
    assert message.startswith(f"{what} hides a name that the state-space tool of CPN Tools uses")


@pytest.mark.parametrize(
    "declarations",
    [
        "colset ANSWER = with asks | gone | parked;",
        "var left: INT;",
        "colset Net = INT;",
        "colset SCC = with sa | sb;",
        "val left = 7",
        "fun left (x : int) = let val length = x in length end",
        "structure S = struct fun map x = x + 1 val length = 7 end;",
        "fun f t = HashTable.map (fn x => x + 1) t",
        "colset R = record left: INT * item: INT;",
    ],
)
def test_other_names(declarations: str) -> None:
    assert said(declarations) == []
