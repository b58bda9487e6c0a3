"""The core that the elaborator gives is well typed, checked by an independent checker without inference."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.core_check import Checker, problems
from helpers.ml import Ml
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import INT, STRING
from pn2code.net.front import load

PROGRAM = r"""
fun fac 0 = 1 | fac n = n * fac (n - 1);
fun even 0 = true | even n = odd (n - 1) and odd 0 = false | odd n = even (n - 1);
fun each [] _ = [] | each (x :: xs) f = f x :: each xs f;
datatype 'a tree = Leaf | Node of 'a tree * 'a * 'a tree;
fun insert less (x, Leaf) = Node (Leaf, x, Leaf)
  | insert less (x, t as Node (l, y, r)) =
      if less (x, y) then Node (insert less (x, l), y, r)
      else if less (y, x) then Node (l, y, insert less (x, r)) else t;
fun fold f z t = let fun go (Leaf, acc) = acc | go (Node (l, x, r), acc) = go (l, f (x, go (r, acc)))
                 in go (t, z) end;
val sorted = fold op:: [] (foldl (insert op<) Leaf [3, 1, 2]);
exception Bad of string;
fun safe f x = f x handle Bad s => s | Div => "div";
val counter = ref 0;
fun next () = (counter := !counter + 1; !counter);
fun loop k = let val i = ref 0 in while !i < k do inc i; !i end;
structure S = struct val a = 1 fun f x = (x, a) end;
val pairs = map S.f ["a", "b"];
fun poly y = let fun g x = (x, y) val h = fn z => (z, g) in (g 1, g "a", #1 (h true)) end;
fun get ({b, ...} : R) = b;
fun step (q as {a, b = 0}) = {a = a ^ "!", b = size [q]} | step {a, b} = {a = a, b = b - 1} : R;
val reals = foldl op+ 0.0 (map (fn i => real i / 2.0) [1, 2]);
val big = IntInf.fromInt 3 * 123456789012;
val chosen = List.filter (fn #"a" => true | _ => false) (explode "banana");
val sum = 1`(1, "a") ++ 2`(2, "b") -- empty ++ P.mult (1`1, 1`"c");
val delayed = (1`1 ++ 1`2) @+ 3 +++ 1`3@7;
infix 6 plus; fun a plus b = a + b;
val seven = 3 plus 4;
"""


def test_a_program_with_everything() -> None:
    m = Ml()
    m.ml(PROGRAM)
    assert m.messages() == []
    assert problems(m.e.program()) == []


def test_the_checker_notices_mistakes() -> None:
    m = Ml()
    m.ml("fun f x = x + 1")
    program = m.e.program()
    dec = program.declarations[-1]
    assert isinstance(dec, core.RecBind)
    ((symbol, value),) = dec.bindings
    span = value.span
    wrong_type = core.Lambda(
        (core.Rule(value.rules[0].pattern, core.Lit("a", STRING, span), span),), value.type, span
    )
    unbound = core.Var(core.Symbol(99999, "ghost", INT), INT, span)
    checker = Checker(program)
    assert [p.split(":")[0] for p in checker.exp(wrong_type)] == ["rule"]
    assert "is not bound" in next(checker.exp(unbound))
    assert problems(program) == [] and symbol.name == "f"


def expressions(path: Path) -> Iterator[str]:
    """What is wrong with any expression of a net."""
    flat = load(path, Diagnostics())
    if flat is None:
        return
    checker = Checker(flat.program, flat.real_time)
    for dec in flat.program.declarations:
        yield from checker.dec(dec)
    for place in flat.places:
        if place.initial is not None:
            yield from checker.exp(place.initial[0])
    for t in flat.transitions:
        parts = [*t.guards, *(x for x in (t.delay, t.code and t.code.action) if x is not None)]
        parts += [a.inscription.value for a in t.arcs if a.inscription is not None]
        for part in parts:
            yield from checker.exp(part)


@pytest.mark.shared
def test_the_core_of_real_nets_is_well_typed(shared: Path) -> None:
    files = sorted((shared / "semantics-suite").glob("*.cpn"))
    # every sixth net of the collection: they come in families of near copies
    files += sorted((shared / "corpus" / "nets").rglob("*.cpn"))[::6]
    assert {str(f): found for f in files if (found := list(expressions(f)))} == {}
