"""Structures, signatures and functors of CPN ML as they are parsed; see `syntax`. `Dec` is any declaration at all."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.parsing.syntax_declarations import (
    AbstypeDec,
    DatatypeCopyDec,
    DatatypeDec,
    ExceptionDec,
    ExpDec,
    FunDec,
    InfixDec,
    LocalDec,
    OpenDec,
    TypeBinding,
    TypeDec,
    ValDec,
)
from pn2code.ml.parsing.syntax_types import Ty


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


Dec = (
    ValDec | FunDec | TypeDec | DatatypeDec | DatatypeCopyDec | ExceptionDec | LocalDec | OpenDec | InfixDec
    | AbstypeDec | StructureDec | SignatureDec | FunctorDec | ExpDec
)  # fmt: skip
