# ruff: noqa: E501 - rows of texts
"""Random CPN ML: sentences of a small grammar, soups of tokens, texts with tokens changed, and what is too deep or too long.

All functions take a `random.Random` and give a text; most texts are wrong, which is the point.
"""

from __future__ import annotations

import re
from random import Random

NAMES = (
    "n", "m", "s", "p", "x", "y", "f", "g", "INT", "STRING", "BOOL", "UNIT", "REAL", "PART", "e", "1", "2", "empty", "nil", "true",
    "false", "NONE", "SOME", "size", "List.map", "foldl", "INT.mkstr", "String.size", "INT.all", "ms_to_list", "ref", "not", "hd",
    "tl", "op +", "op ++", "Fail", "Match", "time", "step", "intInf", "mult", "Substring.full", "Int.toString", "Real.floor",
    "uniform", "discrete", "valOf", "ignore", "print", "TextIO.openIn", "Array.array", "Vector.fromList", "o", "ext_ms_tms", "T1", "MakeSML",
)  # fmt: skip
LITERALS = (
    "0", "1", "~1", "42", "1073741823", "1073741824", "99999999999999999999", "0x1F", "0xfffffffffffffff", "0w7", "0wxFF", "1.5", "~0.0",
    "1e400", "1E~400", "2e", '""', '"a"', '"\\n"', '"\\999"', '"\\u00e9"', '"\\', '#"a"', '#""', '#"ab"', "()", "[]", "1`1", "1.0", '"é"',
)  # fmt: skip
OPERATORS = (
    "+", "-", "*", "/", "div", "mod", "^", "::", "@", "=", "<>", "<", "<=", ">", ">=", "++", "--", "**", "<<", "<<=", "`", "%", "@+", "@@+",
    "+++", "andalso", "orelse", ":=", "o", "before", "rm", "contains", "cf", "=>", ":", "as", "handle", "@", "@@", "++++", "==",
)  # fmt: skip
TOKENS = (
    *NAMES, *LITERALS, *OPERATORS,
    "(", ")", "[", "]", "{", "}", ",", ";", "_", "...", "|", "->", "#", "and", "case", "of", "fn", "fun", "val", "if", "then", "else", "let",
    "in", "end", "local", "open", "datatype", "exception", "raise", "rec", "structure", "struct", "sig", "type", "while", "do", "with",
    "withtype", "infix", "infixr", "nonfix", "op", "input", "output", "action", "abstype", "'a", "''b", "(*", "*)", "colset", "var", "globref",
    "timed", "product", "record", "union", "subset", "by", "index", "list", "#1", "#id", "!", "signature", "functor", "eqtype", ":>", "\\", "$",
    "\x00", "\u2028", "\ufeff", "é",
)  # fmt: skip
_TOKEN = re.compile(
    r'"(?:[^"\\]|\\.)*"|[A-Za-z_][\w\'.]*|\d+(?:\.\d+)?|[!%&$#+\-/:<=>?@\\~`^|*]+|\s+|.', re.S
)


def name(r: Random) -> str:
    """A name that may be there."""
    return r.choice(NAMES)


def pattern(r: Random, depth: int) -> str:
    """A pattern."""
    if depth <= 0 or r.random() < 0.35:
        return r.choice((name(r), "_", r.choice(LITERALS), "x", "y", "nil"))
    kind = r.randrange(8)
    inner = [pattern(r, depth - 1) for _ in range(r.randint(1, 3))]
    match kind:
        case 0:
            return f"({', '.join(inner)})"
        case 1:
            return f"[{', '.join(inner)}]"
        case 2:
            return f"({inner[0]} :: {inner[-1]})"
        case 3:
            return f"(x as {inner[0]})"
        case 4:
            return (
                "{"
                + ", ".join(f"{label} = {p}" for label, p in zip("abc", inner, strict=False))
                + ", ...}"
            )
        case 5:
            return f"SOME {inner[0]}"
        case 6:
            return f"({inner[0]} : {type_(r, 2)})"
        case _:
            return f"({' | '.join(inner)})"


def type_(r: Random, depth: int) -> str:
    """A type."""
    if depth <= 0 or r.random() < 0.4:
        return r.choice(
            (
                "int",
                "string",
                "bool",
                "unit",
                "real",
                "INT",
                "STRING",
                "'a",
                "''a",
                "exn",
                "char",
                "PART",
            )
        )
    a, b = type_(r, depth - 1), type_(r, depth - 1)
    return r.choice(
        (
            f"{a} list",
            f"({a} * {b})",
            f"({a} -> {b})",
            f"{a} option",
            f"{a} ms",
            f"{{a: {a}, b: {b}}}",
            f"({a}, {b}) f",
            f"{a} tms",
            f"{a} ref",
        )
    )


def expression(r: Random, depth: int) -> str:
    """An expression."""
    if depth <= 0 or r.random() < 0.2:
        return name(r) if r.random() < 0.6 else r.choice(LITERALS)
    sub = [expression(r, depth - 1) for _ in range(3)]
    match r.randrange(17):
        case 0 | 1 | 2:
            return f"{sub[0]} {r.choice(OPERATORS)} {sub[1]}"
        case 3 | 4:
            return (
                f"{name(r)} {sub[0]}"
                if r.random() < 0.5
                else f"{name(r)} ({', '.join(sub[: r.randint(1, 3)])})"
            )
        case 5:
            return f"({', '.join(sub[: r.randint(0, 3)])})"
        case 6:
            return f"[{', '.join(sub[: r.randint(0, 3)])}]"
        case 7:
            return f"if {sub[0]} then {sub[1]} else {sub[2]}"
        case 8:
            return f"let {declaration(r, depth - 1)} in {sub[0]} end"
        case 9:
            return f"case {sub[0]} of {rules(r, depth - 1)}"
        case 10:
            return f"(fn {rules(r, depth - 1)})"
        case 11:
            return f"({sub[0]}; {sub[1]})"
        case 12:
            return (
                "{" + ", ".join(f"{label} = {e}" for label, e in zip("abc", sub, strict=True)) + "}"
            )
        case 13:
            return f"#{r.choice(('1', '2', 'a', 'id', '0'))} {sub[0]}"
        case 14:
            return f"({sub[0]} handle {rules(r, depth - 1)})"
        case 15:
            return f"({sub[0]} : {type_(r, 2)})"
        case _:
            return r.choice(
                (
                    f"raise {sub[0]}",
                    f"while {sub[0]} do {sub[1]}",
                    f"!{sub[0]}",
                    f"1`{sub[0]} ++ 2`{sub[1]}@+3",
                )
            )


def rules(r: Random, depth: int) -> str:
    """A match."""
    return " | ".join(f"{pattern(r, 2)} => {expression(r, depth)}" for _ in range(r.randint(1, 3)))


def declaration(r: Random, depth: int) -> str:
    """Declarations as an `ml` element may have them."""
    e = expression(r, depth)
    match r.randrange(12):
        case 0 | 1:
            return f"val {pattern(r, 2)} = {e}"
        case 2 | 3:
            f = r.choice("fgh")
            clauses = [
                f"{f} {pattern(r, 1)} {pattern(r, 1)} = {expression(r, depth)}"
                for _ in range(r.randint(1, 3))
            ]
            return "fun " + " | ".join(clauses)
        case 4:
            return f"val rec f = fn {rules(r, depth)}"
        case 5:
            return f"datatype 'a t = A | B of {type_(r, 2)} | C of 'a t"
        case 6:
            return f"exception E of {type_(r, 2)}"
        case 7:
            return f"structure S = struct {declaration(r, depth - 1) if depth > 0 else ''} end"
        case 8:
            return f"local {declaration(r, depth - 1) if depth > 0 else ''} in val x = {e} end"
        case 9:
            return f"infix{r.choice(('', 'r'))} {r.choice(('3', '99', '', '~1'))} {r.choice(('f', '+', '++', 'g', '='))} fun x f y = {e}"
        case 10:
            return f"type {r.choice(('t', chr(39) + 'a t', 'INT'))} = {type_(r, 3)}"
        case _:
            return f"open {name(r)}; {e}"


def soup(r: Random) -> str:
    """Tokens in any order."""
    return r.choice((" ", "")).join(r.choice(TOKENS) for _ in range(r.randint(1, 60)))


def hostile(r: Random) -> str:
    """Too deep, too long, too large."""
    n = r.choice((10, 100, 1_000, 20_000))
    few = min(n, 1_000)
    return r.choice(
        (
            lambda: "(" * n + "1" + ")" * n,
            lambda: "[" * n + "]" * n,
            lambda: "(" * n,
            lambda: "let val x = " * few + "1" + " in x end" * few,
            lambda: "if true then " * few + "1" + " else 2" * few,
            lambda: "fn x => " * n + "x",
            lambda: "1`n ++ " * n + "1`n",
            lambda: "n :: " * n + "nil",
            lambda: "f " * n,
            lambda: "~" * n + "1",
            lambda: "9" * n,
            lambda: "0x" + "f" * n,
            lambda: "1." + "0" * n + "1e" + "9" * min(n, 50),
            lambda: '"' + "\\n" * n + '"',
            lambda: '"' + "a" * n,
            lambda: "(*" * n,
            lambda: "[" + ", ".join(str(i) for i in range(n)) + "]",
            lambda: "case n of " + " | ".join(f"{i} => {i}" for i in range(few)),
            lambda: "(case n of 0 => " * few + "1" + ")" * few,
            lambda: "let " + " ".join(f"val x{i} = (x{i - 1}, x{i - 1})" if i else "val x0 = 1" for i in range(min(n, 60))) + " in 1 end",
            lambda: "let " + " ".join(f"fun f{i} x = f{i - 1} (x, x)" if i else "fun f0 x = x" for i in range(min(n, 40))) + " in 1 end",
            lambda: "a" * n,
            lambda: "n andalso " * n + "n",
            lambda: "(n, " * few + "1" + ")" * few,
            lambda: "x" + "'" * n,
            lambda: "#1 " * n + "n",
            lambda: f"{n}00000`1",
            lambda: f"List.tabulate ({n}0000, fn i => i)",
            lambda: f"1`1@{10**9}{n}",
            lambda: "let fun f x = f (x + 1) in f 0 end",
            lambda: "let fun f x = 1 + f x in f 0 end",
            lambda: "let fun f x = f (x ^ x) in f \"ab\" end",
            lambda: "let fun f x = f (x @ x) in f [1, 2] end",
            lambda: "while true do ()",
            lambda: "concat (List.tabulate (1000000, fn i => \"0123456789\"))",
        )
    )()  # fmt: skip


def changed(r: Random, text: str, others: list[str]) -> str:
    """A text with some tokens deleted, doubled, swapped, replaced; or mixed with another."""
    tokens = _TOKEN.findall(text)
    if not tokens:
        return r.choice(others) if others else soup(r)
    for _ in range(r.choice((1, 1, 1, 2, 5))):
        i, j = r.randrange(len(tokens)), r.randrange(len(tokens))
        match r.randrange(8):
            case 0:
                tokens[i] = ""
            case 1:
                tokens.insert(i, tokens[i])
            case 2:
                tokens[i], tokens[j] = tokens[j], tokens[i]
            case 3:
                tokens[i] = f" {r.choice(TOKENS)} "
            case 4:
                tokens.insert(i, f" {r.choice(TOKENS)} ")
            case 5:
                del tokens[i:j]
                if not tokens:
                    break
            case 6:
                donor = _TOKEN.findall(r.choice(others)) if others else []
                k = r.randrange(len(donor)) if donor else 0
                tokens[i : i + 1] = donor[k : k + r.randint(1, 8)]
                if not tokens:
                    break
            case _:
                tokens[i] = f"({expression(r, 2)})"
    return "".join(tokens)


def any_text(r: Random, others: list[str]) -> str:
    """Any of these."""
    kind = r.random()
    if kind < 0.3:
        return expression(r, r.randint(1, 4))
    if kind < 0.4:
        return declaration(r, r.randint(1, 4))
    if kind < 0.5:
        return soup(r)
    if kind < 0.58:
        return hostile(r)
    return changed(r, r.choice(others), others) if others else soup(r)
