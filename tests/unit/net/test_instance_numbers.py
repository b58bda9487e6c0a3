"""`inst ()` in inscriptions: each instance of a page has its own number in them."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat
from pn2code.ml.core.instances import mentioned
from pn2code.ml.core.terms import Lit
from pn2code.semantics.game.token_game import Game

NET = """
net Numbered
  standard
  colset SEEN = product INT * INT;
  var n, k: INT;
  fun twice x = 2 * x;
  page Top
    place In : INT = 1`1 ++ 1`2
    place Out : SEEN
    subst B = Sub (In -> In, Out -> Out)
    subst A = Sub (In -> In, Out -> Out)
  page Sub
    place In port in : INT
    place Out port out : SEEN
    place Own : INT = {marking}
    trans Take guard [{guard}] code input (n); output (k); action {action};
      in In : n
      out Out : (k, {value})
"""


def net(
    *,
    marking: str = "empty",
    guard: str = "n = inst ()",
    action: str = "inst ()",
    value: str = "inst ()",
) -> str:
    return NET.format(marking=marking, guard=guard, action=action, value=value)


@pytest.mark.parametrize(
    ("value", "one", "two"),
    [
        ("inst ()", 1, 2),
        ("twice (inst ())", 2, 4),
        ("let fun own x = x * inst () in own 10 end", 10, 20),
        ("let val own = fn x => x * inst () val more = own 10 in more + own 1 end", 11, 22),
        ("hd (map inst [()])", 1, 2),
        ("List.foldr (fn (x, sum) => x * inst () + sum) 0 [1, 2]", 3, 6),
        ("case inst () of 1 => 0 | m => m", 0, 2),
    ],
)
def test_what_it_is_where_it_stands(value: str, one: int, two: int) -> None:
    game = Game(flat(net(value=value, action=value)))
    while game.enabled():
        game.fire(game.enabled()[0])
    assert game.marking_text("Top.Out") == f"1`({one},{one})++\n1`({two},{two})"


def test_behind_flattening_it_is_a_number() -> None:
    made = flat(net())
    assert not mentioned(made.transitions) and not mentioned(made.places)
    first, second = made.transitions
    assert first.guards != second.guards
    assert first.code is not None and isinstance(first.code.action, Lit)
    plain = flat(net(guard="n > 0", action="n", value="n"))
    assert plain.transitions[0].guards[0] is plain.transitions[1].guards[0]  # shared, as before


def test_an_initial_marking_has_it_with_a_warning() -> None:
    made = flat(net(marking="1`(inst () * 100)"))
    game = Game(made)
    own = [p for p in made.places if p.short == "Own"]
    found = {p.instance_number: game.marking_text(p.name) for p in own}
    assert found == {1: "1`100", 2: "1`200"}
    (warning,) = diagnose(net(marking="1`(inst ())")).items
    assert warning.code == "initial-marking-instance" and "`Own`" in warning.message


@pytest.mark.parametrize(
    ("declarations", "value", "one", "two"),
    [
        ("fun own () = inst ();", "own ()", 1, 2),
        ("val own = inst;", "own ()", 1, 2),
        ("val own = fn x => x * inst ();", "own 5", 5, 10),
        ("fun own x = let val n = inst () in n + x end;", "own 10", 11, 12),
        ("fun own () = inst (); fun plus x = x + own ();", "plus 10 + own ()", 12, 14),
        ("fun own 0 = inst () | own n = own (n - 1) + 1;", "own 3", 4, 5),
        ("fun a 0 = inst () | a n = b n and b n = a (n - 1) * 10;", "a 2", 100, 200),
        ("fun own (f, x) = (inst (), f x);", "#1 (own (rev, [1])) + #1 (own (not, true))", 2, 4),
        ("fun own () = inst ();", "let fun own () = 7 + inst () in own () end", 8, 9),
        ("val c = 5; fun own () = c * inst ();", "own ()", 5, 10),
        ("fun own x = x + inst (); val x = 3;", "own x", 4, 5),
        ("fun a () = inst (); fun b () = a () + a (); fun own c = b () + a () + c;", "own 1", 4, 7),
    ],
)
def test_declared_functions_have_that_of_where_they_are_called(
    declarations: str, value: str, one: int, two: int
) -> None:
    """As the engine of CPN Tools was seen to do in runs."""
    text = net(value=value, action=value).replace("fun twice x = 2 * x;", declarations)
    game = Game(flat(text))
    while game.enabled():
        game.fire(game.enabled()[0])
    assert game.marking_text("Top.Out") == f"1`({one},{one})++\n1`({two},{two})"


@pytest.mark.parametrize(
    ("declarations", "value", "both"),
    [
        ("val own = inst ();", "own", 1),
        ("val {x, y = [_, b]} = {x = inst (), y = [1, inst () + 5]};", "x + b", 7),
        ("fun own x = x * inst (); val m = List.map own [5, 6];", "hd m", 5),
        ("fun own 0 = inst () | own n = own (n - 1) + 1; val m = own 3 * 2;", "m", 8),
        ("val own = let fun f () = inst () in f () + f () end;", "own", 2),
        ("val own = let val n = inst () in fn x => x + n end;", "own 10", 11),
        ("fun add x y = x + y; val own = add (inst ());", "own 10", 11),
        ("local val n = inst () in fun own () = n end;", "own ()", 1),
        ("structure S = struct val n = inst () + 1 fun own () = n end;", "S.own ()", 2),
        (
            "functor F (val k : int) = struct val n = inst () + k end; structure S = F (val k = 5);",
            "S.n",
            6,
        ),
        ("globref own = inst ();", "!own", 1),
        ("colset R = int with 0..inst ();", "R.size ()", 2),
        ("fun own () = inst (); colset R = index ix with 1..own () + 2;", "R.size ()", 3),
        ("colset R = list INT with 0..inst ();", "if R.legal [1, 2] then 1 else 0", 0),
        ("colset R = subset INT with [1, inst () + 1];", "if R.legal 2 then 1 else 0", 1),
        ("val inst = inst () + 6;", "inst", 7),
    ],
)
def test_while_the_net_is_opened_it_is_one(declarations: str, value: str, both: int) -> None:
    """As the engine of CPN Tools was seen to do in runs: with a warning, since there it may become another number."""
    declared = declarations.replace("; ", ";\n  ")
    own = "n = 1 orelse n = 2" if "val inst" in declarations else "n = inst ()"
    text = net(guard=own, value=value, action="n").replace("fun twice x = 2 * x;", declared)
    assert "declaration-instance" in {x.code for x in diagnose(text).items}
    game = Game(flat(text))
    while game.enabled():
        game.fire(game.enabled()[0])
    seen = game.marking_text("Top.Out")
    assert f"(1,{both})" in seen and f"(2,{both})" in seen


def test_functions_inside_local_ask_where_they_are_called() -> None:
    declared = "local fun ask () = inst () in fun own x = x + ask () end;"
    text = net(value="own 5", action="n").replace("fun twice x = 2 * x;", declared)
    game = Game(flat(text))
    while game.enabled():
        game.fire(game.enabled()[0])
    assert game.marking_text("Top.Out") == "1`(1,6)++\n1`(2,7)"


@pytest.mark.parametrize(
    ("declaration", "why"),
    [
        ("val own = [inst];", "may hold a function"),
        ("val own = let val n = inst () in fn x => x + inst () + n end;", "may hold a function"),
        ("fun add x y = x + inst (); val own = add 5;", "may hold a function"),
        ("datatype t = T of unit -> int; val own = T inst;", "may hold a function"),
        ("exception E of unit -> int; val own = E inst;", "may hold a function"),
        ("structure S = struct fun own () = inst () end;", "a function of its own"),
        ("local val n = 3 in fun own () = n + inst () end;", "a function of its own"),
        ("val r = ref (fn () => 0); val own = (r := inst;3);", "may be given functions"),
        ("fun own (n : int) = n < inst (); colset E = subset INT by own;", "and not on another"),
        ("colset E = subset INT by (fn n => n < inst ());", "and not on another"),
        (
            "val c = 5; fun own () = c * inst (); val c = 6; fun twice (x : int) = x;",
            "`c`, which is",
        ),
    ],
)
def test_where_no_instance_is_known_there_is_none(declaration: str, why: str) -> None:
    value = "own ()" if "c = 6" in declaration else "1"
    text = net(value=value).replace("fun twice x = 2 * x;", declaration.replace("; ", ";\n  "))
    error = diagnose(text).errors[0]
    assert error.code == "unsupported-function" and why in error.message


@pytest.mark.parametrize(
    ("declarations", "name"),
    [
        ("fun own x = x + inst (); fun inst () = 7;", "inst"),
        ("fun other x = x + 1; fun own x = other (inst () + x); val other = 3;", "other"),
        ("fun own x = x + 1; val own = fn x => own x + inst ();", "own"),
        ("fun own x = x + inst (); val own = fn x => own x + inst ();", "own"),
        ("val abs = fn x => abs x + inst (); val own = abs;", "abs"),
        ("type t = int; fun own (x : t) = x + inst (); type t = string;", "t"),
        ("fun own x = (fn abs => abs + inst ()) x + abs x; fun abs _ = 100;", "abs"),
    ],
)
def test_a_name_that_stands_for_something_else_by_now_is_told(declarations: str, name: str) -> None:
    declared = declarations.replace("; ", ";\n  ")
    text = net(value="own 1").replace("fun twice x = 2 * x;", declared)
    error = diagnose(text).errors[0]
    assert error.code == "unsupported-function"
    assert f"`{name}`, which is declared again" in error.message


def test_functions_that_call_each_other_are_declared_once_for_each_use() -> None:
    """The time would double with each one."""
    calls = [f"fun f{i} 0 = 0 | f{i} x = f{i - 1} x + f{i - 1} (x - 1);" for i in range(1, 40)]
    declared = "\n  ".join(["fun f0 x = x * inst ();", *calls])
    made = flat(net(value="f39 0").replace("fun twice x = 2 * x;", declared))
    assert len(made.transitions) == 2


@pytest.mark.parametrize(
    "declaration",
    [
        "fun own inst = inst + 1; val n = own 2;",
        "fun own x = let fun inst () = x in inst () end; val n = own 2;",
        "fun inst 0 = 1 | inst n = inst (n - 1); val n = inst 2;",
        "fun ask () = inst (); fun own ask = ask + 1; val n = own 2;",
    ],
)
def test_names_that_only_look_like_it(declaration: str) -> None:
    text = net(guard="n > 0", value="1", action="1").replace("fun twice x = 2 * x;", declaration)
    assert not diagnose(text).errors


def test_a_function_that_nobody_calls_is_typed() -> None:
    text = net().replace("fun twice x = 2 * x;", "fun own x = inst () ^ x;")
    assert [e.code for e in diagnose(text).errors] == ["type-mismatch"]


def test_a_priority_has_none() -> None:
    (error,) = diagnose(net().replace("guard [", "priority inst () guard [")).errors
    assert error.code == "unsupported-function"


@pytest.mark.parametrize("own", ["fun inst () = 9;", "val inst = fn () => 9;"])
def test_a_net_may_have_its_own(own: str) -> None:
    made = flat(net(guard="n = inst () - 8").replace("fun twice x = 2 * x;", own))
    assert made.transitions[0].guards == made.transitions[1].guards
