# ruff: noqa: E501 - texts of nets
"""Exceptions that functions declare: each call makes its own in CPN Tools, which is refused where it shows."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from helpers.monitors import Spec, with_monitors
from helpers.netbuilder import diagnose, write
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.play.typed_texts import BadText, Typist
from pn2code.properties import sources
from pn2code.properties.bind import Binder
from pn2code.simulate.choose import monitors_of

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


UNUSED = "fun f n = let exception R in if n = 0 then raise R else (f (n - 1) handle R => 7) end;"
"""CPN Tools has no value for `f 1`, since R of the inner call goes out of the outer one."""
CARELESS = "let fun f n = let exception R in if n = 0 then raise R else (f (n - 1) handle R => 7) end in f 1 > 0 end"


def examined(tmp_path: Path) -> front.Examined:
    d = Diagnostics()
    net = write(NET.format(declarations=UNUSED, text="n"), tmp_path / "net.cpn")
    found = front.examine(net, d)
    assert found.flat is not None, d.errors
    return found


@pytest.mark.parametrize("text", ["f 1 > 0", CARELESS, "List.all (fn n => f n > 0) Mark.T'P"])
def test_conditions_of_properties(tmp_path: Path, text: str) -> None:
    found = examined(tmp_path)
    assert found.flat is not None and found.typed is not None
    assert found.typed.elaborator is not None
    d = Diagnostics()
    binder = Binder(found.flat, found.typed.elaborator, d)
    binder.add(sources.from_option(f"never {{{text}}}", 1))
    assert [e.code for e in d.errors] == ["unsupported-exception"]
    assert not binder.properties().properties


def test_what_is_typed_while_one_plays(tmp_path: Path) -> None:
    found = examined(tmp_path)
    assert found.flat is not None and found.typed is not None
    assert found.typed.elaborator is not None
    typist = Typist(found.flat, found.typed.elaborator)
    transition, place = found.flat.transitions[0], found.flat.places[0]
    asked: list[Callable[[], object]] = [
        lambda: typist.expression("f 1"),
        lambda: typist.condition("f 1 = 7"),
        lambda: typist.filters("n > 0, f n = 7", transition),
        lambda: typist.marking("1`(f 1)", place),
    ]
    for ask in asked:
        with pytest.raises(BadText) as bad:
            ask()
        assert [e.code for e in bad.value.diagnostics] == ["unsupported-exception"]
    typist.expression("3 + 1")


@pytest.mark.parametrize("helper", ["", UNUSED.replace("fun f", "fun g")])
def test_functions_of_monitors(tmp_path: Path, helper: str) -> None:
    text = NET.format(declarations=UNUSED, text="n")
    own = "g" if helper else "f"
    predicate = f"fun pred (T'T (1, {{n}})) = {own} n = 7"
    net = tmp_path / "net.cpn"
    net.write_bytes(
        with_monitors(
            text, Spec("Stops", "Breakpoint", ["T.T"], {"aux": helper, "predicate": predicate})
        )
    )
    d = Diagnostics()
    found = front.examine(net, d)
    program = monitors_of(found, d)
    assert [(w.code, "`R`" in w.message) for w in d.items if "monitor" in w.code] == [
        ("unsupported-monitor", True)
    ]
    assert program is None or not program.monitors


def test_a_monitor_with_an_exception_of_its_own(tmp_path: Path) -> None:
    predicate = (
        "fun pred (T'T (1, {n})) = let exception E in (if n > 1 then raise E else false) "
        "handle E => true end"
    )
    net = tmp_path / "net.cpn"
    spec = Spec("Stops", "Breakpoint", ["T.T"], {"predicate": predicate})
    net.write_bytes(with_monitors(NET.format(declarations="", text="n"), spec))
    d = Diagnostics()
    program = monitors_of(front.examine(net, d), d)
    assert program is not None and len(program.monitors) == 1


@pytest.mark.parametrize(
    "use", ["colset C = int with 0..(f 1);", "val bound = 3;\n  colset C = int with 0..bound;"]
)
def test_bounds_of_colour_sets(use: str) -> None:
    """A bound is computed when the net is read, whatever a run comes to."""
    found = diagnose(NET.format(declarations=f"{UNUSED}\n  {use}", text="n"))
    assert [e.code for e in found.errors] == (["colour-set-range"] if "f 1" in use else [])
