"""Expressions of CPN ML as they are parsed; see `syntax`. `Exp` is any of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.parsing.syntax_patterns import Pat
from pn2code.ml.parsing.syntax_types import Constraint, Keyword, LitKind, Ty

if TYPE_CHECKING:
    from pn2code.ml.parsing.syntax_modules import Dec


@frozen
class LitExp:
    """A literal."""

    kind: LitKind
    value: int | float | str
    span: Span


@frozen
class NameExp:
    """An identifier, perhaps qualified (`List.map`); `op` if written with it."""

    name: str
    op: bool
    span: Span


@frozen
class RecordExp:
    """`{a = e, ...}`, `(e1, e2)`, `()`."""

    fields: tuple[tuple[str, Exp], ...]
    span: Span


@frozen
class SelectorExp:
    """`#label`."""

    label: str
    span: Span


@frozen
class ListExp:
    """`[e1, ..., en]`."""

    items: tuple[Exp, ...]
    span: Span


@frozen
class VectorExp:
    """`#[e1, ..., en]`."""

    items: tuple[Exp, ...]
    span: Span


@frozen
class SequenceExp:
    """`(e1; ...; en)`, n >= 2."""

    items: tuple[Exp, ...]
    span: Span


@frozen
class LetExp:
    """`let decs in e end`."""

    declarations: tuple[Dec, ...]
    body: Exp
    span: Span


@frozen
class ApplyExp:
    """`f x`."""

    function: Exp
    argument: Exp
    span: Span


@frozen
class InfixExp:
    """`a op b`."""

    operator: NameExp
    left: Exp
    right: Exp
    span: Span


@frozen
class LogicExp:
    """`a andalso b` (conjunction) or `a orelse b`."""

    conjunction: bool
    left: Exp
    right: Exp
    span: Span


@frozen
class TypedExp:
    """`e : ty`."""

    exp: Exp
    type: Ty
    span: Span


@frozen
class HandleExp:
    """`e handle rules`."""

    exp: Exp
    rules: tuple[Rule, ...]
    span: Span


@frozen
class RaiseExp:
    """`raise e`."""

    exp: Exp
    span: Span


@frozen
class IfExp:
    """`if c then a else b`."""

    condition: Exp
    then: Exp
    otherwise: Exp
    span: Span


@frozen
class WhileExp:
    """`while c do e`."""

    condition: Exp
    body: Exp
    span: Span


@frozen
class CaseExp:
    """`case e of rules`."""

    exp: Exp
    rules: tuple[Rule, ...]
    span: Span


@frozen
class FnExp:
    """`fn rules`."""

    rules: tuple[Rule, ...]
    span: Span


@frozen
class Rule:
    """`pat => exp`."""

    pattern: Pat
    body: Exp
    span: Span


@frozen
class Handler:
    """`handle rules` inside a flat sequence."""

    rules: tuple[Rule, ...]
    span: Span


@frozen
class FlatExp:
    """Operands, operators and suffixes in the order written; gone after the fixity pass."""

    items: tuple[Exp | Keyword | Constraint | Handler, ...]
    span: Span


Exp = (
    LitExp | NameExp | RecordExp | SelectorExp | ListExp | SequenceExp | LetExp | ApplyExp | InfixExp | LogicExp
    | TypedExp | HandleExp | RaiseExp | IfExp | WhileExp | CaseExp | FnExp | FlatExp | VectorExp
)  # fmt: skip
