# ruff: noqa: E501  (tables: one case a line)
"""Structures, signatures, functors, abstypes; patterns with `ref` and alternatives: typed, and evaluated."""

from __future__ import annotations

from typing import Any

import pytest

from helpers.ml import Ml
from helpers.netbuilder import diagnose
from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.diagnostics.render import report
from pn2code.ml.elaborate import Elaborator
from pn2code.semantics.evaluation.evaluate import Evaluator
from pn2code.semantics.values.data import MlException

QUEUE = """
signature QUEUE = sig
  type 'a queue
  exception Empty
  val empty : 'a queue
  val add : 'a * 'a queue -> 'a queue
  val take : 'a queue -> 'a * 'a queue
end
structure Q :> QUEUE = struct
  type 'a queue = 'a list * 'a list
  exception Empty
  val empty = ([], [])
  fun add (x, (f, b)) = (f, x :: b)
  fun take ([], []) = raise Empty
    | take (x :: f, b) = (x, (f, b))
    | take ([], b) = take (rev b, [])
  val hidden = 3
end
"""
SORT = """
signature ORD = sig type t val lt : t * t -> bool end
functor Sort (O : ORD) : sig val sort : O.t list -> O.t list end = struct
  fun insert (x, []) = [x]
    | insert (x, y :: ys) = if O.lt (x, y) then x :: y :: ys else y :: insert (x, ys)
  fun sort l = foldr insert [] l
end
structure Up = Sort (struct type t = int fun lt (a : t, b) = a < b end)
structure Down = Sort (struct type t = string fun lt (a : t, b) = a > b end)
"""


def value(declarations: str) -> Any:
    """What `it` is."""
    d = Diagnostics()
    e = Elaborator(d)
    e.declarations(SourceText(declarations, NOWHERE))
    assert not d.has_errors, report(d)
    program = e.program()
    return Evaluator(program).globals[program.globals["it"].uid]


def errors(declarations: str) -> list[str]:
    m = Ml()
    m.ml(declarations)
    return [f"{x.code} | {x.message}" for x in m.d.errors]


@pytest.mark.parametrize(
    ("declarations", "expected"),
    [
        (f"{QUEUE} val (it, _) = Q.take (Q.add (2, Q.add (1, Q.empty)))", 1),
        (f"{QUEUE} val it = #1 (Q.take Q.empty) handle Q.Empty => 7", 7),
        (
            f"{QUEUE} datatype t = T of int Q.queue fun f (T q) = #1 (Q.take q) val it = f (T (Q.add (4, Q.empty)))",
            4,
        ),
        (f"{SORT} val it = hd (Up.sort [3, 1, 2])", 1),
        (f'{SORT} val it = hd (Down.sort ["a", "c", "b"])', "c"),
        (
            "structure A = struct val x = 1 structure B = struct val y = 2 end end open A val it = x + B.y",
            3,
        ),
        ("structure A = let val k = 2 in struct val x = k end end val it = A.x", 2),
        ("structure A = struct val x = 1 end and B = struct val y = 2 end val it = A.x + B.y", 3),
        (
            "signature S = sig type t val x : t end structure M :> S where type t = int = struct type t = int val x = 1 end val it = M.x + 1",
            2,
        ),
        (
            "signature A = sig val x : int end signature B = sig include A val y : int end structure M : B = struct val x = 1 val y = 2 end val it = M.x + M.y",
            3,
        ),
        (
            "functor F (val n : int) = struct val m = n + 1 end structure A = F (val n = 3) structure B = F (val n = 4) val it = A.m * B.m",
            20,
        ),
        (
            "functor F (structure X : sig type t val l : t list end) = struct fun len () = length X.l end structure A = F (structure X = struct type t = int val l = [1, 2] end) val it = A.len ()",
            2,
        ),
        (
            "abstype t = A of int | B with fun mk n = A n fun get (A n) = n | get B = 0 end val it = get (mk 3)",
            3,
        ),
        ("structure I : sig val max : int * int -> int end = Int val it = I.max (1, 2)", 2),
        ("structure S = struct exception E of int end val it = (raise S.E 3) handle S.E n => n", 3),
        (
            "structure S = struct datatype t = A of int | B end datatype u = datatype S.t val it = case A 3 of A n => n | B => 0",
            3,
        ),
        (
            "fun f x = let exception E of 'a in (raise E x) handle E y => y end val it = f 3 + size [f true]",
            4,
        ),
        # patterns
        ("fun f (ref x) = x + 1 val it = f (ref 3)", 4),
        ("val r = ref 3 val ref x = r val () = r := 5 val it = x", 3),
        (
            "fun f (ref 0) = 1 | f (ref 1) = 2 | f (ref n) = n val it = (f (ref 0)) * 100 + f (ref 1) * 10 + f (ref 7)",
            127,
        ),
        ("fun f (ref 0) 1 = 1 | f (ref n) m = n + m val it = f (ref 0) 1 + f (ref 0) 5", 6),
        (
            "val it = case (ref (SOME 3), 1) of (ref NONE, n) => n | (ref (SOME m), 2) => m | (_, n) => n + 9",
            10,
        ),
        ("fun f (ref (ref 1)) = 1 | f (ref (ref n)) = n + 1 val it = f (ref (ref 3))", 4),
        ("fun f (ref (ref n)) = n val it = f (ref (ref 3))", 3),
        (
            "exception E of int ref val it = (raise E (ref 3)) handle E (ref 2) => 2 | E (ref 3) => 4",
            4,
        ),
        ("val it = ((fn (ref 1) => 1) (ref 2)) handle Match => 9", 9),
        (
            "fun f (1 | 2 | 3) = true | f _ = false val it = if f 2 andalso not (f 4) then 1 else 0",
            1,
        ),
        (
            "fun f ((SOME x, _) | (_, SOME x)) = x | f _ = 0 val it = f (NONE, SOME 3) + f (SOME 4, NONE)",
            7,
        ),
        ("val it = Word.toInt (0w3 + 0wxF)", 18),
        ("val it = 0xFF - ~0x1", 256),
        ("fun f (x as SOME n) = (x, n) | f NONE = (NONE, 0) val it = #2 (f (SOME 3))", 3),
    ],
)
def test_values(declarations: str, expected: object) -> None:
    assert value(declarations) == expected


def test_an_exception_not_handled_goes_on_past_references() -> None:
    with pytest.raises(MlException, match="E"):
        value("exception E of int ref val it = (raise E (ref 3)) handle E (ref 2) => 2")


@pytest.mark.parametrize(
    ("declarations", "expected"),
    [
        (f"{QUEUE} val x = Q.hidden", ["unbound-identifier | `Q.hidden` is not declared"]),
        (f"{QUEUE} val x = Q.add (1, [2])", ["type-mismatch | component 2 of the argument of `Q.add` is `int list`, but `int queue` is expected"]),
        (f"{QUEUE} val x = Q.empty = Q.empty", ["not-an-equality-type | left operand of `=` is `'a queue`, which has no equality"]),
        ("structure M : sig val x : int end = struct val x = true end", ["signature-mismatch | `x` of the structure is `bool`, but its signature needs `int`"]),
        ("structure M : sig val x : int val y : int end = struct val x = 1 end", ["signature-mismatch | the structure has no value `y`, which its signature lists"]),
        ("structure M : sig type t end = struct end", ["signature-mismatch | the structure has no type `t`, which its signature lists"]),
        ("structure M : sig eqtype t end = struct type t = int -> int end", ["signature-mismatch | type `t` of the structure has no equality, which its signature needs"]),
        ("structure M : sig type t = int end = struct type t = bool end", ["signature-mismatch | type `t` of the structure is `bool`, but its signature needs `int`"]),
        ("structure M : sig val f : 'a -> 'a end = struct fun f x = x + 1 end", ["signature-mismatch | `f` of the structure is `int -> int`, but its signature needs `'a -> 'a`"]),
        ("structure M : sig datatype t = A end = struct datatype t = A | B end", ["signature-mismatch | datatype `t` of the structure differs from that of its signature"]),
        ("structure M : NOPE = struct end", ["unbound-identifier | there is no signature `NOPE`"]),
        ("structure M = F (struct end)", ["unbound-identifier | there is no functor `F`"]),
        ("functor F (X : sig type t end) = struct fun f (x : X.t) = x + 1 end structure A = F (struct type t = int end)", ["no-such-operator | left operand of `+` is `t`, but a number is expected"]),
        (f"{SORT} structure S = Sort (struct type t = int val lt = 3 end)", ["signature-mismatch | `lt` of the structure is `int`, but its signature needs `int * int -> bool`"]),
        ("structure M = struct val x = 1 + true end val y = M.x + M.z", ["type-mismatch | right operand of `+` is `bool`, but `int` is expected"]),
        ("datatype 'a t = L | N of 'a t * 'a u withtype 'a u = list val x = L", ["type-mismatch | type `list` takes 1 argument, not 0"]),
        ("val x = let type t = nope datatype d = D of t in D end", ["unknown-colour-set | there is no colour set or type `nope`"]),
        ("abstype t = A of int with val a = A 1 end val b = A 2", ["unbound-identifier | `A` is not declared"]),
        ("abstype t = A of int with val a = A 1 end val b = a = a", ["not-an-equality-type | left operand of `=` is `t`, which has no equality"]),
        ("fun f (x : 'a) : 'a = x + 1", ["type-variable | the type variable `'a` would have to be `int`"]),
        ("fun f (x : 'a, y : 'b) = [x, y]", ["type-variable | the type variable `'b` would have to be another one"]),
        ("fun f (x : 'a) = x = x", ["not-an-equality-type | values of the type variable `'a` are compared with `=`"]),
        ("exception E of 'a list", ["unknown-colour-set | exception `E` carries a type variable"]),
        ("val (1 | 2) = 3", ["unsupported-ml | alternatives `(p | q)` are supported in the rules of functions and `case` only"]),
        ("fun f (1 | x) = x", ["unbound-identifier | `x` is not declared", "unbound-identifier | `x` is bound in some alternatives of this pattern only"]),
    ],
)  # fmt: skip
def test_errors(declarations: str, expected: list[str]) -> None:
    assert errors(declarations) == expected


@pytest.mark.parametrize(
    ("declarations", "expected"),
    [
        ("fun f (Ack n) = n", ["function `f` does not cover `Nil`"]),
        ("fun f Nil = 1", ["function `f` does not cover `Ack _`"]),
        ("fun f red = 1 | f blue = 2", ["function `f` does not cover `green`"]),
        ("fun f (x :: _) = x", ["function `f` does not cover `[]`"]),
        ("fun f [] = 1 | f [x] = x", ["function `f` does not cover `_ :: _ :: _`"]),
        ("fun f 0 = 1 | f 1 = 2", ["function `f` does not cover `2`"]),
        ("fun f 0 [] = 1 | f _ (x :: _) = x", ["function `f` does not cover `1 []`"]),
        ("fun f (SOME (x, true)) = x | f NONE = 1", ["function `f` does not cover `SOME (_, false)`"]),
        ('val x = case "a" of "b" => 1', ["`case` does not cover `_`"]),
        ("val f = fn {a = 1, b} => b | {a = 2, ...} => 1", ["`fn` does not cover `{a = 0, b = _}`"]),
        ("val SOME x = SOME 1", ["`val` does not cover `NONE`"]),
        ("fun f _ = 1 | f 0 = 2", ["this rule of function `f` is never reached"]),
        ("fun f x = case x of SOME n => n | NONE => 0 | _ => 1", ["this rule of `case` is never reached"]),
        ("fun f (SOME 1) = 1 | f (SOME _) = 2 | f (SOME 3) = 3 | f NONE = 4", ["this rule of function `f` is never reached"]),
        ("val x = 1 handle _ => 2 | Empty => 3", ["this rule of `handle` is never reached"]),
        ("fun f (ref 0) = 1", ["function `f` does not cover `_`"]),
        # nothing to say
        ("fun f true = 1 | f false = 2", []),
        ("fun f (Ack _) = 1 | f Nil = 2", []),
        ("fun f [] = 0 | f (x :: r) = x + f r", []),
        ("fun f (SOME x, y :: _) = 1 | f (NONE, []) = 2 | f (_, []) = 3 | f (NONE, _ :: _) = 4", []),
        ("fun f () = 1 fun g (x, y) = x fun h {a, ...} = (a : int, (fn {b} => b) {b = 1}) and k _ = h {a = 1}", []),
        ("val x = 1 handle Empty => 2", []),
        ("fun f (ref x) = x | f _ = 1", ["this rule of function `f` is never reached"]),
        ("val [] = [] : int list", ["`val` does not cover `_ :: _`"]),
    ],
)  # fmt: skip
def test_what_rules_cover(declarations: str, expected: list[str]) -> None:
    m = Ml()
    m.ml(declarations)
    assert not m.d.has_errors or "never" in declarations, m.messages()
    assert [x.message for x in m.d] == expected


@pytest.mark.parametrize(
    "declarations",
    [
        "structure S = INT val x = S.mkstr 3",
        "open E val x = ord red",
        "functor F (C : sig type cs val lt : cs * cs -> bool end) = struct fun least (a, b) = if C.lt (a, b) then a else b end "
        "structure A = F (E) val x = A.least (red, blue)",
    ],
)
def test_colour_sets_are_structures(declarations: str) -> None:
    assert errors(declarations) == []


def test_large_matches_are_looked_at_or_left() -> None:
    """Ten thousand clauses; a match whose decision tree is too large says nothing."""
    m = Ml()
    m.ml("fun " + " | ".join(f"f {i} = {i}" for i in range(10_000)))
    m.ml("datatype t = A | B | C")
    rows = [
        "(" + ", ".join("A" if i == j else "B" if i == j + 1 else "_" for j in range(20)) + ")"
        for i in range(20)
    ]
    m.ml("fun " + " | ".join(f"g {row} = {i}" for i, row in enumerate(rows)))
    assert [x.message for x in m.d][:1] == ["function `f` does not cover `10000`"]
    assert not m.d.has_errors


STRUCTURES = {
    "ORD_MAP": ("ListMapFn (KEY)", "RedBlackMapFn (KEY)", "IntListMap", "WordRedBlackMap", "AtomMap"),
    "ORD_SET": ("ListSetFn (KEY)", "SplaySetFn (KEY)", "IntBinarySet", "WordRedBlackSet", "AtomSet"),
    "MONO_HASH_TABLE": ("HashTableFn (HASHED)", "IntHashTable", "WordHashTable", "AtomTable"),
    "MONO_PRIORITYQ": ("LeftPriorityQFn (RANK)",), "HASH_TABLE": ("HashTable",), "FIFO": ("Fifo",), "QUEUE": ("Queue",),
    "ATOM": ("Atom",), "LIST_SORT": ("ListMergeSort",), "ARRAY_SORT": ("ArrayQSort",), "LIST_XPROD": ("ListXProd",),
    "PROP_LIST": ("PropList",), "UREF": ("URef", "SimpleURef"), "DYNAMIC_ARRAY": ("DynamicArray",),
}  # fmt: skip
KEYS = """
structure KEY : ORD_KEY = struct type ord_key = string val compare = String.compare end
structure HASHED : HASH_KEY = struct
  type hash_key = string val hashVal = HashString.hashString fun sameKey (a : string, b) = a = b
end
structure RANK : PRIORITY = struct
  type priority = int val compare = Int.compare type item = int fun priority n = n
end
"""


@pytest.mark.parametrize("signature", sorted(STRUCTURES))
def test_what_signatures_of_the_library_stand_for(signature: str) -> None:
    """Each was asked of the engine, with `:` and with `:>`."""
    for structure in STRUCTURES[signature]:
        for ascribed in (":", ":>"):
            text = f"{KEYS if '(' in structure else ''}structure S {ascribed} {signature} = {structure}"
            assert errors(text) == [], text


def test_a_functor_may_take_any_map_of_the_library() -> None:
    functor = """
      functor Count (M : ORD_MAP where type Key.ord_key = int) = struct
        fun add (n, m) = M.insert (m, n, getOpt (M.find (m, n), 0) + 1)
        fun of_list l = M.listItemsi (List.foldl add M.empty l)
      end
    """
    for structure in ("IntListMap", "IntRedBlackMap"):
        text = f"{functor} structure C = Count ({structure})"
        assert value(f"{text} val it = C.of_list [3, 1, 3] = [(1, 1), (3, 2)]") is True
    assert errors(f"{functor} structure C = Count (WordRedBlackMap)") != []


def test_a_colour_set_may_have_the_name_of_such_a_signature() -> None:
    d = diagnose(
        "net N\n  standard\n  colset QUEUE = list INT;\n  colset FIFO = list INT;\n  var q : QUEUE;\n"
        "  page Top\n    place P : QUEUE = 1`[1]\n    place Q : FIFO\n"
        "    trans T\n      in P : q\n      out Q : rev q\n"
    )
    assert not d.has_errors


@pytest.mark.parametrize(
    ("declarations", "wanted"),
    [
        ("functor F (E : sig val ord : int -> bool end) = struct val it = E.ord 1 end structure A = F (struct fun ord n = n > 0 end)", "A.it"),
        ("structure E = struct fun ord (_ : int) = true end", "E.ord 3"),
        ("structure S = struct structure E = struct val ord = true end val it = E.ord end", "S.it"),
    ],
)  # fmt: skip
def test_a_structure_hides_a_colour_set_of_its_name(declarations: str, wanted: str) -> None:
    """`E` is a colour set; in the engine that is a structure like others."""
    assert value(f"{declarations} val it = {wanted}") is True


def test_functors_of_the_library_do_not_see_the_colour_sets_of_a_net() -> None:
    """Their parameters are called `K`, `H` and `P`, and they use structures of the library."""
    d = diagnose(
        "net N\n  standard\n"
        "  colset K = int;\n  colset H = int;\n  colset P = int;\n  colset List = list INT;\n"
        f"  {' '.join(KEYS.split())};\n"
        "  structure A = ListMapFn (KEY);\n  structure B = HashTableFn (HASHED);\n"
        "  structure C = LeftPriorityQFn (RANK);\n  structure D = RedBlackSetFn (KEY);\n"
        '  val n = C.numItems (C.fromList [3, 1]) + A.numItems (A.insert (A.empty, "a", 1));\n'
        "  page Top\n    place Q : K = 1`n\n"
    )
    assert [x.message for x in d.errors] == []


def test_a_functor_that_cpn_tools_has_is_refused_by_name() -> None:
    d = diagnose(
        "net N\n  standard\n"
        "  structure M = Hash2TableFn (struct end);\n  page Top\n    place P : INT = 1`1\n"
    )
    assert [(e.code, e.message) for e in d.errors] == [
        ("unsupported-function", "functor `Hash2TableFn` is not supported")
    ]
