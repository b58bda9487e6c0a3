# ruff: noqa: E501  (tables: one case a line)
"""Type inference and translation to core: inferred types, core shapes, and what is said of type errors."""

from __future__ import annotations

import pytest

from helpers.ml import Ml, source
from pn2code.ml.core.terms import RecBind, Symbol, ValBind, Var


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("fun f x = x", "'a -> 'a"),
        ("fun f x = x + 1", "int -> int"),
        ("fun f x = x + 1.0", "real -> real"),
        ("fun f x = x * x", "int -> int"),
        ("fun f (x : real) = x * x", "real -> real"),
        ("fun f x y = x ^ y", "string -> string -> string"),
        ("fun f x = x / 2.0 < 1.0", "real -> bool"),
        ("fun f (a, b) = a = b", "''a * ''a -> bool"),
        ("fun f [] = 0 | f (_ :: t) = 1 + f t", "'a list -> int"),
        ("fun f 0 = true | f n = g (n - 1) and g 0 = false | g n = f (n - 1)", "int -> bool"),
        ("val f = fn x => (x, x)", "'a -> 'a * 'a"),
        ("fun f g h x = g (h x)", "('a -> 'b) -> ('c -> 'a) -> 'c -> 'b"),
        ("fun f {a, b} = a + size b", "{a: int, b: 'a list} -> int"),
        ("fun f (r : R) = #a r", "{a: string, b: int} -> string"),
        ("fun f ({b, ...} : R) = b", "{a: string, b: int} -> int"),
        ("fun f p = #1 (p : P)", "int * string -> int"),
        ("fun f x = let fun id y = y in (id x, id 1) end", "'a -> 'a * int"),
        ("val f = map (fn x => x + 1) [1, 2]", "int list"),
        ("val f = List.foldl op+ 0 [1]", "int"),
        ("val f = 1`1 ++ 2`3", "int list"),
        ("val f = 1`(1, \"a\") @+ 3", "(int * string) timed list"),
        ("val f = ref []: int list ref", "int list ref"),
        ("fun f x = if x then SOME 1 else NONE", "bool -> int option"),
        ("fun f x = case x of red => 1 | _ => 2", "E -> int"),
        ("fun f (Ack n) = n | f Nil = 0", "U -> int"),
        ("fun f x = (x; ())", "'a -> unit"),
        ("fun f x = raise Fail x", "string -> 'a"),
        ("fun f x = hd x handle Empty => 0", "int list -> int"),
        ("fun f (x as (y, _)) = (x, y)", "'a * 'b -> ('a * 'b) * 'a"),
        ("val f = IntInf.fromInt 3 + 4", "IntInf.int"),
        ("fun f (x : 'a, y : 'a) = [x, y]", "'a * 'a -> 'a list"),
        ("fun f x = (x : INT)", "int -> int"),
        ("fun f () = time ()", "unit -> IntInf.int"),
        ("fun f x = mem [1, 2] x", "int -> bool"),
        ("val rec f = fn 0 => 1 | n => n * f (n - 1)", "int -> int"),
        ("fun f c = Char.isDigit c orelse c = #\"x\"", "char -> bool"),
        ("fun f s = explode s", "string -> char list"),
        ("val f = abs ~1.5", "real"),
        ("val f = P.mult (1`1, 1`\"a\")", "(int * string) list"),
        ("fun f r = R.set_b r 3", "{a: string, b: int} -> {a: string, b: int}"),
        ("val f = (E.all (), E.ord red, U.of_Ack Nil, E.mkstr red)", "E list * int * bool * string"),
        ("val f = op ::", "'a * 'a list -> 'a list"),
        ("fun f 0 _ = 1 | f _ [] = 2 | f n (x :: _) = n + x", "int -> int list -> int"),
    ],
)  # fmt: skip
def test_inferred_types(text: str, expected: str) -> None:
    m = Ml()
    m.ml(text)
    assert m.type_of("f") == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "fun f 0 = 1 | f n = n * f (n - 1)",
            "fun f : int -> int = fn 0 => 1 | n => Int.*(n, f(Int.-(n, 1)))",
        ),
        ("fun f x y = x", "fun f : 'a -> 'b -> 'a = fn x => fn y => x"),
        (
            "fun f 0 y = y | f x _ = x",
            "fun f : int -> int -> int = fn a1 => fn a2 => case (a1, a2) of (0, y) => y | (x, _) => x",
        ),
        (
            "fun f x = x andalso (x orelse true)",
            "fun f : bool -> bool = fn x => if x then if x then true else true else false",
        ),
        ("val f = [] ^^ nil ^^ empty", "val f : unit list = List.@(List.@([], []), [])"),
        ("fun f x = 1 :: x", "fun f : int list -> int list = fn x => ::(1, x)"),
        ("fun f [x] = x | f _ = 0", "fun f : int list -> int = fn ::(x, nil) => x | _ => 0"),
        ("fun f ({a, ...} : R) = a", "fun f : {a: string, b: int} -> string = fn {a = a, b = _} => a"),
        ("val f = map #1 [(1, 2)]", "val f : int list = List.map(fn r => #1(r))([(1, 2)])"),
        ("val f = {b = 1, a = 2}", "val f : {a: int, b: int} = {b = 1, a = 2}"),
        (
            "fun f x = let val (a, b) = x in a + b end",
            "fun f : int * int -> int = fn x => let val (a, b) : int * int = x in Int.+(a, b) end",
        ),
        (
            "fun f n = let val i = ref n in while !i > 0 do i := !i - 1; !i end",
            "fun f : int -> int = fn n => let val i : int ref = Ref.ref(n) in "
            "(while Int.>(Ref.!(i), 0) do Ref.:=(i, Int.-(Ref.!(i), 1)); Ref.!(i)) end",
        ),
        ("val f = foldl op+ 0.0", "val f : real list -> real = List.foldl(Real.+)(0.0)"),
        ("val f = \"a\" < \"b\"", 'val f : bool = String.<("a", "b")'),
        ("val f = ~1 + ~(2)", "val f : int = Int.+(~1, Int.~(2))"),
        ("val f = 1073741823", "val f : int = 1073741823"),
        (
            "fun f x = f x handle Fail s => s | Div => \"d\"",
            "fun f : 'a -> string = fn x => (f(x)) handle Fail(s) => s | Div => \"d\"",
        ),
    ],
)  # fmt: skip
def test_core(text: str, expected: str) -> None:
    m = Ml()
    m.ml(text)
    assert m.dump("f") == expected


def test_declarations_of_all_kinds() -> None:
    m = Ml()
    m.ml(
        """
        type pair = int * string;
        datatype 'a tree = Leaf | Node of 'a tree * 'a * 'a tree and colour = Black | White of colour list
        exception Bad of pair;
        exception Also = Bad;
        local val hidden = 3 fun g x = x + hidden in fun useHidden x = g x end
        structure S = struct val a = 1 structure T = struct fun f x = x + a end end;
        val z = S.T.f S.a;
        open S.T
        structure L2 = List
        val n3 = f 2 + L2.length [1];
        datatype again = datatype tree
        val t = Node (Leaf, 1, Leaf) : int again
        infix 6 plus fun a plus b = a + b
        val seven = 3 plus 4
        val _ = print "hi";
        print "also"
        """
    )
    assert m.lines() == [
        "datatype tree = Leaf | Node of 'a tree * 'a * 'a tree",
        "datatype colour = Black | White of colour list",
        "exception Bad of int * string",
        "val hidden : int = 3",
        "fun g : int -> int = fn x => Int.+(x, hidden)",
        "fun useHidden : int -> int = fn x => g(x)",
        "val a : int = 1",
        "fun f : int -> int = fn x => Int.+(x, a)",
        "val z : int = f(a)",
        "val n3 : int = Int.+(f(2), List.length([1]))",
        "val t : int tree = Node(Leaf, 1, Leaf)",
        "fun plus : int * int -> int = fn (a, b) => Int.+(a, b)",
        "val seven : int = plus(3, 4)",
        'val _ : unit = TextIO.print("hi")',
        'val _ : unit = TextIO.print("also")',
    ]


def test_shadowing_gives_new_symbols_and_type_names() -> None:
    m = Ml()
    m.ml(
        'val x = 1; val y = x; val x = "a"; val z = x; datatype t = A; datatype t = A | B; val u = A'
    )
    assert [m.type_of(n) for n in "yzu"] == ["int", "string", "t#2"]
    values = [d for d in m.e.program().declarations if isinstance(d, ValBind)]
    second, fourth = values[1], values[3]
    assert isinstance(second.value, Var) and isinstance(fourth.value, Var)
    assert second.value.symbol != fourth.value.symbol


def test_generics_and_instances() -> None:
    m = Ml()
    m.ml('fun id x = x fun swap (a, b) = (b, a) val u = swap (id 1, "a")')
    program = m.e.program()
    swap = program.globals["swap"]
    assert (swap.generics, swap.first_generic, swap.is_global) == (2, 0, True)
    uses = {v.symbol.name: v for v in variables(program.declarations[-1])}
    assert [str(t) for t in uses["swap"].inst] == ["int", "string"]
    assert [str(t) for t in uses["id"].inst] == ["int"]


def test_local_generics_are_numbered_after_the_outer_ones() -> None:
    m = Ml()
    m.ml("fun outer x = let fun inner y = (y, x) in (inner 1, inner true) end")
    dec = m.e.program().declarations[-1]
    assert isinstance(dec, RecBind)
    inner: Symbol = next(v.symbol for v in variables(dec) if v.symbol.name == "inner")
    assert (inner.generics, inner.first_generic, inner.is_global) == (1, 1, False)
    assert str(inner.type) == "'b -> 'b * 'a"


def test_mutual_recursion_shares_generics() -> None:
    m = Ml()
    m.ml("fun f x = (g x; x) and g y = (f y; ())")
    program = m.e.program()
    assert program.globals["f"].generics == program.globals["g"].generics == 1
    assert {v.inst for v in variables(program.declarations[-1]) if v.symbol.name in "fg"} == {
        (program.globals["f"].type.argument,)  # type: ignore[union-attr]
    }


def variables(node: object) -> list[Var]:
    """All uses of symbols below a core node."""
    found: list[Var] = [node] if isinstance(node, Var) else []
    if isinstance(node, tuple):
        children = list(node)
    elif hasattr(node, "__dataclass_fields__"):
        skip = ("type", "span", "inst", "symbol")
        children = [getattr(node, f) for f in node.__dataclass_fields__ if f not in skip]
    else:
        return found
    return found + [v for child in children for v in variables(child)]


def test_value_restriction() -> None:
    m = Ml()
    m.ml("val cell = ref nil val ok = fn x => x val pair = (ok, [])")
    assert m.type_of("pair") == "('a -> 'a) * 'b list"
    assert m.type_of("cell") == "unit list ref"  # decided by nothing, so fixed
    m.ml("val x = 1 :: !cell")
    assert [x.code for x in m.d] == ["type-mismatch"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "val x = 1 + \"a\"",
            'type-mismatch | right operand of `+` is `string`, but `int` is expected | "a"',
        ),
        ("val x = n + true", "unbound-identifier | `n` is not declared | n"),
        ("val x = true + 1", "no-such-operator | left operand of `+` is `bool`, but a number is expected | true"),
        ("fun f x = x div 2.0", "type-mismatch | right operand of `div` is `real`, but `int` is expected | 2.0"),
        ("val x = if 1 then 2 else 3", "type-mismatch | condition of `if` is `int`, but `bool` is expected | 1"),
        ("val x = if true then 2 else \"a\"", 'type-mismatch | `else` branch is `string`, but `int` is expected | "a"'),
        ("val x = [1, true]", "type-mismatch | list element is `bool`, but `int` is expected | true"),
        ("val x = hd 1", "type-mismatch | argument of `hd` is `int`, but `'a list` is expected | 1"),
        ("val x = substring (\"a\", 1, \"b\")",
         'type-mismatch | component 3 of the argument of `substring` is `string`, but `int` is expected | "b"'),
        ("val x = 1 2", "not-a-function | `1` is `int`, not a function | 1"),
        ("val x = \"a\" \"b\"", 'not-a-function | `"a"` is `string`, not a function | "a"'),
        ("fun f x = x x", "circular-type | argument of `x` would need a type that contains itself: `'a -> 'b` and `'a` | x"),
        ("val x = (fn y => y) = (fn z => z)", "not-an-equality-type | left operand of `=` is `'a -> 'a`, which has no equality | fn y => y"),
        ("val x = #c {a = 1}", "unknown-field | `{a: int}` has no field `c` | #c {a = 1}"),
        ("fun f r = #c r", "unresolved-record | the record type of `#c` is not known here | #c"),
        ("val x = let fun h r = #1 r in h (1, 2) end", "unresolved-record | the record type of `#1` is not known here | #1"),
        ("val x = let fun k g y = #1 (g y) in k (fn n => (n, n)) 1 end",
         "unresolved-record | the record type of `#1` is not known here | #1"),
        ("val x = let fun f (r : int * int) = let fun g s = #1 s + #1 r in g r end in f (1, 2) end",
         "unresolved-record | the record type of `#1` is not known here | #1"),
        ("structure S = struct fun h {a, ...} = a val b = h {a = 1, c = 2} end",
         "unresolved-record | the record type of `{a, ...}` is not known here | {a, ...}"),
        ("val x = map (fn r => let fun f x = #1 r + x in f 1 end) [(1, 2)]", None),
        ("val x = (fn r => let val f = fn () => #1 r in f () end) (1, \"a\")", None),
        ("val x = foldr (fn (r, n) => let fun f x = #1 r in f 1 + n end) 0 [(1, 2)]", None),
        ("val x = let val f = (fn r => #1 r) : int * int -> int in f (1, 2) end", None),
        ("val x = let fun f r = #1 r and g () = f (1, 2) in g () end", None),
        ("fun f {c, ...} = c", "unresolved-record | the record type of `{c, ...}` is not known here | {c, ...}"),
        ("val x = {a = 1, a = 2}", "duplicate-name | field `a` is given twice | 2"),
        ("fun f (x, x) = x", "duplicate-name | `x` occurs twice in one pattern | x"),
        ("fun f (Ackk n) = n", "unknown-constructor | `Ackk` is not a constructor | Ackk"),
        ("fun f Ack = 1", "constructor-argument | constructor `Ack` needs an argument | Ack"),
        ("fun f (Nil n) = 1", "constructor-argument | constructor `Nil` takes no argument | Nil"),
        ("fun f (x : INTT) = x", "unknown-colour-set | there is no colour set or type `INTT` | INTT"),
        ("fun f 1 = 2 | f \"a\" = 3", 'type-mismatch | pattern is `string`, but `int` is expected | "a"'),
        ("fun f (x : int) = x | f true = 3", "type-mismatch | pattern is `bool`, but `int` is expected | true"),
        ("val rec f = 3", "val-rec | `val rec` binds a name to a function: `val rec f = fn ..` | rec f = 3"),
        ("val x = raise 3", "not-an-exception | `raise` needs an exception, but this is `int` | 3"),
        ("val x = 1 handle Foo => 2", None),
        ("exception E = NoSuch", "unbound-identifier | there is no exception `NoSuch` | E = NoSuch"),
        ("open NoSuch", "unbound-identifier | there is no structure `NoSuch` | open NoSuch"),
        ("val x = BinIO.openIn \"f\"", "unsupported-function | `BinIO.openIn` is not available here: files of bytes are not "
         "read or written; those of text are, see `--files` | BinIO.openIn"),
        ("val x = BinIO.openOn \"f\"", "unbound-identifier | `BinIO.openOn` is not declared | BinIO.openOn"),
        ("fun f x = SMLofNJ.Cont.callcc x + 1", "unsupported-function | `SMLofNJ.Cont.callcc` is not available here: "
         "pn2code does not have this part of the library | SMLofNJ.Cont.callcc"),
        ("fun f () = CPN'Sim.something 1", "unsupported-function | `CPN'Sim.something` is not available here: "
         "it belongs to the inner parts of CPN Tools | CPN'Sim.something"),
        ("val x = INetSock.inetAF", "unsupported-function | function `INetSock.inetAF` is not supported | INetSock.inetAF"),
        ("val x = List.nosuch", "unbound-identifier | `List.nosuch` is not declared | List.nosuch"),
        ("val x = NoSuch.f 1", "unbound-identifier | `NoSuch.f` is not declared | NoSuch.f"),
        ("fun f ref = 1", "constructor-argument | constructor `ref` needs an argument | ref"),
        ("val x = E.alll ()", "unbound-identifier | colour set `E` has no function `alll` | E.alll"),
        ("val x : int = 1.5", "type-mismatch | value of `x` is `real`, but `int` is expected | 1.5"),
        ("val x = (1 : string)", "type-mismatch | expression is `int`, but `string` is expected | 1"),
        ("datatype t = A of 'b", "unknown-colour-set | type variable `'b` is not declared | 'b"),
        ("datatype t = A | A", "duplicate-name | constructor `A` is declared twice | A"),
        ("type t = int list list list2", "unknown-colour-set | there is no colour set or type `list2` | int list list list2"),
        ("type t = list", "type-mismatch | type `list` takes 1 argument, not 0 | list"),
        ("fun f x = 1 and f y = 2", "duplicate-name | function `f` is declared twice | f"),
        ("val x = 1 and x = 2", "duplicate-name | `x` is bound twice in one declaration | x = 2"),
        ("fun f g = (g 1, g true)", "type-mismatch | argument of `g` is `bool`, but `int` is expected | true"),
        ("val x = \"a\" <= 3", "type-mismatch | right operand of `<=` is `int`, but `string` is expected | 3"),
    ],
)  # fmt: skip
def test_type_errors(text: str, expected: str | None) -> None:
    m = Ml()
    m.ml(text)
    if expected is None:  # in a pattern a name that is no constructor is a variable
        assert m.messages() == []
    else:
        assert m.messages() == [expected]


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("val x = lenght [1]", "did you mean `length`?"),
        ("val x = [inst]", "it is the number of the page instance, which arcs, guards, delays, code segments and initial"),
        ("val x = IOUtil.withInputFile (\"f\", fn x => x) 1", "in place of the standard streams"),
        ("val x = nth ([1], 0)", "it is called `List.nth`"),
        ("val x = 1`~5", "negative numbers after the backquote need parentheses: 1`(~5)"),
        ("val x = true && false", "write `andalso`"),
        ("val x = 1.0 + real 2 * 3", "convert with `real`, or write the number with a decimal point: `5.0`"),
        ("val x = \"a\" ^ 5", "convert with `Int.toString`"),
        ("fun f x = n + x", "it is a variable of the net"),
        ("fun f (x : Int) = x", "did you mean `INT`?"),
        ("val explodes = 1; val x = explod + 1", "did you mean `explodes`?"),
        ("val rve = 1; val x = rEV [1]", "did you mean `rev`?"),
        ("val x = CPN'Replicatons.nreplications 1", "there is no structure or colour set"),
    ],
)  # fmt: skip
def test_hints(text: str, hint: str) -> None:
    m = Ml()
    m.ml(text)
    assert hint in m.only().hint


def test_errors_have_no_consequences() -> None:
    m = Ml()
    m.ml('fun broken x = x + "a" + nosuch; fun user y = broken y + 1; val z = user 2 ^ "a"')
    m.ml("val syntax = ( 1; ")
    m.ml("val also = syntax + 1")
    m.colset("BAD", "product", "INT", "NOSUCH")
    m.colset("WORSE", "list", "BAD")
    m.e.variables(["w"], "WORSE", m.d.items[0].origin)
    m.ml("fun g (x : WORSE) = x + nosuch2")
    assert m.inscription("1`(user n)", "INT") is None
    assert m.inscription("w", "INT") is None
    assert [x.split(" | ")[0] for x in m.messages()] == [
        "no-such-operator", "unbound-identifier", "syntax-error", "unknown-colour-set", "unbound-identifier",
    ]  # fmt: skip


def test_each_unknown_name_is_reported_once_in_a_text() -> None:
    m = Ml()
    m.ml("val x = (nosuch 1, nosuch 2, nosuch)")
    assert m.messages() == ["unbound-identifier | `nosuch` is not declared | nosuch"]


def test_independent_errors_are_all_reported() -> None:
    m = Ml()
    m.ml("val a = (1 + true, hd 3, nosuch)")
    assert len(m.d.items) == 3


def test_colour_set_names_in_messages() -> None:
    m = Ml()
    m.ml("fun f (r : R) = 1; val x = f (1, 2)")
    assert m.messages() == [
        "type-mismatch | argument of `f` is `int * int`, but `R` is expected | (1, 2)"
    ]


def test_values_can_be_replaced() -> None:
    m = Ml(values={"N": "2 * 4", "flag": "true"})
    m.ml("val N = 3; val flag = false; val M = N + 1")
    assert m.dump("N") == "val N : int = Int.*(2, 4)"
    assert m.dump("flag") == "val flag : bool = true"


def test_replaced_values_keep_their_type_and_must_exist() -> None:
    m = Ml(values={"N": "true", "nosuch": "1"})
    m.ml("val N = 3; val nosuhc = 4")
    m.e.program()
    assert m.messages() == [
        "type-mismatch | value given for `N` is `bool`, but `int` is expected | true",
        "unknown-value | the net declares no value `nosuch` that could be replaced | ",
    ]
    assert m.d.items[0].origin.file == "command line"
    assert m.d.items[1].hint == "did you mean `nosuhc`?"


def test_references_of_the_net() -> None:
    m = Ml()
    m.e.globref("count", source("0"))
    m.ml("fun next () = (count := !count + 1; inc count; !count)")
    assert m.type_of("count") == "int ref"
    assert m.dump("count") == "val count : int ref = Ref.ref(0)"


def test_real_clock() -> None:
    m = Ml(real_time=True)
    m.ml("val t = time () + 1.5 val text = ModelTime.toString t val u = 1`1 @++ 2.5")
    assert (m.type_of("t"), m.type_of("u")) == ("real", "int timed list")
