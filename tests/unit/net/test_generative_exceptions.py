# ruff: noqa: E501 - texts of nets
"""Exceptions that functions declare: each call makes its own in CPN Tools, which is refused where it shows."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose

NET = """
net G
  standard
  var n: INT;
  {declarations}
  page T
    place P : INT = 1`3
    trans T
      in P : n
      out P : {text}
"""
MAKES = """fun mk () = let exception E of int in
    (fn x => (raise E x) : int, fn f => ((f () : int) handle E y => y)) end;
  val (raises, handles) = mk ();
  val (raises2, handles2) = mk ();"""
REFUSED = {
    "recursion": ("fun f n = let exception R in if n = 0 then raise R else (f (n - 1) handle R => 7) end;", "f n"),
    "others": ("fun a n = let exception R in if n = 0 then raise R else (b (n - 1) handle R => 7) end and b n = a n;", "b n"),
    "functions": (MAKES, "handles (fn () => handles2 (fn () => raises n) + 100)"),
    "given": (
        "fun f (n, g : unit -> int) = let exception R in if n = 0 then g () else (f (n - 1, fn () => raise R) handle R => n) end;",
        "f (n, fn () => 1)",
    ),
    "called": ("fun g f = let exception E in if f () then raise E else (f (); 1) handle E => 2 end;", "g (fn () => n = 1)"),
    "value": ("fun mk () = let exception E in E end;", "(raise (mk ())) handle _ => n"),
    "datatype": (
        "fun mk () = let exception E; datatype t = F of unit -> int in [F (fn () => raise E)] end; val k = length (mk ());",
        "n + k",
    ),
    "stored": (
        "val kept = ref (fn () => 0); fun f n = let exception E in kept := (fn () => raise E); (!kept ()) handle E => n end;",
        "f n",
    ),
}  # fmt: skip
ACCEPTED = {
    "found": (
        "fun find p l = let exception Found of int in "
        "(app (fn x => if p x then raise Found x else ()) l; NONE) handle Found x => SOME x end;",
        "getOpt (find (fn x => x > n) [1, 2, 9], 0)",
    ),
    "outside": ("fun f x = let exception Neg in if x < 0 then raise Neg else x end;", "f n handle _ => 0"),
    "loop": (
        "fun f l = let exception Stop of int; fun go [] a = a | go (x :: xs) a = if x = 0 then raise Stop a else go xs (a + x) "
        "in go l 0 handle Stop a => a end;",
        "f [n]",
    ),
    "handled": ("fun f n = let exception E in (if n = 5 then raise E else f (n + 1)) handle E => 7 end;", "f n"),
    "once": ("val v = let exception E; fun g n = if n = 1 then raise E else n in g 2 end;", "n + v"),
    "library": (
        "val {getFn, peekFn, setFn, clrFn} = PropList.newProp (fn (h : PropList.holder, _ : int) => h, fn (_, n) => n + 1);",
        "getFn (PropList.newHolder (), n)",
    ),
    "unused": (
        "fun f n = let exception R in if n = 0 then raise R else (f (n - 1) handle R => 7) end;",
        "n",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_one_call_may_meet_the_exception_of_another(case: str) -> None:
    declarations, text = REFUSED[case]
    found = diagnose(NET.format(declarations=declarations, text=text))
    assert [e.code for e in found.errors] == ["unsupported-exception"] * len(found.errors)
    assert found.errors


@pytest.mark.parametrize("case", ACCEPTED)
def test_each_call_meets_its_own(case: str) -> None:
    declarations, text = ACCEPTED[case]
    assert not diagnose(NET.format(declarations=declarations, text=text)).errors
