"""Built-in functions written in CPN ML: what is no operation of the C runtime is compiled like a function of the net.

Each structure of the library has a file here, `String.sml` for `String.*`; `String.map` is its function
`String_map` (operators by the words in `WORDS`: `Word.+` is `Word_plus`). A file is elaborated when the first of
its functions is asked for, and of that only what is used gets compiled. A function of a file whose name begins with
`prim_` stands for the operation `prim.<rest>` of `ir.operations`; its body is never looked at.

The code refers to other built-in functions by their usual names, so that each file stands for itself. Types that CPN ML
only knows by name are tuples, lists and numbers here: see `representation`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import fields as fields_of
from functools import cache
from pathlib import Path
from typing import Any

from pn2code.diagnostics import Diagnostics, Origin, SourceText, Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import (
    BOOL,
    INT,
    INTINF,
    STRING,
    TCon,
    TFun,
    TRecord,
    TVar,
    Type,
    tuple_of,
)
from pn2code.ml.elaborate import Elaborator
from pn2code.ml.library import builtin_table_sized as sized
from pn2code.ml.library.datatypes import LITERAL_TYPES, WORD_TYPES

FOLDER = Path(__file__).resolve().parent

WORDS = {
    "+": "plus", "-": "minus", "*": "times", "~": "neg", "<": "lt", "<=": "le", ">": "gt", ">=": "ge", "<<": "left",
    ">>": "right", "~>>": "arithmetic_right", "*+": "times_plus", "*-": "times_minus", "?=": "unordered_equal",
}  # fmt: skip
"""Operators in names of functions."""

_SIZES = {
    **{name: ("Word", bits) for name, bits in sized.WORDS.items() if name != "Word"},
    **{name: ("Int32", bits) for name, bits in sized.INTEGERS.items() if name != "Int32"},
}
"""Structures that are made from another one's file, with another number of bits."""

PRIMITIVE = "prim_"
_FIRST_UID = 1 << 40
_UIDS_OF_A_FILE = 1 << 20
LAST_UID = 1 << 41
"""More than the uid of every symbol of the prelude."""

_WORD = INTINF
_SUBSTRING = tuple_of(STRING, INT, INT)

_REPRESENTATIONS: Mapping[str, Type] = {
    "word": _WORD,
    **{t.name: INTINF for t in (*WORD_TYPES, *LITERAL_TYPES) if "." in t.name},
    "substring": _SUBSTRING,
    "Time.time": INTINF,
    "Timer.real_timer": INTINF,
    "Timer.cpu_timer": INTINF,
    "TextIO.instream": tuple_of(STRING, STRING, TCon("ref", (INT,)), TCon("ref", (BOOL,))),
    "TextIO.outstream": tuple_of(STRING, INT, TCon("ref", (BOOL,))),
    "OS.FileSys.dirstream": tuple_of(
        TCon("list", (STRING,)), TCon("ref", (INT,)), TCon("ref", (BOOL,))
    ),
    "OS.Process.status": INT,
    "OS.syserror": STRING,
    "Random.rand": INT,
}
"""Types without constructors -> what they are made of."""


def representation(t: Type) -> Type:
    """A type with library types replaced by what they are made of: substrings are (text, start, length)."""
    match t:
        case TCon(name="Word8Vector.vector"):
            return TCon("list", (_WORD,))
        case TCon(name="vector", args=(element,)):
            return TCon("list", (representation(element),))
        case TCon(name="array", args=(element,)):
            return TCon("ref", (TCon("list", (representation(element),)),))
        case TCon(name=name, args=()):
            return _REPRESENTATIONS.get(name, t)
        case TCon(name=name, args=args):
            return TCon(name, tuple(map(representation, args)))
        case TFun(argument=a, result=r):
            return TFun(representation(a), representation(r))
        case TRecord(fields=fields):
            return TRecord(tuple((label, representation(f)) for label, f in fields))
        case TVar():
            return t


def function_name(builtin: str) -> tuple[str, str]:
    """The file (without `.sml`) and the name in it of a built-in function."""
    structure, _, name = builtin.rpartition(".")
    return structure, f"{structure.replace('.', '_')}_{WORDS.get(name, name)}"


def exists(builtin: str, real_time: bool = False) -> bool:
    """Whether a built-in function is written in CPN ML."""
    structure, name = function_name(builtin)
    file = _load(structure, real_time)
    return file is not None and name in file.symbols


class File:
    """An elaborated file.

    Args:
        declarations: with symbols that no net has.

    Attributes:
        symbols: by name, the last of each.
        primitives: uid -> the operation that a function stands for.
    """

    def __init__(self, declarations: tuple[core.Dec, ...]) -> None:
        self.declarations = declarations
        self.symbols: dict[str, Symbol] = {}
        self.values: dict[str, core.Exp] = {}
        self.primitives: dict[int, core.Builtin] = {}
        for dec in declarations:
            match dec:
                case core.RecBind(bindings=bindings, span=span):
                    for symbol, _ in bindings:
                        self._enter(symbol, span)
                case core.ValBind(pattern=core.PVar(symbol=symbol), value=value):
                    self.symbols[symbol.name] = symbol
                    self.values[symbol.name] = value

    def _enter(self, symbol: Symbol, span: Span) -> None:
        self.symbols[symbol.name] = symbol
        if symbol.name.startswith(PRIMITIVE):
            name = "prim." + symbol.name.removeprefix(PRIMITIVE)
            self.primitives[symbol.uid] = core.Builtin(name, symbol.type, span)


def find(builtin: str, real_time: bool) -> tuple[File, Symbol] | None:
    """The function that a built-in function is, and its file."""
    structure, name = function_name(builtin)
    file = _load(structure, real_time)
    if file is None or name not in file.symbols:
        return None
    return file, file.symbols[name]


@cache
def _load(structure: str, real_time: bool) -> File | None:
    path = FOLDER / f"{structure}.real.sml"
    if not (real_time and path.is_file()):
        path = FOLDER / f"{_SIZES.get(structure, (structure, 0))[0]}.sml"
    if not structure or not path.is_file():
        return None
    text = path.read_text("ascii")
    if structure in _SIZES:
        model, bits = _SIZES[structure]
        text = re.sub(r"^val bits = \d+$", f"val bits = {bits}", text, flags=re.MULTILINE)
        text = text.replace(f"{model}_", f"{structure}_")
    d = Diagnostics()
    elaborator = Elaborator(d, real_time=real_time)
    elaborator.declarations(SourceText(text, Origin(f"prelude/{path.name}", 1, 1)))
    if d.has_errors:
        raise AssertionError(
            f"{path.name}: "
            + "; ".join(f"{e.origin.line}: {e.message}, {e.hint}" for e in d.errors[:5])
        )
    files = sorted({p.name for p in FOLDER.glob("*.sml")} | {f"{name}.sml" for name in _SIZES})
    number = files.index(f"{structure}.sml" if structure in _SIZES else path.name)
    offset = _FIRST_UID + number * _UIDS_OF_A_FILE
    declarations = elaborator.program().declarations
    return File(tuple(_renumbered(dec, offset, {}) for dec in declarations))


def _renumbered(node: Any, offset: int, known: dict[int, Symbol]) -> Any:
    """A copy with other symbols, so that a net and several files can be in one program."""
    if isinstance(node, tuple):
        return tuple(_renumbered(x, offset, known) for x in node)
    if isinstance(node, Symbol):
        if node.uid not in known:
            known[node.uid] = Symbol(
                node.uid + offset, node.name, node.type, node.generics, node.colset, node.is_global,
                node.first_generic,
            )  # fmt: skip
        return known[node.uid]
    if type(node).__module__ != core.__name__ or isinstance(node, core.Constructor):
        return node
    return type(node)(*(_renumbered(getattr(node, f.name), offset, known) for f in fields_of(node)))


def instance(symbol: Symbol, t: Type) -> dict[int, Type]:
    """The types of a function's type variables where it has a type (that of a built-in function, perhaps by name)."""
    found: dict[int, Type] = {}
    for general, special in _pairs(representation(symbol.type), representation(t)):
        found.setdefault(general, special)
    return found


def _pairs(general: Type, special: Type) -> Iterator[tuple[int, Type]]:
    match general, special:
        case TVar(index=i), _:
            yield i, special
        case TCon(args=a), TCon(args=b):
            for x, y in zip(a, b, strict=True):
                yield from _pairs(x, y)
        case TFun(argument=a1, result=r1), TFun(argument=a2, result=r2):
            yield from _pairs(a1, a2)
            yield from _pairs(r1, r2)
        case TRecord(fields=f1), TRecord(fields=f2):
            for (_, x), (_, y) in zip(f1, f2, strict=True):
                yield from _pairs(x, y)
