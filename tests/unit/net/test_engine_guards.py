"""Guard equations that CPN Tools cannot check; what it says of each form was asked."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose

NET = """
net N
  standard
  colset P = product INT * INT;
  colset L = list INT;
  colset U = union Aa : INT + Bb;
  var v, w, y, z : INT;
  var p : P;
  var l : L;
  var c : BOOL;
  var u : U;
  fun f x = x + 1;
  page Q
    place A : INT = 1`1
    place B : P
    place D : L
    place E : BOOL
    place F : U
    place C : INT
    trans T guard %%
      in A : w
      in A : v
      in B : p
      in D : l
      in E : c
      in F : u
      out C : w
"""


def warned(guard: str) -> bool:
    """Whether there is the warning, and nothing else (but for patterns with a variable twice)."""
    items = diagnose(NET.replace("%%", guard)).items
    codes = [x.code for x in items if x.code != "pattern-repeats"]
    assert set(codes) <= {"guard-equation-repeats"}, codes
    return bool(codes)


@pytest.mark.parametrize(
    "guard",
    [
        "w * w = 4", "(w * w = 4)", "[4 = w * w]", "[w * w = v + 1]", "[v + 1 = w * w]", "[w = 1, v * v = 4]",
        "[(w = 1 orelse w = 2) = true]", "[#1 p * #1 p = 1]", "[(w, w * w) = (1, 1)]", "[[w * w] = [1]]",
        "[(if w = 1 then w else 2) = 2]", "[hd l :: l = [1, 1]]", "[l ^^ l = nil]", "[1 = length l + hd l]",
        "[let val k = w in k + w end = 3]", "[(case w of 1 => w | _ => 2) = 1]", "[Aa 1 = (if w = w then u else Bb)]",
        "[(w, f v) = (v, v + 1)]", "[w * w = 4 = true]", "[w * v = v * v]",
    ],
)  # fmt: skip
def test_equations_that_the_engine_cannot_check(guard: str) -> None:
    assert warned(guard)


@pytest.mark.parametrize(
    "guard",
    [
        "[w * w = v]", "[v = w * w]", "[y = w * w]", "[w mod 2 = w]", "[(w, w) = (1, 1)]", "[w * w = 4 andalso true]",
        "[w * w <= 4]", "[w * w <> 4]", "[w + v = v + w]", "[f w = f w]", "[l = [w, w]]", "[(w * w, w) = p]",
        "[(w, 1) = (v * v, 1)]", "[w :: l = l ^^ l]", "[Aa w = Aa (v * v)]", "[not (w * w = 4)]", "[(w * w = 4) = c]",
        "[op = (w * w, 4)]", "[let val k = w * w in k = 4 end]", "[let val w = 1 in w + w end = 2]",
        "[v * v = 1 orelse w * w = 9]", "[[w, w] = [f v, v]]",
    ],
)  # fmt: skip
def test_equations_that_the_engine_checks(guard: str) -> None:
    assert not warned(guard)
