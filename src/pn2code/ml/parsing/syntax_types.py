"""Types of CPN ML as they are written, and what expressions and patterns have in common; see `syntax`."""

from __future__ import annotations

from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span


@frozen
class VarTy:
    """`'a`; the name includes the quotes."""

    name: str
    span: Span


@frozen
class NameTy:
    """`int`, `INT`, `'a list`, `(int, string) pair`."""

    name: str
    args: tuple[Ty, ...]
    span: Span


@frozen
class RecordTy:
    """`{a: int}`, `int * string`."""

    fields: tuple[tuple[str, Ty], ...]
    span: Span


@frozen
class FunTy:
    """`a -> b`."""

    argument: Ty
    result: Ty
    span: Span


Ty = VarTy | NameTy | RecordTy | FunTy


class LitKind(Enum):
    """Kinds of literals."""

    INT = "int"
    WORD = "word"
    REAL = "real"
    STRING = "string"
    CHAR = "char"


@frozen
class Keyword:
    """`andalso`, `orelse` or `as` inside a flat sequence."""

    word: str
    span: Span


@frozen
class Constraint:
    """`: ty` inside a flat sequence."""

    type: Ty
    span: Span
