"""Any value of CPN ML as text, by its type: what the page answers to an expression.

value_text(list_of(INT), (1, 2), program)            # [1,2]

Values are written as in markings: `~2`, `"a"`, `{b=1,a=red}`; texts with the escapes of literals, `"a\\n"`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pn2code.ml.core.terms import DatatypeDec
from pn2code.ml.core.types import TCon, TFun, TRecord, TVar, Type
from pn2code.semantics.library.builtins_text import escaped
from pn2code.semantics.values.data import Array, Data, Ref, Timed, int_text, real_text

_INTS = ("int", "IntInf.int")
_TEXTS = {"string": '"{}"', "char": '#"{}"'}
"""Texts, with escapes: the page shows what is a line break, a quote or a backslash in them."""
MOST = 20_000
"""Parts of a value that are written."""


class _Writer:
    """Writes a value; after too many parts it writes dots."""

    def __init__(self, datatypes: Mapping[str, DatatypeDec]) -> None:
        self._datatypes = datatypes
        self._parts = 0

    def text(self, t: Type, value: Any) -> str:
        self._parts += 1
        if self._parts > MOST:
            return "…"
        match t:
            case TFun() | TVar():
                return "fn"
            case TRecord(fields):
                return self._record(t, fields, value)
            case TCon(name, arguments):
                return self._of(name, arguments, value)

    def _record(self, t: TRecord, fields: tuple[tuple[str, Type], ...], value: Any) -> str:
        texts = [self.text(own, x) for (_, own), x in zip(fields, value, strict=True)]
        if not texts:
            return "()"
        if t.is_tuple:
            return f"({','.join(texts)})"
        named = (f"{label}={text}" for (label, _), text in zip(fields, texts, strict=True))
        return "{" + ",".join(named) + "}"

    def _of(self, name: str, arguments: tuple[Type, ...], value: Any) -> str:
        match value:
            case bool():
                return "true" if value else "false"
            case int():
                return int_text(value) if name in _INTS else str(value)
            case float():
                return real_text(value)
            case str():
                return (
                    _TEXTS[name].format("".join(map(_escaped, value))) if name in _TEXTS else value
                )
            case Timed(value=inner, stamp=stamp):
                time = real_text(stamp) if isinstance(stamp, float) else int_text(stamp)
                return f"{self.text(arguments[0], inner)}@{time}" if arguments else "…"
            case Ref(contents=inner):
                return f"ref {self._inside(arguments, inner)}"
            case Array(items=items):
                return f"[|{','.join(self._inside(arguments, x) for x in items)}|]"
            case tuple() if arguments:
                opening = "#[" if name == "vector" else "["
                return f"{opening}{','.join(self.text(arguments[0], x) for x in value)}]"
            case Data():
                return self._data(name, arguments, value)
            case _:
                return name

    def _inside(self, arguments: tuple[Type, ...], value: Any) -> str:
        return self.text(arguments[0], value) if arguments else "…"

    def _data(self, name: str, arguments: tuple[Type, ...], value: Data) -> str:
        if value.argument is None:
            return value.name
        declared = self._datatypes.get(name)
        own = dict(declared.constructors) if declared is not None else {}
        found = next((t for c, t in own.items() if c.name == value.name), None)
        if found is None:
            return f"{value.name} …"
        inner = self.text(_with(found, arguments), value.argument)
        return (
            f"{value.name} {inner}"
            if inner.startswith(("(", "{", "["))
            else f"{value.name}({inner})"
        )


def _escaped(c: str) -> str:
    """A character as in a literal, but letters beyond ASCII as they are."""
    return c if c.isprintable() and ord(c) > 127 else escaped(c)


def _with(t: Type, arguments: tuple[Type, ...]) -> Type:
    """A generic type with these arguments."""
    match t:
        case TVar(index=index):
            return arguments[index] if index < len(arguments) else t
        case TCon(name, own):
            return TCon(name, tuple(_with(x, arguments) for x in own))
        case TRecord(fields):
            return TRecord(tuple((label, _with(x, arguments)) for label, x in fields))
        case _:
            return t


def value_text(t: Type, value: Any, datatypes: Mapping[str, DatatypeDec]) -> str:
    """The value of an expression of this type."""
    return _Writer(datatypes).text(t, value)
