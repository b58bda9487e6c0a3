"""Patterns of CPN ML as they are parsed; see `syntax`. `Pat` is any of them."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.parsing.syntax_types import Constraint, Keyword, LitKind, Ty


@frozen
class WildPat:
    """`_`."""

    span: Span


@frozen
class LitPat:
    """A literal."""

    kind: LitKind
    value: int | float | str
    span: Span


@frozen
class NamePat:
    """A variable or a constant constructor."""

    name: str
    op: bool
    span: Span


@frozen
class RecordPat:
    """`{a = p, b, ...}`, `(p, q)`, `()`; `open` if written with dots."""

    fields: tuple[tuple[str, Pat], ...]
    open: bool
    span: Span


@frozen
class ListPat:
    """`[p1, ..., pn]`."""

    items: tuple[Pat, ...]
    span: Span


@frozen
class VectorPat:
    """`#[p1, ..., pn]`."""

    items: tuple[Pat, ...]
    span: Span


@frozen
class ConPat:
    """A constructor applied to a pattern (`SOME p`, `p :: q`)."""

    constructor: NamePat
    argument: Pat
    span: Span


@frozen
class TypedPat:
    """`p : ty`."""

    pattern: Pat
    type: Ty
    span: Span


@frozen
class AsPat:
    """`x as p`."""

    name: NamePat
    type: Ty | None
    pattern: Pat
    span: Span


@frozen
class OrPat:
    """`(p1 | ... | pn)`, a form of SML/NJ."""

    alternatives: tuple[Pat, ...]
    span: Span


@frozen
class FlatPat:
    """As `FlatExp`."""

    items: tuple[Pat | Keyword | Constraint, ...]
    span: Span


Pat = (
    WildPat | LitPat | NamePat | RecordPat | ListPat | VectorPat | ConPat | TypedPat | AsPat | OrPat | FlatPat
)  # fmt: skip
