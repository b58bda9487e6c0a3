"""Lexer, grammar and fixity pass: what is accepted, what the tree is, what is said of errors."""

from __future__ import annotations

import pytest

from helpers import netbuilder
from helpers.ml import Ml, shown, source
from pn2code.diagnostics import Diagnostics
from pn2code.ml.library.builtins import INFIX
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.advice import missing_operand
from pn2code.ml.parsing.fixity import resolve_declaration, resolve_expression
from pn2code.ml.parsing.lexer import insert_delay_parentheses, tokenize
from pn2code.ml.parsing.parser import declared_names, parse_code, parse_expression, parse_program


def kinds(text: str) -> str:
    d = Diagnostics()
    tokens = tokenize(source(text), d)
    assert tokens is not None, [shown(x) for x in d]
    return " ".join(
        f"{t.kind}:{t.text}" if t.kind in ("ID", "INT", "REAL") else t.kind for t in tokens
    )


def values(text: str) -> list[int | float | str | None]:
    tokens = tokenize(source(text), Diagnostics())
    assert tokens is not None
    return [t.value for t in tokens]


def shape(e: s.Exp) -> str:
    """Fully parenthesised."""
    match e:
        case s.LitExp():
            return repr(e.value)
        case s.NameExp():
            return f"op {e.name}" if e.op else e.name
        case s.ApplyExp():
            return f"({shape(e.function)} {shape(e.argument)})"
        case s.InfixExp():
            return f"({shape(e.left)} {e.operator.name} {shape(e.right)})"
        case s.LogicExp():
            word = "andalso" if e.conjunction else "orelse"
            return f"({shape(e.left)} {word} {shape(e.right)})"
        case s.RecordExp():
            return "{" + ", ".join(f"{n}={shape(x)}" for n, x in e.fields) + "}"
        case s.ListExp():
            return "[" + ", ".join(map(shape, e.items)) + "]"
        case s.SequenceExp():
            return "(" + "; ".join(map(shape, e.items)) + ")"
        case s.IfExp():
            return f"(if {shape(e.condition)} then {shape(e.then)} else {shape(e.otherwise)})"
        case s.TypedExp():
            return f"({shape(e.exp)} : {e.type.span.text})"
        case s.FnExp() | s.CaseExp():
            word = "fn" if isinstance(e, s.FnExp) else f"case {shape(e.exp)} of"
            rules = " | ".join(f"{r.pattern.span.text} => {shape(r.body)}" for r in e.rules)
            return f"({word} {rules})"
        case s.RaiseExp():
            return f"(raise {shape(e.exp)})"
        case s.HandleExp():
            rules = " | ".join(f"{r.pattern.span.text} => {shape(r.body)}" for r in e.rules)
            return f"({shape(e.exp)} handle {rules})"
        case s.SelectorExp():
            return f"#{e.label}"
        case _:
            return type(e).__name__


def parsed(text: str) -> str:
    d = Diagnostics()
    exp = parse_expression(source(text), d)
    resolved = None if exp is None else resolve_expression(exp, INFIX, d)
    assert resolved is not None, [shown(x) for x in d]
    return shape(resolved)


def errors(text: str) -> list[str]:
    d = Diagnostics()
    exp = parse_expression(source(text), d)
    if exp is not None:
        assert resolve_expression(exp, INFIX, d) is None
    return [shown(x) for x in d]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x' _ ... #a", "ID:x' WILD DOTS HASH ID:a"),
        ("List.map Int.+ A.B.c", "ID:List.map ID:Int.+ ID:A.B.c"),
        ("1`x++2`y", "INT:1 ID:` ID:x ID:++ INT:2 ID:` ID:y"),
        ("1`~5", "INT:1 ID:`~ INT:5"),
        ("~5 1.5e~3 0xFF", "INT:~5 REAL:1.5e~3 INT:0xFF"),
        ("# 1r", "HASH INT:1 ID:r"),
        ("a::b=>c=d", "ID:a ID::: ID:b DARROW ID:c EQ ID:d"),
        ("x (* one (* two *) *) y", "ID:x ID:y"),
        ("'a ''b val value", "TYVAR TYVAR VAL ID:value"),
        ("x*y", "ID:x STAR ID:y"),
    ],
)
def test_tokens(text: str, expected: str) -> None:
    assert kinds(text) == expected


def test_literal_values() -> None:
    assert values("~5 0x1F ~0x10 1.5 ~2.5e2 123456789012345678901234567890") == [
        -5, 31, -16, 1.5, -250.0, 123456789012345678901234567890,
    ]  # fmt: skip
    assert values(r'"a\n\t\"\\\065\066\^A" #"x"') == ['a\n\t"\\AB\x01', "x"]
    assert values('"one\\\n   \\two"') == ["onetwo"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a § b", "lexical-error | character `§` is not known in CPN ML | §"),
        ('"abc', 'lexical-error | string is not closed | "abc'),
        ('"a\nb"', 'lexical-error | string is not closed | "a'),
        ("(* a (* b *)", "lexical-error | comment is not closed | (*"),
        (r'"\q"', r"lexical-error | `\q` is not an escape of CPN ML | \q"),
        ('#"ab"', 'lexical-error | a character literal holds exactly one character | #"ab"'),
        ("1e999", "lexical-error | real number `1e999` is too large | 1e999"),
        ("~1e~308", "lexical-error | real number `~1e~308` is too small | ~1e~308"),
        ("0.00E~400 + 0.1E~400", "lexical-error | real number `0.1E~400` is too small | 0.1E~400"),
        ("~0w5", "lexical-error | a word literal has no sign | ~0w5"),
    ],
)
def test_lexical_errors(text: str, expected: str) -> None:
    assert errors(text) == [expected]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1`x ++ 2`y", "((1 ` x) ++ (2 ` y))"),
        ("1`x@+3+++1`y@+4", "(((1 ` x) @+ 3) +++ ((1 ` y) @+ 4))"),
        ("1`x@7", "(1 ` (x @ 7))"),
        ("a + b * c - d", "((a + (b * c)) - d)"),
        ("a :: b :: c", "(a :: (b :: c))"),
        ("a ^^ b ^^ c", "((a ^^ b) ^^ c)"),
        ("f x y + g z", "(((f x) y) + (g z))"),
        ("f o g", "(f o g)"),
        ("a = b andalso c <> d orelse e", "(((a = b) andalso (c <> d)) orelse e)"),
        ("a == b ++ c", "(a == (b ++ c))"),
        ("x := !x + 1", "(x := ((! x) + 1))"),
        ("op + (1, 2)", "(op + {1=1, 2=2})"),
        ("if a then b else c :: d", "(if a then b else (c :: d))"),
        ("fn x => x + 1", "(fn x => (x + 1))"),
        ("(fn x => x) 1", "((fn x => x) 1)"),
        ("case x of 1 => a | _ => b c", "(case x of 1 => a | _ => (b c))"),
        ("x : int * int", "(x : int * int)"),
        ("(x : int, y)", "{1=(x : int), 2=y}"),
        ("f x handle A => 1 | B => 2", "((f x) handle A => 1 | B => 2)"),
        ("raise E handle A => 1", "(raise (E handle A => 1))"),
        ("(a; b; c)", "(a; b; c)"),
        ("{b = 1, a = ()}", "{b=1, a={}}"),
        ("#1 p + #name r", "((#1 p) + (#name r))"),
        ("[[1], [], [a + b]]", "[[1], [], [(a + b)]]"),
        ("let val x = 1 in x; y end", "LetExp"),
        ("a andalso b andalso c", "(a andalso (b andalso c))"),
    ],
)
def test_precedence(text: str, expected: str) -> None:
    assert parsed(text) == expected


def test_user_infix() -> None:
    d = Diagnostics()
    program = parse_program(source("infix 6 plus; infixr 5 cat; fun a plus b = a + b"), d)
    assert program is not None
    fixities = dict(INFIX)
    for dec in program:
        resolved = resolve_declaration(dec, fixities, d)
        assert resolved is not None, [shown(x) for x in d]
        dec, fixities = resolved[0], dict(resolved[1])
    assert isinstance(dec, s.FunDec)
    (binding,) = dec.bindings
    assert isinstance(binding, s.FunBinding)
    assert binding.name == "plus"
    exp = parse_expression(source("a plus b * c cat d cat e"), d)
    assert exp is not None
    resolved_exp = resolve_expression(exp, fixities, d)
    assert resolved_exp is not None
    assert shape(resolved_exp) == "((a plus (b * c)) cat (d cat e))"


def test_fixity_of_a_let_is_local() -> None:
    assert parsed("let infix 6 plus; fun a plus b = a + b in 1 plus 2 end") == "LetExp"
    assert parsed("(let infix 6 plus in 1 end) plus") == "(LetExp plus)"


def test_function_heads() -> None:
    d = Diagnostics()
    text = "fun (a ++ b) c = a | (p ++ q) r = q  and op -- (a, b) = a  and f {x, ...} [] : int = 1"
    program = parse_program(source(text), d)
    assert program is not None
    resolved = resolve_declaration(program[0], INFIX, d)
    assert resolved is not None, [shown(x) for x in d]
    dec = resolved[0]
    assert isinstance(dec, s.FunDec)
    heads = [
        (b.name, len(b.clauses), len(b.clauses[0].patterns), b.clauses[0].result is not None)
        for b in dec.bindings
        if isinstance(b, s.FunBinding)
    ]
    assert heads == [("++", 2, 2, False), ("--", 1, 1, False), ("f", 1, 2, True)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1`x ++", "fixity-error | operator `++` has no right operand | ++"),
        ("-5", "fixity-error | operator `-` has no left operand | -"),
        ("a andalso", "fixity-error | an expression is missing beside `andalso` | andalso"),
        (
            "1 + if a then 2 else 3",
            "fixity-error | `if` must be in parentheses here | if a then 2 else 3",
        ),
        ("(1, 2", "syntax-error | text ends too early, `)` or `,` expected | "),
        ("if a then b", "syntax-error | text ends too early, `else` expected | "),
        ("[1,,2]", "syntax-error | unexpected `,`, an expression expected | ,"),
        ("f (x, )", "syntax-error | unexpected `)`, an expression expected | )"),
        ("fn x y", "syntax-error | text ends too early, `=>` expected | "),
        ("", "syntax-error | text is empty, an expression expected | "),
        ("(* only this *)", "syntax-error | text is empty, an expression expected | "),
        ("x as y", "syntax-error | `as` cannot be used here | as"),
        ("val x = 1", "syntax-error | unexpected `val`, an expression expected | val"),
        (
            '"a\tb"',
            "lexical-error | a string holds a tab or another character that is not printed | \t",
        ),
    ],
)
def test_syntax_errors(text: str, expected: str) -> None:
    assert errors(text) == [expected]


def test_wildcard_has_advice() -> None:
    d = Diagnostics()
    assert parse_expression(source("1`_"), d) is None
    assert d.items[0].code == "syntax-error"
    assert "use a variable" in d.items[0].hint


def test_a_negative_number_behind_the_sign_of_equality_has_advice() -> None:
    d = Diagnostics()
    assert parse_expression(source("{y=~1.0}"), d) is None
    assert d.items[0].message == "unexpected `=~`, `=` expected"
    assert "put a blank between them, `= (~5)`" in d.items[0].hint


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("fun f = 3", "fixity-error | function `f` has no argument | f"),
        ("fun f x = 1 | g x = 2", "function-clauses | clause of `g` among the clauses of `f` | g"),
        (
            "fun f x = 1 | f x y = 2",
            "function-clauses | this clause of `f` has 2 arguments, the first has 1 | f x y = 2",
        ),
        ("val f x = 3", "unknown-constructor | "),
        ("signature S = sig val x = 1 end", "syntax-error | unexpected `=`, `:` expected | ="),
        (
            "colset X = int;",
            "unsupported-ml | a `colset` declaration as plain text is not supported | colset",
        ),
        (
            "val a = 1; color X = int;",
            "unsupported-ml | a `color` declaration as plain text is not supported | color",
        ),
        (
            'use "f.sml"',
            "used-file | the file `f.sml` cannot be used here | ",
        ),
        ("val x 3", "syntax-error | text ends too early, `=` expected | "),
        ("val (x = 3", "syntax-error | unexpected `=`, `)`, `,` or `|` expected | ="),
    ],
)
def test_errors_in_declarations(text: str, expected: str) -> None:
    m = Ml(bare=True)
    m.ml(text)
    assert len(m.d.items) == 1
    assert m.messages()[0].startswith(expected)


def test_names_of_a_text_that_cannot_be_parsed() -> None:
    assert declared_names(source("val x = ( fun f x = and g = 2")) == ("x", "f", "g")


def test_parentheses_around_all_before_the_first_delay() -> None:
    tokens = tokenize(source("1`x++1`y@+3+++1`z@+1"), Diagnostics())
    assert tokens is not None
    texts = [t.kind if not t.text else t.text for t in insert_delay_parentheses(tokens)]
    assert "".join(texts) == "LPAREN1`x++1`yRPAREN@+3+++1`z@+1"
    assert insert_delay_parentheses(tokens[:3]) == tokens[:3]


def test_code_segments() -> None:
    d = Diagnostics()
    code = parse_code(source("input (n, m);\noutput (s);\naction\n  f n; g m;"), d)
    assert code is not None, [shown(x) for x in d]
    assert code.inputs is not None and code.inputs.span.text == "(n, m)"
    assert code.outputs is not None and code.outputs.span.text == "s"
    assert isinstance(code.action, s.SequenceExp)
    only_action = parse_code(source("action ()"), d)
    assert only_action is not None and only_action.inputs is None
    # `input`, `output` and `action` are names elsewhere
    assert parsed("input + output action") == "(input + (output action))"


@pytest.mark.parametrize(
    "text",
    [
        "(" * 5000 + "1" + ")" * 5000,
        "[" * 3000 + "]" * 3000,
        "if b then n else " * 3000 + "n",
        "length " * 3000 + "l",
    ],
)
def test_nesting_is_limited_not_fatal(text: str) -> None:
    m = Ml()
    assert m.inscription(text, "INT") is None
    (message,) = m.messages()
    assert message.startswith("too-deep | this is nested more than ")


@pytest.mark.parametrize(
    ("text", "colset"),
    [
        (" + ".join(["n"] * 3000), "INT"),
        ("b orelse " * 3000 + "b", "BOOL"),
        ("n :: " * 3000 + "l", "L"),
    ],
)
def test_long_chains_are_not_deep(text: str, colset: str) -> None:
    m = Ml()
    assert m.inscription(text, colset) is not None, m.messages()


def test_deep_enough_for_people() -> None:
    m = Ml()
    assert m.inscription("(" * 150 + "1" + ")" * 150, "INT") == "token 1"
    assert m.inscription("if b then n else " * 100 + "n", "INT") is not None
    assert m.inscription("n :: " * 150 + "nil", "L") is not None
    assert m.inscription("[" + "n, " * 3000 + "n]", "L") is not None
    assert not m.d.items


def test_spans_are_offsets_in_the_text() -> None:
    exp = parse_expression(source("  f (x,\n y)"), Diagnostics())
    assert exp is not None
    assert (exp.span.start, exp.span.text) == (2, "f (x,\n y)")
    assert (exp.span.origin.line, exp.span.origin.column) == (1, 3)


@pytest.mark.parametrize("digit", ["~1", "10", "0x1F", "99999999999999999999"])
def test_a_precedence_is_a_digit(digit: str) -> None:
    net = f"net X\n  standard\n  fun f (a, b) = a + b;\n  infix {digit} f\n  place A : INT\n"
    d = netbuilder.diagnose(net)
    assert [(e.code, e.message) for e in d.errors] == [
        ("fixity-error", "the precedence of an infix operator is a digit, 0 to 9")
    ]


@pytest.mark.parametrize(
    "text", ["List .map f", "List. map f", "List (* (* a *) *) . (* b *)\n map f", "List\n.map f"]
)
def test_white_space_and_comments_inside_long_names(text: str) -> None:
    d = Diagnostics()
    tokens = tokenize(source(text), d)
    assert tokens is not None
    assert [t.text for t in tokens] == ["List.map", "f"]


@pytest.mark.parametrize("text", ["f . val", "1 . map", "f .", "val . x", "f . (* "])
def test_a_point_that_continues_no_name(text: str) -> None:
    d = Diagnostics()
    assert tokenize(source(text), d) is None
    assert {e.code for e in d.errors} == {"lexical-error"}


def test_operators_to_different_sides_are_taken_from_the_left() -> None:
    d = Diagnostics()
    exp = parse_expression(source("a :: b ^^ c"), d)
    assert exp is not None
    resolved = resolve_expression(exp, INFIX, d)
    assert isinstance(resolved, s.InfixExp)
    assert resolved.operator.name == "^^"
    assert [w.code for w in d] == ["mixed-operators"]


@pytest.mark.parametrize(
    "text",
    [
        "val x = {INT.a = 1}", "val x = {0 = 1}", "val x = {01 = 1}", "fun S.f x = 1", "datatype S.t = A",
        "datatype t = S.A",
        "type S.t = int", "exception S.E", "structure A.B = struct end", "signature A.B = sig end", "infix S.f",
        "functor F.G () = struct end", "val f = fn (S.x as y) => 1", 'val x = "\\u0041"',
        "val x = (1; 2;)", "val x = let in 1; end",
    ],
)  # fmt: skip
def test_what_sml_does_not_read(text: str) -> None:
    d = Diagnostics()
    program = parse_program(source(text), d)
    for dec in program or ():
        resolve_declaration(dec, INFIX, d)
    assert d.has_errors


def test_a_name_that_is_an_operator_is_told() -> None:
    assert "another name" in missing_operand("o", "left")
    assert "another name" not in missing_operand("++", "left")
