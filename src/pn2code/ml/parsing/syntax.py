"""Syntax tree of CPN ML, as parsed; every node has the `Span` of its text.

The parser leaves infix operators in flat sequences (`FlatExp`, `FlatPat`, `FlatClause`), because users may
declare new ones; the fixity pass (`fixity`) turns these into applications. After that pass no `Flat...` node
is left. Example: `1`x ++ y` is parsed as
`FlatExp(IntExp 1, NameExp "`", NameExp x, NameExp ++, NameExp y)` and resolved to
`InfixExp(++, InfixExp(`, 1, x), y)`.

Tuples are records with the labels 1, 2, ...; `()` is the record without fields.
"""

from __future__ import annotations

from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span

# --- types -------------------------------------------------------------------------------------


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

# --- expressions -------------------------------------------------------------------------------


class LitKind(Enum):
    """Kinds of literals."""

    INT = "int"
    WORD = "word"
    REAL = "real"
    STRING = "string"
    CHAR = "char"


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
class Keyword:
    """`andalso`, `orelse` or `as` inside a flat sequence."""

    word: str
    span: Span


@frozen
class Constraint:
    """`: ty` inside a flat sequence."""

    type: Ty
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

# --- patterns ----------------------------------------------------------------------------------


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
    WildPat | LitPat | NamePat | RecordPat | ListPat | ConPat | TypedPat | AsPat | OrPat | FlatPat
)  # fmt: skip

# --- declarations ------------------------------------------------------------------------------


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


# --- modules -----------------------------------------------------------------------------------


@frozen
class StructStr:
    """`struct decs end`."""

    declarations: tuple[Dec, ...]
    span: Span


@frozen
class NameStr:
    """`S`, `A.B`."""

    name: str
    span: Span


@frozen
class ApplyStr:
    """`F (argument)`; declarations `F (val x = ..)` are the argument `struct .. end`."""

    functor: str
    argument: Str
    span: Span


@frozen
class LetStr:
    """`let decs in S end`."""

    declarations: tuple[Dec, ...]
    body: Str
    span: Span


@frozen
class SealedStr:
    """`S : SIG` or, `opaque`, `S :> SIG`."""

    structure: Str
    signature: Sig
    opaque: bool
    span: Span


Str = StructStr | NameStr | ApplyStr | LetStr | SealedStr


@frozen
class SigSig:
    """`sig specs end`."""

    specs: tuple[Spec, ...]
    span: Span


@frozen
class NameSig:
    """A signature by its name."""

    name: str
    span: Span


@frozen
class WhereSig:
    """`SIG where type t = ty`; the name of a binding may be a path."""

    signature: Sig
    types: tuple[TypeBinding, ...]
    span: Span


Sig = SigSig | NameSig | WhereSig


@frozen
class ValSpec:
    """`val x : ty`."""

    name: str
    type: Ty
    span: Span


@frozen
class TypeSpec:
    """`type 'a t`, `eqtype t`, `type t = ty`."""

    parameters: tuple[str, ...]
    name: str
    type: Ty | None
    equality: bool
    span: Span


@frozen
class ExceptionSpec:
    """`exception E of ty`."""

    name: str
    argument: Ty | None
    span: Span


@frozen
class StructureSpec:
    """`structure S : SIG`."""

    name: str
    signature: Sig
    span: Span


@frozen
class IncludeSpec:
    """`include SIG`."""

    signatures: tuple[Sig, ...]
    span: Span


@frozen
class SharingSpec:
    """`sharing type t = u`: checked by use only."""

    names: tuple[str, ...]
    span: Span


Spec = (
    ValSpec | TypeSpec | DatatypeDec | DatatypeCopyDec | ExceptionSpec | StructureSpec | IncludeSpec | SharingSpec
)  # fmt: skip


@frozen
class StructureDec:
    """`structure S = body and ...`."""

    bindings: tuple[StructureBinding, ...]
    span: Span


@frozen
class StructureBinding:
    """`S = body`."""

    name: str
    body: Str
    span: Span


@frozen
class SignatureDec:
    """`signature S = sig .. end and ...`."""

    bindings: tuple[tuple[str, Sig], ...]
    span: Span


@frozen
class FunctorBinding:
    """`F (X : SIG) = body`; `parameter` is "" in `F (specs) = body`, where the names of the argument are open."""

    name: str
    parameter: str
    signature: Sig
    body: Str
    span: Span


@frozen
class FunctorDec:
    """`functor F (X : SIG) = body and ...`."""

    bindings: tuple[FunctorBinding, ...]
    span: Span


@frozen
class ExpDec:
    """An expression at top level: `val it = e`."""

    exp: Exp
    span: Span


Dec = (
    ValDec | FunDec | TypeDec | DatatypeDec | DatatypeCopyDec | ExceptionDec | LocalDec | OpenDec | InfixDec
    | AbstypeDec | StructureDec | SignatureDec | FunctorDec | ExpDec
)  # fmt: skip


@frozen
class CodeSegment:
    """`input pat; output pat; action exp;`."""

    inputs: Pat | None
    outputs: Pat | None
    action: Exp | None
    span: Span
