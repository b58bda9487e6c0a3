# ruff: noqa: E501 - tables and rows of texts
"""Random CPN ML over all kinds of colour sets and the whole library: typed expressions, and such with a mistake in them.

`NET` has the colour sets, values and functions that the texts use. A text is made from its type downwards: literals,
functions of the library and of the colour sets whose result fits, `let`, `case`, `fn`, `handle`, declarations.
"""

from __future__ import annotations

import re
from random import Random

from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.types import (  # fmt: skip
    BOOL,
    CHAR,
    EXN,
    INT,
    INTINF,
    REAL,
    STRING,
    UNIT,
    TCon,
    TFun,
    TRecord,
    TVar,
    Type,
    list_of,
    timed_of,
    tuple_of,
)
from pn2code.ml.library.builtins import BUILTINS, HIDDEN, TOP_LEVEL
from pn2code.ml.typing.colset_members import member_type, members_of, timed_member

NET = r"""
net Oracle
  standard
  colset E = unit with e;
  colset SW = bool with (off, on);
  colset SMALL = int with 1..3;
  colset NEG = int with ~2..2 timed;
  colset PART = real with ~1.5..2.5;
  colset WORDS = string with "a".."c" and 1..2;
  colset LETTERS = string with "p".."r";
  colset LIGHT = with red | green | blue;
  colset LIGHTT = with up | down timed;
  colset PH = index ph with 1..3;
  colset PAIR = product INT * STRING;
  colset SPAIR = product SMALL * LIGHT;
  colset TRIPLE = product SW * PH * SMALL timed;
  colset NEST = product SPAIR * E;
  colset REALP = product REAL * INT;
  colset REC = record b: INT * a: STRING;
  colset SREC = record k: SMALL * c: LIGHT timed;
  colset INTS = list INT;
  colset LW = list LIGHT with 0..2;
  colset LONG = list SMALL with 1..2;
  colset LISTS = list INTS timed;
  colset U = union Num: INT + Txt: STRING + Quit;
  colset SU = union Lamp: LIGHT + Cell: SPAIR + Gone;
  colset UT = union Tok: SMALL + Nil timed;
  colset EVEN = subset SMALL by isEven;
  colset FEW = subset INT with [5, 3, 9];
  colset FEWL = subset LIGHT with [blue, red];
  colset MIX = product EVEN * FEW;
  colset LE = list EVEN with 1..2;
  colset UE = union EvenOf: EVEN + FewOf: FEW;
  colset LP = list SPAIR with 0..2;
  colset LSW = list SW with 2..4;
  colset ALI = LIGHT;
  colset ALIR = SREC;
  colset REALT = real timed;
  val four = 4;
  val few = [3, 1, 2];
  fun twice x = x + x;
  fun pick (x, y) = if x < y then x else y;
  exception Own of int;
  exception Bare;
  datatype 'a tree = Leaf | Knot of 'a tree * 'a * 'a tree;
"""
NET = NET.replace("  colset EVEN", "  fun isEven n = n mod 2 = 0;\n  colset EVEN")

_OUTSIDE = re.compile(
    r"^(Int31|Int64|Word64|Real64|LargeReal|CharArray|Random|TextIO|BinIO|IO|OS|Time|Timer|Posix|Unix|Socket|INetSock|SMLofNJ|CommandLine|CPN'|Cpn|Comms|Conn|Output"
    r"|Replications|Queue|Date\.(now|from|local)|Internal|ModelTime\.(model_time|time)|Rand|Misc|NetHostDB|NetServDB)"
)
_DRAWN = {"uniform", "discrete", "bernoulli", "binomial", "normal", "exponential", "poisson", "erlang", "chisq", "student",
    "gamma", "beta", "weibull", "rayleigh", "random", "print", "inst", "use", "time_of_day"}  # fmt: skip
NUMBERS = ("0", "1", "2", "3", "~1", "~2", "5", "7", "31", "100", "1073741823", "~1073741824")
REALS = ("0.0", "1.0", "~1.5", "2.5", "0.5", "~0.5", "1E10", "1E~7", "123456.789", "3.0")
TEXTS = (
    '""',
    '"a"',
    '"b"',
    '"ab"',
    '"abc"',
    '"pq"',
    '"a b c"',
    '"12"',
    '"~7x"',
    '"true"',
    '"1.5e2"',
    '"A\\n"',
    '"\\t\\"q"',
)
CHARS = ('#"a"', '#"Z"', '#"0"', '#" "', '#"\\n"', '#","')
WORD_LITERALS = ("0w0", "0w1", "0wxFF", "0w5", "0wx7FFFFFFF")
OPERATORS = {
    "+": "n n n", "-": "n n n", "*": "n n n", "div": "i i i", "mod": "i i i", "/": "r r r", "^": "s s s", "<": "o o b", "<=": "o o b",
    ">": "o o b", ">=": "o o b", "=": "e e b", "<>": "e e b", "::": "a al al", "^^": "al al al", "++": "al al al", "--": "al al al",
    "==": "al al b", "<><>": "al al b", "<<": "al al b", "<<=": "al al b", ">>": "al al b", ">>=": "al al b", "`": "c a al", "**": "c al al",
    "andalso": "b b b", "orelse": "b b b",
}  # fmt: skip


class Texts:
    """Makes texts.

    Args:
        r: decides.
        colsets: those of `NET`.
    """

    def __init__(self, r: Random, colsets: dict[str, Colset]) -> None:
        self.r = r
        self.colsets = colsets
        self.names = 0
        self.functions: list[tuple[str, Type]] = []
        for name, info in BUILTINS.items():
            if (
                not info.unsupported
                and name not in HIDDEN
                and "." in name
                and not _OUTSIDE.match(name)
            ):
                self.functions.append(
                    (f"(op {name})" if not name.split(".")[-1][0].isalpha() else name, info.type())
                )
        for short, full in TOP_LEVEL.items():
            if short.isidentifier() and short not in _DRAWN and not BUILTINS[full].unsupported:
                self.functions.append((short, BUILTINS[full].type()))
        self.functions = [(n, t) for n, t in self.functions if not n.startswith("(op")]
        self.members: list[tuple[str, Type]] = []
        for colset in colsets.values():
            for member in sorted(members_of(colset)):
                if member != "ran" and "put" not in member:
                    self.members.append((f"{colset.name}.{member}", member_type(colset, member)))
            for member in (
                "all",
                "size",
                "ord",
                "col",
                "lt",
                "cmp",
                "legal",
                "illegal_msg",
                "mkstr",
                "mkstr_ms",
            ):
                known = timed_member(member)
                if colset.timed and known is not None:
                    self.members.append(
                        (f"{colset.name}'timed.{member}", member_type(colset, known))
                    )

    # --- types ---------------------------------------------------------------------------------------

    def type(self, depth: int = 2) -> Type:
        """A type without variables."""
        if depth <= 0 or self.r.random() < 0.6:
            if self.r.random() < 0.4:
                return self.r.choice(list(self.colsets.values())).type
            return self.r.choice(
                (INT, INT, STRING, BOOL, REAL, CHAR, UNIT, INTINF, TCon("word"), TCon("order"))
            )
        inner = self.type(depth - 1)
        match self.r.randrange(6):
            case 0 | 1:
                return list_of(inner)
            case 2:
                return TCon("option", (inner,))
            case 3:
                return tuple_of(inner, self.type(depth - 1))
            case 4:
                return TFun(self.type(0), inner)
            case _:
                return TRecord((("a", inner), ("b", self.type(depth - 1))))

    def open(self, t: Type, chosen: dict[int, Type]) -> Type:
        """With types for its variables."""
        match t:
            case TVar(index):
                if index not in chosen:
                    chosen[index] = self.type(1)
                    while t.equality and not _has_equality(chosen[index]):
                        chosen[index] = self.type(1)
                return chosen[index]
            case TCon():
                return TCon(t.name, tuple(self.open(x, chosen) for x in t.args))
            case TFun():
                return TFun(self.open(t.argument, chosen), self.open(t.result, chosen))
            case TRecord():
                return TRecord(tuple((k, self.open(x, chosen)) for k, x in t.fields))

    # --- expressions ---------------------------------------------------------------------------------

    def expression(self, depth: int = 3) -> str:
        """Of any type: often a function of the library or of a colour set, applied."""
        if self.r.random() < 0.85:
            name, t = self.r.choice(self.members if self.r.random() < 0.4 else self.functions)
            return self.applied(name, t, depth)
        return self.of(self.type(), depth)

    def applied(self, name: str, t: Type, depth: int) -> str:
        """A function with all of its arguments, sometimes with fewer."""
        t = self.open(t, {})
        text = name
        while isinstance(t, TFun) and self.r.random() < 0.97:
            argument = self.of(t.argument, depth - 1)
            if self.r.random() < 0.02:
                argument = self.of(self.type(), 1)
            text += f" {self.atom(argument)}"
            t = t.result
        return text

    def atom(self, text: str) -> str:
        """In parentheses, if it is not one word or in parentheses already."""
        if re.fullmatch(r"[\w.']+|\"[^\"\\]*\"|\(\)|\[[^][]*\]", text):
            return text
        return f"({text})"

    def of(self, t: Type, depth: int) -> str:
        """Of a type."""
        if depth > 0:
            roll = self.r.random()
            if roll < 0.25:
                fitting = [(n, f) for n, f in self.r.sample(self.functions, 60) if _result(f) == t]
                fitting += [(n, f) for n, f in self.members if _result(f) == t][:40]
                if fitting:
                    return self.whole(*self.r.choice(fitting), depth)
            if roll < 0.40:
                made = self.operation(t, depth)
                if made:
                    return made
            if roll < 0.50:
                return self.block(t, depth)
        return self.value(t, depth)

    def whole(self, name: str, t: Type, depth: int) -> str:
        t = self.open(t, {})
        text = name
        while isinstance(t, TFun):
            text += f" {self.atom(self.of(t.argument, depth - 1))}"
            t = t.result
        return f"({text})"

    def operation(self, t: Type, depth: int) -> str | None:
        small = self.r.choice(NUMBERS[:9])
        for op in self.r.sample(list(OPERATORS), len(OPERATORS)):
            left, right, result = OPERATORS[op].split()
            free: dict[str, Type] = {"i": INT, "c": INT, "r": REAL, "s": STRING, "b": BOOL}
            free["n"] = self.r.choice((INT, REAL, INTINF))
            free["o"] = self.r.choice((INT, REAL, STRING, CHAR))
            free["e"] = self.r.choice((INT, STRING, REAL, list_of(INT), tuple_of(INT, BOOL)))
            free["a"] = self.r.choice(
                (INT, STRING, self.r.choice(list(self.colsets.values())).type)
            )
            if result == "al" and isinstance(t, TCon) and t.name == "list":
                free["a"] = t.args[0]
            if not _has_equality(free["a"]):
                continue
            free["al"] = list_of(free["a"])
            if result == "n" and t in (INT, REAL, INTINF):
                free["n"] = t
            if free[result] == t:
                first = (
                    small if left == "c" else self.of(free[left], depth - 1)
                )  # coefficients stay small
                return f"({first} {op} {self.of(free[right], depth - 1)})"
        return None

    def block(self, t: Type, depth: int) -> str:
        """`let`, `case`, `if`, `handle` and the like."""
        self.names += 1
        x, other = f"x{self.names}", self.type(1)
        inner, value = self.of(t, depth - 1), self.of(other, depth - 1)
        match self.r.randrange(8):
            case 0:
                return f"let val {x} = {value} in {inner} end"
            case 1:
                return f"let fun {x} y = {inner} in {x} {self.atom(value)} end"
            case 2:
                return f"(if {self.of(BOOL, depth - 1)} then {inner} else {self.of(t, depth - 1)})"
            case 3:
                return f"(case {self.of(INT, depth - 1)} of 0 => {inner} | {x} => {self.of(t, depth - 1)})"
            case 4:
                return f"(case {self.of(list_of(INT), depth - 1)} of {x} :: _ => {inner} | nil => {self.of(t, depth - 1)})"
            case 5:
                return f"({inner} handle _ => {self.of(t, depth - 1)})"
            case 6:
                return (
                    f"let datatype d = {x.upper()} of int | N val v = {x.upper()} 3 in {inner} end"
                )
            case _:
                raised = self.r.choice(("Own 3", "Bare", 'Fail "f"', "Empty", "Subscript"))
                return f"(if {self.of(BOOL, depth - 1)} then {inner} else raise {raised})"

    def value(self, t: Type, depth: int) -> str:
        """A literal or something made of literals."""
        r = self.r
        match t:
            case TFun(_, result):
                if t == TFun(tuple_of(INT, INT), BOOL):
                    return r.choice(("Int.<", "(fn (a, b) => a > b)", "(op <=)", "INT.lt"))
                self.names += 1
                return f"(fn x{self.names} => {self.of(result, depth - 1)})"
            case TRecord(fields):
                parts = [(k, self.of(x, depth - 1)) for k, x in fields]
                if not fields or t.is_tuple:
                    return f"({', '.join(text for _, text in parts)})"
                return (
                    "{"
                    + ", ".join(f"{k} = {text}" for k, text in r.sample(parts, len(parts)))
                    + "}"
                )
            case TCon(name, args):
                return self.constructed(name, args, depth)
            case _:
                return "nil"

    def constructed(self, name: str, args: tuple[Type, ...], depth: int) -> str:
        r = self.r
        simple = {
            "int": NUMBERS,
            "IntInf.int": NUMBERS,
            "real": REALS,
            "string": TEXTS,
            "char": CHARS,
            "word": WORD_LITERALS,
        }
        match name:
            case "int" if r.random() < 0.1:
                return r.choice(("four", "(hd few)", "(twice 3)", "(pick (2, 5))"))
            case _ if name in simple:
                return r.choice(simple[name])
            case "time":
                return r.choice(NUMBERS[:8])
            case "bool":
                return r.choice(("true", "false"))
            case "order":
                return r.choice(("LESS", "EQUAL", "GREATER"))
            case "list":
                return f"[{', '.join(self.of(args[0], depth - 1) for _ in range(r.choice((0, 1, 1, 2, 3))))}]"
            case "option":
                return (
                    "NONE"
                    if r.random() < 0.3
                    else f"(SOME {self.atom(self.of(args[0], depth - 1))})"
                )
            case "timed":
                return f"({self.of(args[0], depth - 1)} @ {r.choice(NUMBERS[:5])})"
            case "ref":
                return f"(ref {self.atom(self.of(args[0], depth - 1))})"
            case "vector":
                return f"(Vector.fromList {self.of(list_of(args[0]), depth - 1)})"
            case "array":
                return f"(Array.fromList {self.of(list_of(args[0]), depth - 1)})"
            case "substring":
                return f"(Substring.full {self.of(STRING, depth - 1)})"
            case "exn":
                return r.choice(("Bare", "(Own 2)", "Empty", '(Fail "x")', "Div"))
            case "StringCvt.radix":
                return r.choice(
                    ("StringCvt.BIN", "StringCvt.OCT", "StringCvt.DEC", "StringCvt.HEX")
                )
            case "StringCvt.realfmt":
                return r.choice(
                    ("(StringCvt.FIX (SOME 2))", "(StringCvt.SCI NONE)", "(StringCvt.GEN (SOME 4))")
                )
            case "IEEEReal.rounding_mode":
                return r.choice(("IEEEReal.TO_NEAREST", "IEEEReal.TO_ZERO", "IEEEReal.TO_POSINF"))
            case "Word8.word" | "Word32.word":
                structure = name.split(".")[0]
                return f"({structure}.fromInt {r.choice(('65', '~1', '0', '200'))})"
            case "Int32.int":
                return r.choice(("(Int32.fromInt 7)", "(Int32.fromInt ~3)", "(valOf Int32.maxInt)"))
            case "Word8Vector.vector":
                return '(Byte.stringToBytes "ab")'
            case "Date.month":
                return r.choice(("Date.Jan", "Date.Dec"))
        for colset in self.colsets.values():
            if colset.type == TCon(name) and colset.resolved.kind.name in (
                "ENUM",
                "UNION",
                "INDEX",
            ):
                return self.colour(colset.resolved, depth)
        return "(raise Bare)"

    def colour(self, c: Colset, depth: int) -> str:
        """A value of an enumeration, an index or a union."""
        if c.kind.name == "INDEX":
            return f"({c.names[0]} {self.r.choice(('1', '2', '3', '3', '4', '0'))})"
        i = self.r.randrange(len(c.names))
        part = c.components[i] if c.components else None
        return (
            c.names[i]
            if part is None
            else f"({c.names[i]} {self.atom(self.of(part.type, depth - 1))})"
        )

    # --- mistakes ------------------------------------------------------------------------------------

    def damaged(self, text: str) -> str:
        """With a word changed, left out or doubled."""
        words = re.findall(r'"(?:[^"\\]|\\.)*"|[\w.\']+|\s+|[^\w\s]', text)
        solid = [i for i, w in enumerate(words) if not w.isspace()]
        i = self.r.choice(solid)
        match self.r.randrange(4):
            case 0:
                words[i] = self.r.choice(
                    (
                        "1",
                        '"a"',
                        "true",
                        "()",
                        "nil",
                        "1.5",
                        "red",
                        "x",
                        "fn",
                        ",",
                        "=",
                        "INT.mkstr",
                        "op",
                    )
                )
            case 1:
                words[i] = ""
            case 2:
                words[i] += " " + words[i]
            case _:
                j = self.r.choice(solid)
                words[i], words[j] = words[j], words[i]
        return "".join(words)


def _result(t: Type) -> Type:
    while isinstance(t, TFun):
        t = t.result
    return t


def _has_equality(t: Type) -> bool:
    match t:
        case TFun():
            return False
        case TRecord(fields):
            return all(_has_equality(x) for _, x in fields)
        case TCon(name, args):
            return name not in ("exn", "substring") and all(map(_has_equality, args))
        case _:
            return True


__all__ = ["NET", "Texts", "EXN", "timed_of"]
