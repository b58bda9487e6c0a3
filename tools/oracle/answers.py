"""What pn2code says of an expression of CPN ML, in the words of the engine's top level: type, value, error.

Types are compared in a normal form: names of colour sets stand for what they are, `ms` is `list`, type variables are
numbered. Values are printed as SML/NJ prints them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.types import TCon, TFun, TRecord, TVar, Type
from pn2code.net.front import examine
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.evaluate import Evaluator, Limits
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable, real_text

SYNTAX = ("syntax-error", "lexical-error", "fixity-error", "text-too-long", "text-too-deep")


@dataclass(frozen=True)
class Said:
    """An answer.

    Args:
        kind: "value", "raised", "refused", or why there is none: "limit", "unavailable", "timeout", "crash".
        detail: the value; the exception; what was wrong.
        type: of a value, in its normal form.
    """

    kind: str
    detail: str
    type: str = ""

    def __str__(self) -> str:
        return f"{self.kind}: {self.detail}" + (f" : {self.type}" if self.type else "")


# --- types ------------------------------------------------------------------------------------------

_TOKEN = re.compile(r"\s*(->|[A-Za-z?][\w'?]*(?:\.[\w'?]+)*|'+\w+|[*(){},:]|\d+)")
_NAMES = {
    "intinf": "IntInf.int",
    "LargeInt.int": "IntInf.int", "time": "IntInf.int", "CPN'Time.time": "IntInf.int",
    "Int.int": "int", "Real.real": "real", "String.string": "string", "Word.word": "word", "CPN'timed": "timed",
    "Word31.word": "word", "Position.int": "int", "Substring.substring": "substring", "IEEEReal.real_order": "order",
    "Order.order": "order", "Word8Vector.elem": "Word8.word", "FmtFields.fmt_item": "fmt_item",
    **{f"word{n}": f"Word{n}.word" for n in (8, 32, 64)}, **{f"int{n}": f"Int{n}.int" for n in (32, 64)},
    "CharVector.vector": "string", "CharVector.elem": "char",
}  # fmt: skip
_BASIC = {
    "Int": "int",
    "Real": "real",
    "Bool": "bool",
    "String": "string",
    "Unit": "unit",
    "IntInf": "IntInf.int",
}
_INT_KEY = re.compile(r"Int\w+(?:Map\.Key\.ord_key|Set\.item)")
_BASIC["Time"] = "IntInf.int"


class _TypeReader:
    """Reads a type as SML/NJ prints it."""

    def __init__(self, text: str, colsets: dict[str, Colset]) -> None:
        self.tokens = _TOKEN.findall(text)
        self.at = 0
        self.colsets = colsets
        self.variables: dict[str, TVar] = {}

    def peek(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self, token: str) -> bool:
        found = self.peek() == token
        self.at += found
        return found

    def type(self) -> Type:
        left = self.product()
        return TFun(left, self.type()) if self.take("->") else left

    def product(self) -> Type:
        parts = [self.applied()]
        while self.take("*"):
            parts.append(self.applied())
        return parts[0] if len(parts) == 1 else _record(enumerate(parts, 1))

    def applied(self) -> Type:
        arguments = self.atom()
        while re.match(r"[A-Za-z?]", self.peek()):
            name = self.tokens[self.at]
            self.at += 1
            arguments = [self.named(name, tuple(arguments))]
        (one,) = arguments
        return one

    def atom(self) -> list[Type]:
        token = self.peek()
        if token.startswith("'"):
            self.at += 1
            return [
                self.variables.setdefault(token, TVar(len(self.variables), token.startswith("''")))
            ]
        if self.take("("):
            inner = [self.type()]
            while self.take(","):
                inner.append(self.type())
            self.take(")")
            return inner
        if self.take("{"):
            fields: list[tuple[Any, Type]] = []
            while not self.take("}"):
                label = self.tokens[self.at]
                self.at += 1
                self.take(":")
                fields.append((label, self.type()))
                self.take(",")
            return [_record(fields)]
        self.at += 1
        return [self.named(token, ())]

    def named(self, name: str, arguments: tuple[Type, ...]) -> Type:
        # Of a data type its own name is compared, not where it was declared nor whether another hides it.
        name = re.sub(r"^(\?|S\d*)\.(?!X\d)", "", name)
        name = "int" if _INT_KEY.fullmatch(name) else _NAMES.get(name, name)
        if name == "unit":
            return TRecord()
        if name == "StringCvt.reader":
            item, stream = arguments
            return TFun(stream, TCon("option", (_record(enumerate((item, stream), 1)),)))
        if name in ("ms", "list"):
            return TCon("list", arguments)
        if name == "tms":
            return TCon("list", (TCon("timed", arguments),))
        basic = re.fullmatch(r"CPN'ColorSets\.(\w+)CS\.cs", name)
        if basic:
            return self.named(_BASIC.get(basic[1], name), ())
        if name.endswith("'timed.cs") and name[:-9] in self.colsets:
            return TCon("timed", (self.colsets[name[:-9]].type,))
        colset = self.colsets.get(name.removesuffix(".cs"))
        return colset.type if colset is not None else TCon(name, arguments)


def _record(fields: Iterable[tuple[Any, Type]]) -> TRecord:
    made = [(str(label), t) for label, t in fields]
    return TRecord(
        tuple(sorted(made, key=lambda f: (not f[0].isdigit(), f[0].isdigit() and int(f[0]), f[0])))
    )


def normal(t: Type) -> str:
    """The text of a type, its variables numbered in order of appearance; what is left open counts as a variable."""
    order: dict[str, str] = {}

    def text(t: Type) -> str:
        match t:
            case TVar():
                # An unused type variable's equality is not compared: SML/NJ and Hindley-Milner differ in it harmlessly.
                return order.setdefault(str(t.index), f"'{len(order)}")
            case TFun():
                return f"({text(t.argument)} -> {text(t.result)})"
            case TRecord():
                return "{" + ",".join(f"{k}:{text(x)}" for k, x in t.fields) + "}"
            case TCon():
                if t.name.startswith("?.X"):
                    return "{}"  # what nothing decides: SML/NJ makes a new type, pn2code takes unit
                name = t.name.partition("#")[0]
                return " ".join([*map(text, t.args), name])

    return text(t)


# --- values -----------------------------------------------------------------------------------------


def string_text(text: str) -> str:
    """A string as SML/NJ prints it."""
    out = []
    for c in text:
        code = ord(c)
        if c in '"\\':
            out.append("\\" + c)
        elif c in "\a\b\t\n\v\f\r":
            out.append("\\" + "abtnvfr"["\a\b\t\n\v\f\r".index(c)])
        elif code < 32:
            out.append(f"\\^{chr(code + 64)}")
        elif code >= 127:
            out.append(f"\\{code:03}")
        else:
            out.append(c)
    return '"' + "".join(out) + '"'


class Printer:
    """Prints values as SML/NJ does."""

    def __init__(self, datatypes: dict[str, core.DatatypeDec]) -> None:
        self.datatypes = datatypes

    def text(self, t: Type, value: Any, tight: bool = False) -> str:
        """The value; `tight`: with parentheses where it is an argument."""
        match t:
            case TFun():
                return "fn"
            case TVar():
                return "-"
            case TRecord(fields):
                items = [self.text(x, v) for (_, x), v in zip(fields, value, strict=True)]
                if not fields:
                    return "()"
                if t.is_tuple:
                    return f"({','.join(items)})"
                return (
                    "{"
                    + ",".join(f"{k}={i}" for (k, _), i in zip(fields, items, strict=True))
                    + "}"
                )
            case TCon(name, args):
                return self.constructed(name, args, value, tight)

    def constructed(self, name: str, args: tuple[Type, ...], value: Any, tight: bool) -> str:
        made = ""
        match name:
            case "int" | "IntInf.int" | "Int32.int" | "Int64.int":
                return str(value).replace("-", "~")
            case "time" | "real":
                return (
                    real_text(value) if isinstance(value, float) else str(value).replace("-", "~")
                )
            case "bool":
                return "true" if value else "false"
            case "string":
                return string_text(value)
            case "char":
                return "#" + string_text(value)
            case "word" | "Word8.word" | "Word32.word" | "Word64.word":
                return f"0wx{value:X}"
            case "list":
                return f"[{','.join(self.text(args[0], v) for v in value)}]"
            case "vector":
                return f"#[{','.join(self.text(args[0], v) for v in value)}]"
            case "array":
                return f"[|{','.join(self.text(args[0], v) for v in value.items)}|]"
            case "ref":
                made = f"ref {self.text(args[0], value.contents, True)}"
            case "timed":
                stamp = (
                    real_text(value.stamp)
                    if isinstance(value.stamp, float)
                    else str(value.stamp).replace("-", "~")
                )
                made = f"{self.text(args[0], value.value, True)} @ {stamp}"
            case "exn":
                return f"{value.name}(-)"
            case _ if name in self.datatypes:
                dec = self.datatypes[name]
                argument = dec.constructors[value.tag][1]
                if argument is None:
                    return str(value.name)
                made = f"{value.name} {self.text(_applied(argument, args), value.argument, True)}"
            case _:
                return "-"
        return f"({made})" if tight else made


def _applied(t: Type, args: tuple[Type, ...]) -> Type:
    match t:
        case TVar(index):
            return args[index]
        case TCon():
            return replace(t, args=tuple(_applied(x, args) for x in t.args))
        case TFun():
            return TFun(_applied(t.argument, args), _applied(t.result, args))
        case TRecord():
            return TRecord(tuple((k, _applied(x, args)) for k, x in t.fields))


# --- both sides -------------------------------------------------------------------------------------


class Here:
    """pn2code after the declarations of a net: the elaborator and the reference evaluator."""

    def __init__(self, net: Path, steps: int = 200_000) -> None:
        self._d = Diagnostics()
        typed = examine(net, self._d, compute=compute).typed
        assert typed is not None, [e.message for e in self._d.errors]
        self.elaborator = typed.elaborator
        self.program = typed.program
        self.evaluator = Evaluator(typed.program, limits=Limits(steps=steps))

    def declare(self, text: str) -> None:
        """Declarations that stand before all expressions.

        Raises:
            ValueError: they are wrong.
        """
        before = len(self.elaborator.program().declarations)
        self.elaborator.declarations(SourceText(text, NOWHERE))
        if self._d.has_errors:
            raise ValueError(self._d.errors[0].message)
        self.program = self.elaborator.program()
        self._evaluate(before)

    def say(self, text: str) -> Said:
        """The answer to an expression; declarations may come before it, each of which ends with `;` and a line.

        As at the engine's top level a declaration is evaluated before the next one is read.
        """
        *before, expression = text.split(";\n")
        d = Diagnostics()
        with self.elaborator.aside(d) as made:
            try:
                for declared in before:
                    self._declared(f"{declared};", d)
                self._declared(f"val it'is =\n{expression}\n;", d)
            except _RefusedError:
                first = d.errors[0]
                kind = "syntax" if first.code in SYNTAX else "type"
                return Said("refused", f"{first.code}: {first.message}", kind)
            except MlException as raised:
                return Said("raised", raised.name)
            except MlUnavailable as reason:
                return Said("unavailable", str(reason))
            except MlLimit as reason:
                return Said("limit", str(reason))
            datatypes = self.elaborator.program().datatypes
        symbol = made.globals["it'is"]
        value = self.evaluator.globals[symbol.uid]
        return Said("value", Printer(datatypes).text(symbol.type, value), normal(symbol.type))

    def type_of(self, expression: str) -> Type | None:
        """The type of an expression; None if it is wrong."""
        d = Diagnostics()
        with self.elaborator.aside(d) as made:
            self.elaborator.declarations(SourceText(f"val it'is =\n{expression}\n;", NOWHERE))
        return None if d.has_errors else made.globals["it'is"].type

    def value_of(self, expression: str) -> str | None:
        """The value of an expression of type string; None if there is none."""
        d = Diagnostics()
        try:
            with self.elaborator.aside(d) as made:
                self._declared(f"val it'is =\n{expression}\n;", d)
        except (_RefusedError, MlException, MlUnavailable, MlLimit):
            return None
        value = self.evaluator.globals[made.globals["it'is"].uid]
        return value if isinstance(value, str) else None

    def _declared(self, text: str, d: Diagnostics) -> None:
        """Enters and evaluates declarations.

        Raises:
            _RefusedError: they are wrong; `d` says why.
        """
        done = len(self.elaborator.program().declarations)
        self.elaborator.declarations(SourceText(text, NOWHERE))
        if d.has_errors:
            raise _RefusedError
        self._evaluate(done)

    def _evaluate(self, done: int) -> None:
        """The declarations after so many of them."""
        for dec in self.elaborator.program().declarations[done:]:
            self.evaluator.globals.update(self.evaluator.run(self.evaluator._declare(dec, {})))


class _RefusedError(Exception):
    """What is put before pn2code is wrong."""


def engine_said(answer: dict[str, Any], colsets: dict[str, Colset]) -> Said:
    """What the engine answered, in the same words."""
    error = answer.get("error")
    if error is None:
        kind = _TypeReader(answer["type"], colsets).type() if answer["type"] else TRecord()
        value = re.sub(r"\s*\n\s*", "", answer["value"]) if answer["value"] else ""
        return Said("value", value, normal(kind))
    if error["class"] == "raised":
        return Said("raised", error["name"])
    if error["class"] in ("syntax", "type"):
        message = error["message"].replace("\n", " ")
        return Said("refused", message[max(message.find("Error:"), 0) :][:300], error["class"])
    return Said(error["class"], error["message"][:100])


def differences(pairs: Iterable[tuple[str, Said, Said]]) -> Iterator[tuple[str, Said, Said]]:
    """(expression, ours, the engine's) where they differ in kind, type, value or exception."""
    for expression, ours, theirs in pairs:
        if ours.kind == theirs.kind == "refused":
            continue
        if (ours.kind, ours.detail, ours.type) != (theirs.kind, theirs.detail, theirs.type):
            yield expression, ours, theirs
