"""The evaluator, fed by the front end: CPN ML text in, value out."""

from __future__ import annotations

import math
from typing import Any

import pytest

from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.diagnostics.render import report
from pn2code.ml.core.types import TFun, TRecord
from pn2code.ml.elaborate import ColsetSpec, Elaborator
from pn2code.ml.library.builtins import BUILTINS, COLSET_MEMBERS
from pn2code.semantics.evaluation.evaluate import Evaluator, Limits
from pn2code.semantics.library import builtins
from pn2code.semantics.values.data import Data, MlException, MlLimit, Ref, some


def run(declarations: str, limits: Limits | None = None, **options: Any) -> tuple[Any, Evaluator]:
    """The value of `it` after the declarations."""
    d = Diagnostics()
    e = Elaborator(d)
    for kind in ("int", "real", "bool", "string"):
        e.colset(ColsetSpec(kind.upper(), kind))
    e.declarations(SourceText(declarations, NOWHERE))
    assert not d.has_errors, report(d)
    program = e.program()
    evaluator = Evaluator(program, limits=limits, **options)
    return evaluator.globals[program.globals["it"].uid], evaluator


def value(expression: str, declarations: str = "") -> Any:
    return run(f"{declarations}; val it = {expression}")[0]


def raised(expression: str, declarations: str = "") -> str:
    with pytest.raises(MlException) as info:
        value(expression, declarations)
    return info.value.name


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        # numbers
        ("1073741823 + 0", 1073741823),
        ("~7 div 2", -4),
        ("~7 mod 2", 1),
        ("7 mod ~2", -1),
        ("Int.quot (~7, 2)", -3),
        ("Int.rem (~7, 2)", -1),
        ("IntInf.pow (2, 70)", 2**70),
        ("IntInf.toString (IntInf.pow (~2, 71))", "~2361183241434822606848"),
        ("floor ~2.5", -3),
        ("ceil 2.1", 3),
        ("round 2.5", 2),
        ("round ~3.5", -4),
        ("trunc ~2.5", -2),
        ("1.0 / 0.0", math.inf),
        ("~1.0 / 0.0", -math.inf),
        ("Math.sqrt 2.0", math.sqrt(2)),
        ("Math.pow (~8.0, 1.0 / 3.0) = 0.0", False),
        ("Math.atan2 (1.0, ~1.0)", math.atan2(1, -1)),
        ("Math.ln 0.0", -math.inf),
        ("Math.exp 1000.0", math.inf),
        ("Real.fromString \" ~1.5E2x\"", some(-150.0)),
        ("Int.fromString \"x\"", Data("NONE", 0)),
        ("Int.fromString \" ~12ab\"", some(-12)),
        # control
        ("if 1 < 2 then \"a\" else \"b\"", "a"),
        ("let val x = 3 val y = x * x in y + 1 end", 10),
        ("case [1, 2] of [] => 0 | x :: _ => x", 1),
        ("(fn {a, b = (c, _)} => a + c) {b = (10, true), a = 1}", 11),
        ("#2 (1, \"x\", 2.0)", "x"),
        ("#b {b = 1, a = true}", 1),
        ("true andalso false orelse true", True),
        ("(hd [] handle Empty => 7)", 7),
        ("(1 div 0 handle Overflow => 1 | Div => 2)", 2),
        ("((1 div 0 handle Overflow => 1) handle _ => 3)", 3),
        ("let val r = ref 0 in (while !r < 5 do r := !r + 1; !r) end", 5),
        ("(op + o (fn x => (x, x))) 4", 8),
        # lists
        ("map (fn x => x * 2) [1, 2]", (2, 4)),
        ("foldl (fn (a, b) => a - b) 0 [1, 2, 3]", 2),
        ("foldr (fn (a, b) => a - b) 0 [1, 2, 3]", 2),
        ("foldr (op ::) [] [1, 2]", (1, 2)),
        ("List.tabulate (3, fn i => i * i)", (0, 1, 4)),
        ("sort (op <) [3, 1, 2, 1]", (1, 1, 2, 3)),
        ("unique_sort (op <) [3, 1, 2, 1]", (1, 2, 3)),
        ("List.partition (fn x => x > 1) [1, 2, 3]", ((2, 3), (1,))),
        ("List.collate Int.compare ([1, 2], [1])", Data("GREATER", 2)),
        ("remdupl [1, 2, 1, 3, 2]", (1, 3, 2)),
        ("rm 2 [1, 2, 3, 2]", (1, 3, 2)),
        ("listsub [1, 2, 3, 2] [2]", (1, 3, 2)),
        ("intersect [1, 2, 2, 3] [2, 3, 4]", (2, 3)),
        ("contains_all [1, 2, 3] [2, 2]", False),
        ("contains [1, 2, 3] [2, 2]", True),
        ("ListPair.zip ([1, 2, 3], [true, false])", ((1, True), (2, False))),
        ("ListPair.foldr (fn (a, b, c) => a - b + c) 0 ([1, 2], [3, 5])", -5),
        # texts
        ("String.tokens (fn c => c = #\",\") \"a,,b,\"", ("a", "b")),
        ("String.fields (fn c => c = #\",\") \"a,,b,\"", ("a", "", "b", "")),
        ("String.extract (\"hello\", 2, NONE)", "llo"),
        ("String.translate (fn c => if c = #\"a\" then \"bb\" else str c) \"cab\"", "cbbb"),
        ("String.isSubstring \"ell\" \"hello\"", True),
        ("Char.toString #\"\\n\"", "\\n"),
        ("implode (rev (explode \"abc\"))", "cba"),
        # multi-sets
        ("1`1 ++ 1`2 == 1`2 ++ 1`1", True),
        ("1`1 ++ 1`2 = 1`2 ++ 1`1", False),
        ("(~1)`5", ()),
        ("3 ** (1`1 ++ 2`5) == 6`5 ++ 3`1", True),
        ("1`1 << 2`1", True),
        ("1`1 << 1`1", False),
        ("1`1 <<= 1`1", True),
        ("2`1 >> 1`1", True),
        ("(2`1 ++ 1`3) -- 1`1", (1, 3)),
        ("cf (1, 2`1 ++ 1`3)", 2),
        ("ext_ms (fn x => 2`x) (1`1 ++ 1`2)", (1, 1, 2, 2)),
        ("[1 > 0, true] % 5", (5,)),
        ("[1 > 0, false] // (2`3)", ()),
    ],
)  # fmt: skip
def test_expressions(expression: str, expected: object) -> None:
    assert value(expression) == expected


@pytest.mark.parametrize(
    ("expression", "name"),
    [
        ("1073741823 + 1", "Overflow"),
        ("~1073741824 - 1", "Overflow"),
        ("~ (~1073741824)", "Overflow"),
        ("65536 * 65536", "Overflow"),
        ("floor 1E20", "Overflow"),
        ("floor (0.0 / 0.0)", "Domain"),
        ("1 div 0", "Div"),
        ("hd ([] : int list)", "Empty"),
        ("List.nth ([1], 1)", "Subscript"),
        ("String.sub (\"a\", ~1)", "Subscript"),
        ("chr 256", "Chr"),
        ("pos 4 [1, 2]", "Match"),
        ("(1`1) -- (1`2)", "Subtract"),
        ("ms_to_col (2`7)", "no_singleton"),
        ("valOf (Int.fromString \"x\")", "Option"),
        ("(fn 0 => 1) 2", "Match"),
        ("let val 1 = 2 in 3 end", "Bind"),
        ("List.tabulate (~1, fn i => i)", "Size"),
        ("INT.all ()", "CPN'Error"),
        ("raise Fail \"x\"", "Fail"),
    ],
)  # fmt: skip
def test_exceptions(expression: str, name: str) -> None:
    assert raised(expression) == name


def test_an_exception_knows_where_it_was_raised() -> None:
    with pytest.raises(MlException) as info:
        value("f 0", "fun f x = 10 div x")
    assert info.value.span is not None
    assert info.value.span.text == "10 div x"


def test_own_exceptions_carry_values() -> None:
    declarations = (
        'exception Bad of int * string; fun f x = if x > 1 then raise Bad (x, "no") else x'
    )
    assert value("(f 5 handle Bad (n, s) => n + String.size s)", declarations) == 7
    assert value("(f 1 handle Bad (n, s) => n)", declarations) == 1
    assert raised("f 2", declarations) == "Bad"


def test_functions_see_the_variables_around_them() -> None:
    declarations = "fun adder n = fn m => n + m; val add2 = adder 2; val n = 100"
    assert value("(add2 3, adder 10 n)", declarations) == (5, 110)


def test_curried_and_mutually_recursive_functions() -> None:
    declarations = (
        "fun even 0 = true | even n = odd (n - 1) and odd 0 = false | odd n = even (n - 1);"
        "fun add a b = a + b; val inc3 = add 3"
    )
    assert value("(even 10, odd 7, inc3 4)", declarations) == (True, True, 7)


def test_user_data_types() -> None:
    declarations = (
        "datatype 'a tree = Leaf | Node of 'a tree * 'a * 'a tree;"
        "fun insert (Leaf, x) = Node (Leaf, x, Leaf)"
        "  | insert (t as Node (l, y, r), x) ="
        "      if x < y then Node (insert (l, x), y, r) else if y < x then Node (l, y, insert (r, x)) else t;"
        "fun flat Leaf = [] | flat (Node (l, x, r)) = flat l ^^ [x] ^^ flat r"
    )
    assert value("flat (foldl (fn (x, t) => insert (t, x)) Leaf [3, 1, 2, 3])", declarations) == (
        1,
        2,
        3,
    )


def test_record_fields_are_evaluated_as_written() -> None:
    assert value(
        "let val r = ref 0 fun next () = (inc r; !r) in {b = next (), a = next ()} end"
    ) == (2, 1)


def test_deep_recursion_is_no_problem() -> None:
    assert value("sum 30000", "fun sum 0 = 0 | sum n = 1 + sum (n - 1)") == 30000


def test_tail_calls_do_not_grow_the_stack() -> None:
    limits = Limits(depth=50)
    text = "fun loop (0, s) = s | loop (n, s) = loop (n - 1, s + 1); val it = loop (20000, 0)"
    assert run(text, limits)[0] == 20000


def test_recursion_without_end_is_given_up() -> None:
    with pytest.raises(MlLimit, match="deeper than 1000"):
        run("fun f n = 1 + f n; val it : int = f 1", Limits(depth=1000))


def test_a_loop_without_end_is_given_up() -> None:
    with pytest.raises(MlLimit, match="no end after 5000 steps"):
        run("fun f n : int = f n; val it = f 1", Limits(steps=5000))


def test_a_limit_cannot_be_handled() -> None:
    with pytest.raises(MlLimit):
        run("fun f n : int = f n; val it = (f 1 handle _ => 0)", Limits(steps=5000))


def test_exceptions_go_up_through_deep_recursion() -> None:
    declarations = 'fun f 0 = raise Fail "deep" | f n = f (n - 1) ^ "x"'
    assert value("(f 20000 handle Fail s => s)", declarations) == "deep"


def test_references_keep_what_was_assigned() -> None:
    found, evaluator = run("val r = ref [1]; val _ = r ::= 5; val it = r")
    assert isinstance(found, Ref)
    assert found.contents == (5, 1)


def test_printing_goes_to_the_given_output() -> None:
    lines: list[str] = []
    run('val it = (print "a"; print "b")', output=lines.append)
    assert lines == ["a", "b"]


def test_random_functions_repeat_with_the_seed() -> None:
    text = "val it = List.tabulate (20, fn _ => discrete (1, 6))"
    first, again, other = (run(text, seed=seed)[0] for seed in (1, 1, 2))
    assert first == again != other
    assert set(first) <= set(range(1, 7))


def test_random_functions_refuse_wrong_parameters() -> None:
    assert raised("poisson ~1.0") == "Poisson"
    assert raised("exponential 0.0") == "Exponential"


def test_every_built_in_of_the_table_is_there_with_its_number_of_arguments() -> None:
    values = {*builtins.CONSTANTS, *builtins.DEPENDING}
    supported = {name: info for name, info in BUILTINS.items() if not info.unsupported}
    assert not supported.keys() - {*builtins.FUNCTIONS, *values}
    for name, info in supported.items():
        t = info.type()
        arrows = 0
        while isinstance(t, TFun):
            arrows, t = arrows + 1, t.result
        arity = 0 if name in values else builtins.FUNCTIONS[name][0]
        assert arity == arrows, name


def test_every_member_of_a_colour_set_is_there() -> None:
    for name in set(COLSET_MEMBERS) - {"base", "timed.base", "set", "of"}:
        assert name in builtins._COLSET_FUNCTIONS, name


def test_a_tuple_type_is_a_record_in_the_order_of_labels() -> None:
    # The representation that all of `semantics` relies on.
    t = TRecord((("1", TRecord()), ("2", TRecord())))
    assert t.is_tuple
    assert value('{10 = "c", 2 = "b", 1 = "a"}') == ("a", "b", "c")


def timed(expression: str) -> Any:
    """The value of an expression with the timed colour sets TI and TP, and a product P."""
    d = Diagnostics()
    e = Elaborator(d)
    e.colset(ColsetSpec("INT", "int"))
    e.colset(ColsetSpec("STRING", "string"))
    e.colset(ColsetSpec("TI", "int", timed=True))
    e.colset(ColsetSpec("P", "product", ids=("INT", "STRING")))
    e.declarations(SourceText(f"val it = {expression}", NOWHERE))
    assert not d.has_errors, report(d)
    program = e.program()
    return Evaluator(program).globals[program.globals["it"].uid]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("TI'timed.mkstr_ms(1`3@+4+++1`3@+2)", "1`3@4+++\n1`3@2"),
        ("TI'timed.mkstr(3@7)", "3@7"),
        ("TI'timed.lt(3@7, 3@8)", False),
        ("TI'timed.cmp(4@7, 3@8)", Data("GREATER", 2)),
        ("(TI'timed.size() handle CPN'Error _ => ~1)", -1),
        ("P.input (TextIO.openString \" ( (~2) ,\\\"a, b\\\") rest\")", (-2, "a, b")),
        ("size (P.input_ms (TextIO.openString \"2`(1,\\\"x\\\") ++\\n1`(2,\\\"y\\\")\\n\"))", 3),
        ("INT.input_ms (TextIO.openString \"empty\")", ()),
        ("(INT.input (TextIO.openString \"red\") handle CPN'StreamIO.IOError s => 0)", 0),
        ("TI'timed.mkstr_ms (TI'timed.input_ms (TextIO.openString \"2`3@7 +++ 1`4@8\"))", "2`3@7+++\n1`4@8"),
    ],
)  # fmt: skip
def test_timed_structures_and_reading_colours(expression: str, expected: Any) -> None:
    assert timed(expression) == expected


@pytest.mark.parametrize(
    ("expression", "narrow", "wide"),
    [
        ("(1073741823 + 1) handle Overflow => ~1", -1, 2**30),
        ("valOf Int.maxInt", 2**30 - 1, 2**63 - 1),
        ("valOf Int.precision", 31, 64),
        ("(valOf Int.maxInt + 1) handle Overflow => ~1", -1, -1),
        ("IntInf.toInt (IntInf.pow (2, 40)) handle Overflow => ~1", -1, 2**40),
        ("round 1E12 handle Overflow => ~1", -1, 10**12),
        ("valOf (Int.fromString \"5000000000\") handle Overflow => ~1", -1, 5 * 10**9),
        ("let val r = ref (valOf Int.maxInt) in (inc r; !r) handle Overflow => ~1 end", -1, -1),
    ],
)  # fmt: skip
def test_the_width_of_int(expression: str, narrow: int, wide: int) -> None:
    for bits, expected in ((31, narrow), (64, wide)):
        d = Diagnostics()
        e = Elaborator(d, int_bits=bits)
        e.declarations(SourceText(f"val it = {expression}", NOWHERE))
        assert not d.has_errors, report(d)
        program = e.program()
        assert Evaluator(program).globals[program.globals["it"].uid] == expected


def test_long_chains_of_operators_and_lists_are_no_deep_recursion() -> None:
    assert value("length it", "val it = " + " ++ ".join(["1`1"] * 200)) == 200
