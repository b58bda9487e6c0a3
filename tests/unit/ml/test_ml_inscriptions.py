# ruff: noqa: E501  (tables: one case a line)
"""Inscriptions: which form an expression has on a place, guards, delays, priorities, code segments."""

from __future__ import annotations

import pytest

from helpers.ml import Ml, source
from pn2code.ml.core import terms as core
from pn2code.ml.core.dump import dump_exp
from pn2code.ml.core.types import INT


@pytest.mark.parametrize(
    ("text", "colset", "expected"),
    [
        ("n", "INT", "token n"),
        ("1`n", "INT", "multi-set Ms.`(1, n)"),
        ("1`n++2`3", "INT", "multi-set Ms.++(Ms.`(1, n), Ms.`(2, 3))"),
        ("empty", "INT", "multi-set []"),
        ("[n, m]", "INT", "multi-set [n, m]"),
        ("[n, m]", "L", "token [n, m]"),
        ("1`[n, m]", "L", "multi-set Ms.`(1, [n, m])"),
        ("[]", "L", "token []"),
        ("(n, s)", "P", "token (n, s)"),
        ("if b then 1`n else empty", "INT", "multi-set if b then Ms.`(1, n) else []"),
        ("{a = s, b = n}", "R", "token {a = s, b = n}"),
        ("r @+ 3", "R", "timed token Time.token@+(r, 3)"),
        ("1`r @+ n", "R", "timed multi-set Time.@+(Ms.`(1, r), n)"),
        ("1`r @++ time()", "R", "timed multi-set Time.@++(Ms.`(1, r), Time.time())"),
        ("1`r@7", "R", "timed multi-set Ms.`(1, Time.@(r, 7))"),
        ("r@7", "R", "timed token Time.@(r, 7)"),
        ("(r@7)", "R", "timed token Time.@(r, 7)"),
        ("(r) @+ (3)", "R", "timed token Time.token@+(r, 3)"),
        ("1`r@+1 +++ 1`r@+2", "R", "timed multi-set Time.+++(Time.@+(Ms.`(1, r), 1), Time.@+(Ms.`(1, r), 2))"),
        ("if b then 1`r@+3 else empty", "R", "timed multi-set if b then Time.@+(Ms.`(1, r), 3) else []"),
        ("(1`r @+ 3)", "R", "timed multi-set Time.@+(Ms.`(1, r), 3)"),
        ("1`Ack n ++ 1`Nil", "U", "multi-set Ms.++(Ms.`(1, Ack(n)), Ms.`(1, Nil))"),
        ("E.all ()", "E", "multi-set E.all()"),
        ("let val k = n + 1 in k * 2 end", "INT", "token let val k : int = Int.+(n, 1) in Int.*(k, 2) end"),
        ("#1 p", "INT", "token #1(p)"),
        ("()", "UNIT", "token ()"),
        ("1`()", "UNIT", "multi-set Ms.`(1, ())"),
        ("[b] % n", "INT", "multi-set Ms.%([b], n)"),
        ("2 ** (1`n) -- 1`m", "INT", "multi-set Ms.--(Ms.**(2, Ms.`(1, n)), Ms.`(1, m))"),
    ],
)  # fmt: skip
def test_forms(text: str, colset: str, expected: str) -> None:
    m = Ml()
    assert m.inscription(text, colset) == expected, m.messages()


def test_on_output_arcs_everything_before_the_first_delay_is_delayed() -> None:
    m = Ml()
    text = "1`r++2`r@+3+++1`r@+1"
    assert m.inscription(text, "R", output=True) == (
        "timed multi-set Time.+++(Time.@+(Ms.++(Ms.`(1, r), Ms.`(2, r)), 3), Time.@+(Ms.`(1, r), 1))"
    )
    assert m.inscription("if b then 1`r else empty@+3", "R", output=True) == (
        "timed multi-set Time.@+(if b then Ms.`(1, r) else [], 3)"
    )
    assert not m.d.items
    assert m.inscription("if b then 1`r@+3 else empty", "R", output=True) is None
    assert m.only().code == "syntax-error"
    assert "everything before the first `@+`" in m.only().hint


def test_sums_of_many_terms_are_balanced() -> None:
    m = Ml()
    c = m.e.program().colsets["INT"]
    text = " ++ ".join(f"1`{i}" for i in range(500))
    typed = m.e.expression(source(text), [c.type], expected_name="INT")
    assert typed is None  # not a token
    m.d.items.clear()
    shown = m.inscription(text, "INT")
    assert shown is not None
    depth = most = 0
    for character in shown:
        depth += (character == "(") - (character == ")")
        most = max(most, depth)
    assert most < 15
    assert [int(x.split(")")[0]) for x in shown.split("Ms.`(1, ")[1:]] == list(range(500))


@pytest.mark.parametrize(
    ("text", "colset", "expected"),
    [
        ("s", "INT", "type-mismatch | inscription is `string`, but a token or multi-set of `INT` is expected | s"),
        ("(n, 2)", "P", "type-mismatch | component 2 of the inscription is `int`, but `string` is expected | 2"),
        ("1`(n, 2)", "P", "type-mismatch | component 2 of the right operand of the backquote is `int`, but `string` is expected | 2"),
        ("1`n ++ 1`s", "INT", "type-mismatch | right operand of the backquote is `string`, but `int` is expected | s"),
        ("if b then 1`s else empty", "INT", "type-mismatch | right operand of the backquote is `string`, but `int` is expected | s"),
        ("(n, s, b)", "P", "type-mismatch | inscription is `int * string * bool`, but a token or multi-set of `P` is expected | (n, s, b)"),
        ("{a = s}", "R", "type-mismatch | inscription is `{a: string}`, but a token or multi-set of `R` is expected | {a = s}"),
        ("5", "REAL", "type-mismatch | inscription is `int`, but a token or multi-set of `REAL` is expected | 5"),
        ("1`v @+ 3", "REAL", "colour-set-not-timed | inscription has a time stamp, but the colour set `REAL` is not timed | @+"),
        ("1`1++1`2@+4", "R", "type-mismatch | operand of `++` is `int timed ms`, but an untimed multi-set is expected | 1`2@+4"),
        ("l @ [9]", "L", "type-mismatch | right operand of `@` is `int list`, but `IntInf.int` is expected | [9]"),
        ("Ack(n) ++ 1`Nil", "U", "type-mismatch | operand of `++` is `U`, but a multi-set is expected | Ack(n)"),
        ("1`r @+ v", "R", "type-mismatch | delay is `real`, but `int` is expected | v"),
        ("nosuch", "INT", "unbound-identifier | `nosuch` is not declared | nosuch"),
        ("time()", "INT", "type-mismatch | inscription is `IntInf.int`, but a token or multi-set of `INT` is expected | time()"),
        ("n m", "INT", "not-a-function | `n` is `int`, not a function | n"),
    ],
)  # fmt: skip
def test_errors(text: str, colset: str, expected: str) -> None:
    m = Ml()
    assert m.inscription(text, colset) is None
    assert m.messages() == [expected]


@pytest.mark.parametrize("text", ["(r @+ 3)", "((r @+ 3))", "(r @++ time ())", "(* c *) (r@+3)"])
def test_one_token_with_a_delay_has_no_parentheses(text: str) -> None:
    """CPN Tools takes it for a multi-set, which it is not; `(r@7)` it takes."""
    m = Ml()
    assert m.inscription(text, "R") is None
    assert "one token with a delay in parentheses" in m.only().message


def test_an_error_tells_the_colour_set_of_the_place() -> None:
    m = Ml()
    m.inscription("(n, n)", "P")
    assert [x.message for x in m.only().notes] == ["the colour set is `P`, which is `INT * STRING`"]
    m.d.items.clear()
    m.inscription("(s, n)", "P")  # two components differ: the first is shown
    assert m.messages() == [
        "type-mismatch | component 1 of the inscription is `string`, but `int` is expected | s"
    ]


def test_further_names_in_scope() -> None:
    m = Ml()
    extra = core.Symbol(9000, "extra", INT)
    c = m.e.program().colsets["INT"]
    typed = m.e.expression(
        source("extra + n"), [c.type], expected_name="INT", declared={"extra": extra}
    )
    assert typed is not None and dump_exp(typed[1]) == "Int.+(extra, n)"
    assert m.e.expression(source("extra"), [c.type], expected_name="INT") is None


def test_variables_are_the_symbols_of_the_program() -> None:
    m = Ml()
    c = m.e.program().colsets["INT"]
    typed = m.e.expression(source("n"), [c.type], expected_name="INT")
    assert typed is not None and isinstance(typed[1], core.Var)
    assert typed[1].symbol is m.e.program().variables["n"]
    assert typed[1].symbol.colset is c


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[n > 3, m = 2]", ["Int.>(n, 3)", "=(m, 2)"]),
        ("n > 3, m = 2", ["Int.>(n, 3)", "=(m, 2)"]),
        ("b", ["b"]),
        ("n > 3 andalso b", ["if Int.>(n, 3) then b else false"]),
        ("[(n, s) = p]", ["=((n, s), p)"]),
        ("", []),
        ("  \n ", []),
        ("[]", []),
    ],
)
def test_guards(text: str, expected: list[str]) -> None:
    m = Ml()
    guards = m.e.guard(source(text, "guard"))
    assert guards is not None, m.messages()
    assert [dump_exp(g) for g in guards] == expected


@pytest.mark.parametrize(
    "text",
    [
        "[[b]]",
        "[[b], n = 1]",
        "[[]]",
        "[nil]",
        "([[b]])",
        "[List.map f l]",
        "[if b then [b] else []]",
        "[b], [b]",
    ],
)
def test_a_condition_is_no_list(text: str) -> None:
    m = Ml()
    m.ml("fun f k = k > 1")
    assert m.e.guard(source(text, "guard")) is None
    assert m.messages()[0].startswith("guard-not-boolean | a condition of the guard is a list")


@pytest.mark.parametrize(
    ("text", "warning"),
    [
        ("List.map f l", "guard-computed-list"),
        ("if b then [b] else []", "guard-computed-list"),
        ("hd [[b]]", "guard-computed-list"),
        ("([b]) : bool list", "guard-computed-list"),
        ("([b] ^^ [b]) : bool list", "guard-computed-list"),
        ("rev ([b] ^^ [b])", "guard-computed-list"),
        ("b :: tl [b]", "guard-computed-list"),
        ("[b] ^^ [b]", "guard-list-operator"),
        ("([b] ^^ [b])", "guard-list-operator"),
        ("[b] ++ [b]", "guard-list-operator"),
        ("2 ** [b]", "guard-list-operator"),
        ("1`b", "guard-list-operator"),
        ("(([b]))", ""),
        ("nil", ""),
        ("([])", ""),
        ("b :: nil", ""),
        ("[b] ^^ [b] = [b]", ""),
        ("[[b] ^^ [b] <> [b], b]", ""),
    ],
)
def test_a_whole_guard_may_be_a_list(text: str, warning: str) -> None:
    m = Ml()
    m.ml("fun f k = k > 1")
    assert m.e.guard(source(text, "guard")) is not None, m.messages()
    assert [x.code for x in m.d.items] == ([warning] if warning else [])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("n", "guard-not-boolean | guard is `int`, but a condition (`bool`) is expected | n"),
        ("[b, s]", "guard-not-boolean | guard is `string`, but a condition (`bool`) is expected | s"),
        ("n = s", "type-mismatch | right operand of `=` is `string`, but `int` is expected | s"),
        ("[n > ]", "fixity-error | operator `>` has no right operand | >"),
        ("[n _]", "syntax-error | unexpected `_`, `,` or `]` expected | _"),
    ],
)  # fmt: skip
def test_errors_in_guards(text: str, expected: str) -> None:
    m = Ml()
    assert m.e.guard(source(text, "guard")) is None
    assert m.messages() == [expected]


def test_delays() -> None:
    m = Ml()
    for text, expected in (
        ("@+5", "5"),
        ("@+(n * 2)", "Int.*(n, 2)"),
        ("@++time()", "Time.time()"),
    ):
        delay = m.e.delay(source(text, "delay"))
        assert delay is not None and dump_exp(delay) == expected
    assert not m.d.items


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5", "delay-form | time inscription does not begin with `@+` | 5"),
        ("@+~3", "delay-form | time inscription does not begin with `@+` | @+~"),
        ("@+v", "type-mismatch | delay is `real`, but `int` is expected | v"),
        ("@++5.0", "type-mismatch | delay is `real`, but `IntInf.int` is expected | 5.0"),
        ("@+", "syntax-error | text is empty, an expression expected | "),
    ],
)
def test_errors_in_delays(text: str, expected: str) -> None:
    m = Ml()
    assert m.e.delay(source(text, "delay")) is None
    assert m.messages() == [expected]


@pytest.mark.parametrize(
    "delay",
    [
        "n + 1", "2 * n", "(n) - 1", "~3 + 5", "n div 2", "f (n) + 1", "let val k = 1 in k end + 1", "n pl 1", "n tm 1",
        "if b then 1 else 2", "case n of 1 => 2 | _ => 3", "raise Empty", "3 : int", "(n) handle _ => 3",
        "n + 1 before ()", "n rr 1",
    ],
)  # fmt: skip
def test_delays_that_the_engine_cannot_read_behind_a_token(delay: str) -> None:
    m = delays()
    assert m.e.delay(source(f"@+ {delay}", "delay")) is None
    (said,) = m.messages()
    assert said.startswith("delay-parentheses | ") and said.endswith(f" | {delay}")
    assert m.d.errors[0].hint == f"write `@+({delay})`"
    again = delays()
    assert again.e.delay(source(f"@+({delay})", "delay")) is not None and not again.messages()


@pytest.mark.parametrize(
    "delay",
    [
        "abs n", "~n", "~ 3", "!count", "op + (n, 2)", "(op +) (n, 2)", "(fn k => k) 3", "f n", "hd [1 + 2]", "#1 (n, 2)",
        "let val k = 1 in k end", "(if b then 1 else 2)", "(raise Empty)", "n (* a + b *)", "n before ()", "n hi 1",
        "n handle Empty => raise Empty", "n r8 1",
    ],
)  # fmt: skip
def test_delays_that_the_engine_reads_behind_a_token(delay: str) -> None:
    m = delays()
    assert m.e.delay(source(f"@+ {delay}", "delay")) is not None, m.messages()


def delays() -> Ml:
    """With operators that bind more or less tightly than `@+`, which has 7."""
    m = Ml()
    for name, fixity in (
        ("pl", "infix 6"),
        ("tm", "infix 7"),
        ("hi", "infix 8"),
        ("r8", "infixr 8"),
        ("rr", "infixr 7"),
    ):
        m.ml(f"{fixity} {name}; fun a {name} b = a + b : int;")
    m.ml("val count = ref 3; fun f x = x + 1")
    return m


def test_priorities() -> None:
    m = Ml()
    m.ml("val P_HIGH = 100; fun f x = x div 0")
    texts = ("7", "P_HIGH", "P_HIGH + 1", "~3")
    assert [m.e.priority(source(t, "priority")) for t in texts] == [7, 100, 101, -3]
    assert [x.split(" | ")[0] for x in m.messages()] == ["priority-below-zero"]
    for text in ("f 3", "n", "true"):
        assert m.e.priority(source(text, "priority")) is None
    assert [x.split(" | ")[0] for x in m.messages()] == [
        "priority-below-zero", "priority-not-constant", "unbound-identifier", "type-mismatch",
    ]  # fmt: skip


def test_a_standard_priority_that_is_not_declared() -> None:
    m = Ml()
    assert m.e.priority(source("P_HIGH", "priority")) is None
    assert m.only().hint == "declare it, as CPN Tools does in a new net: `val P_HIGH = 100;`"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "input (n, m); output (s); action Int.toString (n + m);",
            "n m -> s: Int.toString(Int.+(n, m))",
        ),
        ('output (s, n); action ("a", 3)', ' -> s n: ("a", 3)'),
        ('action print "a"', ' -> : TextIO.print("a")'),
        ("input n; action (ignore n)", "n -> : General.ignore(n)"),
        ('action print "a"; print "b";', ' -> : (TextIO.print("a"); TextIO.print("b"))'),
        ("input (); output (); action ();", " -> : ()"),
    ],
)
def test_code_segments(text: str, expected: str) -> None:
    m = Ml()
    code = m.e.code_segment(source(text, "code segment"))
    assert code is not None, m.messages()
    names = [" ".join(x.name for x in side) for side in (code.inputs, code.outputs)]
    assert f"{names[0]} -> {names[1]}: {dump_exp(code.action)}" == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("input n; action ignore m", "unbound-identifier | `m` is not declared | m"),
        ("output (s); action 3", "type-mismatch | action is `int`, but `string` is expected | 3"),
        ("action 3", "type-mismatch | action is `int`, but `unit` is expected | 3"),
        ("input (nosuch); action ()", "unbound-identifier | `nosuch` is not a variable of the net | nosuch"),
        ("input (n, 3); action ()", "code-segment | `input` lists something that is not a variable | 3"),
        ("output (s, s); action (s, s)", "duplicate-name | `s` is listed twice | s"),
        ("output (s, n); action (\"a\", \"b\")", 'type-mismatch | component 2 of the action is `string`, but `int` is expected | "b"'),
        ("n + 1", "syntax-error | unexpected `n`, `action`, `input`, `output` or the end of the text expected | n"),
    ],
)  # fmt: skip
def test_errors_in_code_segments(text: str, expected: str) -> None:
    m = Ml()
    assert m.e.code_segment(source(text, "code segment")) is None
    assert m.messages() == [expected]


def test_code_segments_see_only_their_inputs_and_say_so() -> None:
    m = Ml()
    m.e.code_segment(source("action ignore n", "code segment"))
    assert "list it in `input (..)`" in m.only().hint
