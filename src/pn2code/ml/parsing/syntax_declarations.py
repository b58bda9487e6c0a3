"""Declarations of CPN ML as they are parsed, and code segments; see `syntax`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.parsing.syntax_expressions import Exp
from pn2code.ml.parsing.syntax_patterns import Pat
from pn2code.ml.parsing.syntax_types import Ty

if TYPE_CHECKING:
    from pn2code.ml.parsing.syntax_modules import Dec


@frozen
class ValBinding:
    """`p = e` of a `val`."""

    pattern: Pat
    value: Exp
    recursive: bool
    span: Span


@frozen
class ValDec:
    """`val p = e and ...`; `tyvars` as written after `val`."""

    bindings: tuple[ValBinding, ...]
    span: Span
    tyvars: tuple[str, ...] = ()


@frozen
class FlatClause:
    """`f p1 .. pn : ty = e` with the left side as a flat pattern; gone after the fixity pass."""

    left: Pat
    body: Exp
    span: Span


@frozen
class Clause:
    """One clause of a function."""

    patterns: tuple[Pat, ...]
    result: Ty | None
    body: Exp
    span: Span


@frozen
class FunBinding:
    """All clauses of one function."""

    name: str
    clauses: tuple[Clause, ...]
    name_span: Span
    span: Span


@frozen
class FlatFunBinding:
    """As `FunBinding`, before the fixity pass."""

    clauses: tuple[FlatClause, ...]
    span: Span


@frozen
class FunDec:
    """`fun ... and ...`; `tyvars` as written after `fun`."""

    bindings: tuple[FunBinding | FlatFunBinding, ...]
    span: Span
    tyvars: tuple[str, ...] = ()


@frozen
class TypeBinding:
    """`('a, 'b) name = ty`."""

    parameters: tuple[str, ...]
    name: str
    type: Ty
    span: Span


@frozen
class TypeDec:
    """`type ... and ...`."""

    bindings: tuple[TypeBinding, ...]
    span: Span


@frozen
class ConBinding:
    """`Name of ty`."""

    name: str
    argument: Ty | None
    span: Span


@frozen
class DatatypeBinding:
    """`'a name = A | B of ty`."""

    parameters: tuple[str, ...]
    name: str
    constructors: tuple[ConBinding, ...]
    span: Span


@frozen
class DatatypeDec:
    """`datatype ... and ... withtype ...`."""

    bindings: tuple[DatatypeBinding, ...]
    withtypes: tuple[TypeBinding, ...]
    span: Span


@frozen
class DatatypeCopyDec:
    """`datatype t = datatype u`."""

    name: str
    original: str
    span: Span


@frozen
class ExceptionBinding:
    """`E`, `E of ty` or `E = F`."""

    name: str
    argument: Ty | None
    original: str | None
    span: Span


@frozen
class ExceptionDec:
    """`exception ... and ...`."""

    bindings: tuple[ExceptionBinding, ...]
    span: Span


@frozen
class LocalDec:
    """`local decs in decs end`."""

    hidden: tuple[Dec, ...]
    visible: tuple[Dec, ...]
    span: Span


@frozen
class OpenDec:
    """`open S T`."""

    names: tuple[str, ...]
    span: Span


@frozen
class InfixDec:
    """`infix 5 ++ --`, `infixr`, `nonfix` (kind "left", "right", "nonfix")."""

    kind: str
    precedence: int
    names: tuple[str, ...]
    span: Span


@frozen
class AbstypeDec:
    """`abstype ... with decs end`: outside, the types have neither constructors nor equality."""

    datatypes: DatatypeDec
    declarations: tuple[Dec, ...]
    span: Span


@frozen
class ExpDec:
    """An expression at top level: `val it = e`."""

    exp: Exp
    span: Span


@frozen
class CodeSegment:
    """`input pat; output pat; action exp;`."""

    inputs: Pat | None
    outputs: Pat | None
    action: Exp | None
    span: Span
