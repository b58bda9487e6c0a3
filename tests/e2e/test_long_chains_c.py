"""Chains of thousands of operators: they are not nested thousands of levels deep, and mean what they mean."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

N = 600


def chain(operator: str, *items: str) -> str:
    return f" {operator} ".join(items[i % len(items)] for i in range(N))


NET = f"""
    net Chains
      standard
      colset L = list INT;
      val x = 7
      val y = 2.0
      fun f xs = {chain("::", "1", "2 * 3 + 1", "x")} :: xs
      fun g z = {chain("+", "z", "1.5")} + 0.5
      fun show xs = Int.toString (List.foldl (fn (a, b) => (3 * a + b) mod 1000003) 0 xs)
      place Sum : INT = 1`({chain("-", "x * 2", "x", "3 div x + 1", "~x")})
      place Reals : BOOL = 1`(g y > 500.0)
      place Order : STRING = 1`(({chain("-", "~600000000", "1000000000", "0")}; "fits") handle Overflow => "Overflow")
      place Cons : STRING = 1`(show (f [3, 4]))
      place Nil : STRING = 1`(show ({chain("::", "5", "x")} :: []))
      place And : BOOL = 1`({chain("andalso", "x = 7", "x < 8")} andalso x > 8)
      place Or : BOOL = 1`({chain("orelse", "x = 8", "1 div (x - 8) > 0")} orelse 1 div 0 = 1 handle Div => true)
      place Text : STRING = 1`(Int.toString (String.size ({chain("^", '"a"', '"bc"')})))
"""


def test_long_chains(fast_workshop: Workshop, tmp_path: Path) -> None:
    net = flat(NET)
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message) for e in d.errors]
    program = fast_workshop.build(ir, tmp_path / "net", "walk", "-O0")
    assert agrees(net, program, seed=1, steps=0) == 0


def listed(*items: str) -> str:
    return "[" + ", ".join(items[i % len(items)].format(i) for i in range(130)) + "]"


RECORD = '{{a = {}, s = "x"}}'
UNION = "rec' {{a = {}, s = str (chr 65)}}"
LISTS = f"""
    net Lists
      standard
      colset E = with red | green
      colset R = record a : INT * s : STRING
      colset L = list INT
      colset U = union none + num : INT + rec' : R
      colset LE = list E
      colset LR = list R
      colset LU = list U
      colset LL = list L
      colset LT = list REAL
      fun sum x = {listed("x + {}", "{} div x")}
      place Numbers : L = 1`{listed("{}", "~{}")} ++ 1`(sum 3) ++ 1`(sum 0 handle Div => [0])
      place Reals : LT = 1`{listed("{}.5")}
      place Colours : LE = 1`{listed("red", "green", "red")}
      place Records : LR = 1`{listed(RECORD)}
      place Unions : LU = 1`{listed("none", "num {}", UNION)}
      place Lists : LL = 1`{listed("[{}]", "[]")}
"""


def test_long_lists(fast_workshop: Workshop, tmp_path: Path) -> None:
    """They are arrays that loops go through: with an object for each element a compiler takes minutes."""
    net = flat(LISTS)
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message) for e in d.errors]
    program = fast_workshop.build(ir, tmp_path / "net", "walk", "-O0")
    assert agrees(net, program, seed=1, steps=0) == 0
    text = (tmp_path / "net" / "net.c").read_text()
    assert text.count("const int64_t items[]") > 1
    assert text.count("(int64_t[]){") < 130
