# ruff: noqa: E501  (a net: one declaration a line)
"""Modules, references and alternatives in patterns, layered inscriptions: compiled, against the token game."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.netbuilder import flat

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler"),
]

NET = """
net Modules
  standard
  colset P = product INT * STRING;
  colset U = union A:INT + B;
  var n, m : INT;
  var s : STRING;
  var x : P;
  var u : U;
  structure Q :> sig type 'a queue exception Empty val empty : 'a queue val add : 'a * 'a queue -> 'a queue val take : 'a queue -> 'a * 'a queue end = struct type 'a queue = 'a list * 'a list exception Empty val empty = ([], []) fun add (x, (f, b)) = (f, x :: b) fun take ([], []) = raise Empty | take (x :: f, b) = (x, (f, b)) | take ([], b) = take (rev b, []) end
  functor Sort (O : sig type t val lt : t * t -> bool end) = struct fun insert (x, []) = [x] | insert (x, y :: ys) = if O.lt (x, y) then x :: y :: ys else y :: insert (x, ys) fun sort l = foldr insert [] l end
  structure Up = Sort (struct type t = int fun lt (a : t, b) = a < b end)
  structure Down = Sort (struct type t = string fun lt (a : t, b) = a > b end)
  abstype t = T of int | N with fun mk n = if n > 2 then T n else N fun get (T n) = n | get N = 0 end
  fun plus (ref x) y = x + y
  fun kind (ref 0) = 1 | kind (ref 1) = 2 | kind (ref n) = n * 10
  fun small (1 | 2) = true | small _ = false
  place I : INT = 1`1 ++ 1`2 ++ 1`3
  place O : INT
  place S : STRING
  place A : P = 1`(1,"a")++1`(2,"b")
  place C : P
  place D : U = 1`(A 3)++1`B
  trans Values
    in I : n
    out O : #1 (Q.take (Q.add (2, Q.add (n, Q.empty))))
    out O : (#1 (Q.take Q.empty)) handle Q.Empty => n + 40
    out O : hd (Up.sort [3, n, 2])
    out S : hd (Down.sort ["a", Int.toString n, "c"])
    out O : get (mk n)
    out O : plus (ref n) 4
    out O : kind (ref (n - 1))
    out O : if small n then 100 else 200
    out O : let val r = ref n val ref k = r in r := 7; k end
  trans Parts
    in A : x as (n, s)
    out C : x
    out O : n
    out S : s
  trans Some
    in D : u as A m
    guard [m > 1] ^^ map (fn k => k = m) [3]
    out O : m
"""


def test_compiled_modules(workshop: Workshop, tmp_path: Path) -> None:
    net = flat(NET)
    compiled, d = lowered(net)
    assert compiled is not None, [x.message for x in d]
    program = workshop.build(compiled, tmp_path / "net")
    assert agrees(net, program, seed=1, steps=40) == 6
