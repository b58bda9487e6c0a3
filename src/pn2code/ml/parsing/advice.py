"""What to do about a mistake: the hints of CPN ML's messages, in one place.

Each function gets what is known where a message is made, and gives a sentence or "". They know
the habits that people bring from other languages (`&&`, `!=`, `-1`, 'text'), and CPN ML's own traps
(`@`, `==`, the backquote).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from pn2code.diagnostics.suggestions import nearest

if TYPE_CHECKING:
    from pn2code.ml.parsing.lexer import Lexeme

FOREIGN_OPERATORS: dict[str, str] = {
    "&&": "write `andalso`",
    "||": "write `orelse`",
    "&": "write `andalso`",
    "or": "write `orelse`",
    "=<": "write `<=`",
    "=>": "write `>=`",
    "===": "write `=`",
    "\\=": "write `<>`",
    "/=": "write `<>`",
    "is": "write `=`",
    "++=": "there is no assignment to variables: give the new value to a variable of its own",
}
"""Operators of other languages, and what CPN ML has instead."""

_WORDS: dict[str, str] = {
    "return": "CPN ML has no `return`: the value of an expression is its result",
    "null": "CPN ML has no `null`; `NONE`, `[]` or `empty` may be meant",
    "elseif": "write `else if`",
    "elif": "write `else if`",
    "begin": "CPN ML groups with `(..; ..)` or `let .. in .. end`",
    "xor": "`a <> b` is the exclusive or of two conditions",
    "toString": "name the type: `Int.toString`, `Real.toString`, or `C.mkstr` of a colour set C",
    "strlen": "the length of a string is `String.size`",
    "len": "the length of a list is `length`, of a string `String.size`",
    "append": "lists are joined with `^^`",
    "foreach": "`List.app f l` applies a function to each element of a list",
    "for": "CPN ML has no loop `for`: use `List.tabulate`, `map` or a recursive function",
    "def": "functions are declared with `fun`: `fun f x = ..`",
    "function": "functions are declared with `fun`: `fun f x = ..`",
    "define": "functions are declared with `fun`: `fun f x = ..`",
    "colset": "colour sets are separate declarations in CPN Tools, not part of an expression",
    "var": "variables are separate declarations in CPN Tools, not part of an expression",
    "println": '`print` takes one string; a line ends with "\\n"',
    "printf": "`print` takes one string; numbers are converted with `Int.toString`",
}
_LIST_FUNCTIONS = frozenset(
    {"nth", "exists", "find", "last", "take", "drop", "tabulate", "partition"}
)
_MEMBERS = [
    "all", "size", "ord", "col", "ran", "mkstr", "mkstr_ms", "lt", "legal", "mult", "input", "output", "input_ms",
    "output_ms", "illegal_msg", "cmp",
]  # fmt: skip
_OLD_MEMBERS: dict[str, str] = {
    **{name: name for name in _MEMBERS},
    "mkst": "mkstr",
    "mkst_col": "mkstr",
    "mkst_ms": "mkstr_ms",
    "input_col": "input",
    "output_col": "output",
}
"""Functions of a colour set in Design/CPN, `all'C`, and what they are called today, where that is another name."""
_OUTSIDE = {
    "MSC": "message sequence charts",
    "SPN": "BritNeY",
    "Britney": "BritNeY",
    "TCP": "sockets",
    "Visualize": "the visualization extension",
}


_STATE_SPACE = frozenset(
    {"ListDeadMarkings", "SearchNodes", "SearchArcs", "NodeDescriptor", "ArcDescriptor", "InitNode", "EntireGraph",
     "DeadMarking", "HomeSpace", "Reachable", "SccReachable", "NoOfNodes", "NoOfArcs", "OutNodes", "InNodes"}
)  # fmt: skip

BY_CODE: dict[str, str] = {
    "duplicate-name": "remove or rename one of them",
    "circular-type": "a function cannot be given itself as an argument",
    "not-an-exception": 'declare one, `exception Bad of string`, and write `raise Bad ".."`; or `raise Fail ".."`',
    "constructor-argument": "a constructor without an argument is written alone",
    "function-clauses": "all clauses of a function have the same number of arguments",
    "unknown-colour-set": "declare it above what uses it, e.g. `colset NAME = int;`",
    "unbound-identifier": "declare it before this place, or look whether it is misspelled",
    "no-such-operator": "both operands must be numbers of one type; comparisons also work on strings",
    "type-mismatch": "write a value of the expected type here, or convert this one",
    "guard-not-boolean": "a guard is a condition such as `n > 0`, or a list of conditions",
    "unknown-field": "look at the declaration of the record",
    "syntax-error": "look before this place, too: a bracket, an operator or a word may be missing there",
    "colour-set-range": "write the lower bound first",
}
"""What to do, where nothing better is known."""

DEFINITIONS: dict[str, str] = {
    "unit": "colset E = unit with e;",
    "bool": "colset SWITCH = bool with (off, on);",
    "int": "colset N = int with 1..10;",
    "string": 'colset WORD = string with "a".."z" and 1..8;',
    "enum": "colset LIGHT = with red | green;",
    "index": "colset SITE = index site with 1..5;",
    "product": "colset PAIR = product INT * STRING;",
    "record": "colset POINT = record x: INT * y: INT;",
    "list": "colset INTS = list INT;",
    "union": "colset MSG = union Data: STRING + Ack;",
    "subset": "colset EVEN = subset INT by even;",
    "alias": "colset TICKET = INT;",
}
"""How colour sets of each kind are written."""


CLOSE = 0.7
"""How much alike a name and what may have been meant are, at least; see `nearest`."""


def behind_slashes(before: str) -> str:
    """Of an unknown name in a text that may be meant as a comment: what stands before it."""
    line = re.sub(r'"[^"]*"', "", before.rpartition("\n")[2])
    return "a comment is written `(* .. *)`; `//` is an operator" if "//" in line else ""


def unsupported(name: str) -> str:
    """For a function of CPN Tools that pn2code does not have."""
    if name == "inst":
        return (
            "it is the number of the page instance, which arcs, guards, delays, code segments and initial markings "
            "know, and the functions declared with `fun` or `fn` that they call: let one of them call it"
        )
    if name.startswith("IOUtil."):
        return "it lets a function read from or write to a file in place of the standard streams: use `TextIO.openIn`"
    if name.endswith(".model_time"):
        return "it is the clock of the engine itself, a reference: write `time ()` for what `!` of it is"
    return "write a function of your own for it" if "." in name else ""


def unbound_word(name: str, colsets: Iterable[str]) -> str:
    """For a name that is declared nowhere and is like no other."""
    if name in _LIST_FUNCTIONS:
        return f"it is called `List.{name}`"
    if name in _WORDS:
        return _WORDS[name]
    if name in _STATE_SPACE:
        return "it belongs to the state-space tool, and does not exist before a state space has been computed"
    member, apostrophe, colset = name.partition("'")
    if apostrophe and member in _OLD_MEMBERS and colset in set(colsets):
        return f"this is the spelling of Design/CPN: write `{colset}.{_OLD_MEMBERS[member]}`"
    if name in set(colsets):
        return f"`{name}` is a colour set; here one of its values or a variable is needed"
    return ""


def variable_out_of_scope(part: str) -> str:
    """For a variable of the net in a text where it has no value."""
    match part:
        case "initial marking":
            return "it is a variable of the net, which has a value only while a transition occurs: write a value"
        case "priority":
            return (
                "it is a variable of the net; priorities are constants, the same for all bindings"
            )
        case "code segment":
            return "it is a variable of the net: list it in `input (..)`"
        case _:
            return "it is a variable of the net: give it to a function as an argument"


def unbound_path(structure: str, member: str, colsets: Iterable[str], known: Iterable[str]) -> str:
    """For `structure.member`; `known` are all names of the library."""
    names = [n for n in known if not n.startswith("CPN'")]
    members = [n.rpartition(".")[2] for n in names if n.rpartition(".")[0] == structure]
    if members:
        close = nearest(member, members, cutoff=CLOSE)
        nothing = f"structure `{structure}` has no function of that name"
        return f"did you mean `{structure}.{close}`?" if close else nothing
    structures = {n.rpartition(".")[0] for n in names} - {""}
    if structure in _OUTSIDE:
        return f"`{structure}` ({_OUTSIDE[structure]}) is a library outside of CPN Tools that is not loaded"
    fitting = {n for n in structures if f"{n}.{member}" in names}
    own = set(colsets) if member in _MEMBERS or member.startswith(("set_", "of_")) else set()
    close = nearest(structure, own, fitting, cutoff=0.5)
    missing = f"there is no structure or colour set `{structure}`"
    return f"did you mean `{close}.{member}`?" if close else missing


# --- syntax


def unknown_character(char: str, before: str) -> tuple[str, str]:
    """How a character that CPN ML does not know is called, and a hint."""
    code = ord(char)
    if not char.isprintable() or char.isspace():
        return (
            f"an invisible character (U+{code:04X}) is not known in CPN ML",
            "delete it, and type the text around it again",
        )
    hint = ""
    if char in "´‘’" and before.rstrip()[-1:].isdigit():
        hint = "a backquote belongs between coefficient and token: 1`v"
    elif char in "‘’“”„«»":
        hint = 'strings are written with straight quotes: "text"'
    elif char == "´":
        hint = "the backquote of a multi-set is the other one: 1`v"
    elif char in "–—−":
        hint = "minus is `-`, and `~` in front of a negative number"
    elif char == ".":
        hint = "a decimal number needs a digit before and after the point: `0.5`"
    elif char in "≤≥≠×÷·":
        signs = {"≤": "<=", "≥": ">=", "≠": "<>", "×": "*", "·": "*", "÷": "div"}
        hint = f"write `{signs[char]}`"
    elif char.isalpha():
        hint = "names consist of the letters a to z, digits, `_` and `'`; other letters only in strings"
    else:
        hint = "outside of strings CPN ML uses the characters of plain ASCII only"
    return f"character `{char}` is not known in CPN ML", hint


def missing_operand(operator: str, side: str) -> str:
    """For an infix operator without one of its operands."""
    if operator in ("-", "~") and side == "left":
        return "negative numbers are written with a tilde: `~5`"
    if operator == "`":
        return (
            "the coefficient is missing before the backquote: 1`v"
            if side == "left"
            else "the token is missing: 1`v"
        )
    if operator in ("@+", "@++"):
        return (
            f"write `{operator} delay`, e.g. `{operator} 5`"
            if side == "right"
            else "the delayed token is missing"
        )
    if operator.isalpha():
        return f"`{operator}` is an operator between two values; a variable or function needs another name"
    return f"write what is missing on the {side} of `{operator}`"


def adjacent_symbols(name: str, known: set[str]) -> str:
    """For two operators written without a blank between, such as `+~`."""
    if name in FOREIGN_OPERATORS:
        return FOREIGN_OPERATORS[name]
    known = known | {"=", "*"}
    for cut in range(len(name) - 1, 0, -1):
        first, rest = name[:cut], name[cut:]
        if first in known and rest in known | {"#", "~"}:
            if first == "`":
                return "negative numbers after the backquote need parentheses: 1`(~5)"
            tail = "(~5)" if rest in ("~", "-") else rest
            return (
                f"adjacent symbols are read as one name: put a blank between them, `{first} {tail}`"
            )
    return ""


def syntax(
    kind: str,
    text: str,
    before: Sequence[Lexeme],
    after: Sequence[Lexeme],
    expected: frozenset[str],
    start: str,
) -> str:
    """For a token that cannot stand where it does.

    Args:
        kind: its terminal, "$END" at the end.
        text: as written.
        before, after: the tokens before and after it.
        expected: terminals that could stand there.
        start: what is parsed: "expression", "expressions", "program", "code".
    """
    previous = before[-1] if before else None
    last = previous.kind if previous else ""
    texts = {t.text for t in before}
    if "?" in texts:
        return "a choice is written `if condition then .. else ..`"
    if "elseif" in texts or "elif" in texts:
        return "write `else if`"
    if (
        "WILD" in expected
        and kind == text.upper()
        and text.isalpha()
        and last in ("VAL", "FUN", "LPAREN", "COMMA")
    ):
        return f"`{text}` is a keyword and cannot be a name"
    match kind:
        case "ID" if last == "LET":
            return "after `let` come declarations: `let val y = .. in .. end`"
        case "RPAREN" if previous is not None and previous.text == "*" and not _open(before):
            return "this `*)` closes no comment"
        case "WILD":
            return "`_` is allowed only in patterns of functions, `case` and `val`; use a variable here"
        case "TYVAR":
            if last == "INT":
                return "a backquote belongs between coefficient and token: 1`v"
            if text.endswith("'") and len(text) > 1:
                return f'strings are written with double quotes: "{text.strip(chr(39))}"'
        case "EQ":
            if last == "FUN":
                return "a function needs a name and an argument: `fun f x = ..`"
            if "DARROW" in expected:
                return "the parts of a rule are joined with `=>`: `pattern => result`"
        case "COLON" if "EQ" in expected and "LBRACE" in {t.kind for t in before}:
            return "the fields of a record are given with `=`: {name = .., age = ..}"
        case "COMMA":
            if "{" in texts and "EQ" in expected:
                return "a record is written {field = value, ..}; a list is written [..], a multi-set 1`v ++ 1`w"
            numbers = last == "INT" and len(after) == 1 and after[0].kind == "INT"
            if numbers and start == "expression" and len(before) == 1:
                return "a decimal number is written with a point: 2.5; several tokens are added with `++`: 1`1 ++ 1`2"
            if start == "expression" and not _open(before):
                return (
                    "a tuple needs parentheses: (a, b); multi-sets are added with `++`: 1`a ++ 1`b"
                )
        case "SEMI" if start == "expressions" and after:
            return "conditions are separated by commas: [n > 1, m < 5]"
        case "SEMI" if start.startswith("expression"):
            return "an inscription does not end with `;`"
        case "AND" if start != "program":
            return "conditions are joined with `andalso`"
        case "IN" if start.startswith("expression") and "let" not in texts:
            return "`mem list value` tells whether a value is in a list"
        case "INPUT" | "OUTPUT" | "ACTION":
            return "the parts of a code segment come in the order `input (..); output (..); action ..;`"
        case "OF" | "THEN" | "ELSE" | "IN" | "END" if kind not in expected:
            return _block_word(kind, before)
        case "RPAREN" | "RBRACK" | "RBRACE":
            return _closing(text, before)
        case "DARROW" if "THEN" in expected:
            return FOREIGN_OPERATORS["=>"]
        case "DARROW" if "OF" in expected:
            return "`case` is written `case value of pattern => result | pattern => result`"
        case "DARROW" if texts.isdisjoint({"fn", "case", "handle"}):
            return FOREIGN_OPERATORS["=>"]
        case "ID" if text in FOREIGN_OPERATORS:
            return FOREIGN_OPERATORS[text]
        case "ID" if text.startswith("=") and (hint := adjacent_symbols(text, set())):
            return hint
        case _ if start == "code" and not before:
            return "a code segment is written `input (..); output (..); action ..;`"
        case "$END":
            return _at_end(last, before, expected)
    if "THEN" in expected and kind != "$END":
        return "`if` is written `if condition then .. else ..`"
    return ""


def _block_word(kind: str, before: Sequence[Lexeme]) -> str:
    kinds = [t.kind for t in before]
    match kind:
        case "ELSE" if kinds.count("IF") > kinds.count("THEN"):
            return "`then` is missing: `if condition then .. else ..`"
        case "ELSE" | "THEN":
            return f"`{kind.lower()}` belongs to an `if` before it"
        case "END" if kinds.count("LET") > kinds.count("IN"):
            return "`in` is missing: `let declarations in expression end`"
        case "END":
            return "`end` closes `let .. in ..`"
        case "IN":
            return "`in` belongs to a `let` before it"
        case _:
            return "`of` belongs to a `case` before it"


def _open(tokens: Sequence[Lexeme]) -> list[Lexeme]:
    """Brackets that are not closed."""
    stack: list[Lexeme] = []
    for t in tokens:
        if t.kind in ("LPAREN", "LBRACK", "LBRACE"):
            stack.append(t)
        elif t.kind in ("RPAREN", "RBRACK", "RBRACE") and stack:
            stack.pop()
    return [t for t in stack if t.text]


def _closing(text: str, before: Sequence[Lexeme]) -> str:
    opened = _open(before)
    if not opened:
        return f"there is no opening bracket for this `{text}`" if text else ""
    if {"(": ")", "[": "]", "{": "}"}[opened[-1].text] != text and text:
        return f"`{opened[-1].text}` before it is not closed"
    return ""


def _at_end(last: str, before: Sequence[Lexeme], expected: frozenset[str]) -> str:
    opened = _open(before)
    if opened:
        return f"this `{opened[-1].text}` is not closed: {_around(before, opened[-1])}"
    if "ELSE" in expected or last == "THEN":
        return "`if` needs both branches; a branch without tokens is `empty`: `if .. then .. else empty`"
    if "END" in expected:
        return "`let .. in ..` is closed with `end`"
    if "DARROW" in expected and any(t.kind == "HANDLE" for t in before):
        return "`handle` is written `expression handle pattern => value`"
    if "DO" in expected:
        return "`while` is written `while condition do expression`"
    if "EQ" in expected and before and before[0].kind in ("VAL", "FUN"):
        forms = {"VAL": "val name = expression", "FUN": "fun name argument = expression"}
        return f"it is written `{forms[before[0].kind]}`"
    if not before:
        return "write its first value"
    if last == "EQ":
        return "what the name stands for is missing"
    return ""


def _around(tokens: Sequence[Lexeme], token: Lexeme) -> str:
    """A bracket with what follows it."""
    shown = " ".join(t.text for t in tokens if t.start >= token.start)
    shown = shown.replace("( ", "(").replace("[ ", "[").replace(" ,", ",")
    return shown if len(shown) <= 20 else shown[:20] + ".."
