"""Syntax tree of CPN ML, as parsed; every node has the `Span` of its text. All nodes by one name,
`from pn2code.ml.parsing import syntax as s`.

The parser leaves infix operators in flat sequences (`FlatExp`, `FlatPat`, `FlatClause`), because users may
declare new ones; the fixity pass (`fixity`) turns these into applications. After that pass no `Flat...` node
is left. Example: `1`x ++ y` is parsed as
`FlatExp(IntExp 1, NameExp "`", NameExp x, NameExp ++, NameExp y)` and resolved to
`InfixExp(++, InfixExp(`, 1, x), y)`.

Tuples are records with the labels 1, 2, ...; `()` is the record without fields.
"""

from __future__ import annotations

from pn2code.ml.parsing.syntax_declarations import (
    AbstypeDec,
    Clause,
    CodeSegment,
    ConBinding,
    DatatypeBinding,
    DatatypeCopyDec,
    DatatypeDec,
    ExceptionBinding,
    ExceptionDec,
    ExpDec,
    FlatClause,
    FlatFunBinding,
    FunBinding,
    FunDec,
    InfixDec,
    LocalDec,
    OpenDec,
    TypeBinding,
    TypeDec,
    ValBinding,
    ValDec,
)
from pn2code.ml.parsing.syntax_expressions import (
    ApplyExp,
    CaseExp,
    Exp,
    FlatExp,
    FnExp,
    HandleExp,
    Handler,
    IfExp,
    InfixExp,
    LetExp,
    ListExp,
    LitExp,
    LogicExp,
    NameExp,
    RaiseExp,
    RecordExp,
    Rule,
    SelectorExp,
    SequenceExp,
    TypedExp,
    VectorExp,
    WhileExp,
)
from pn2code.ml.parsing.syntax_modules import (
    ApplyStr,
    Dec,
    ExceptionSpec,
    FunctorBinding,
    FunctorDec,
    IncludeSpec,
    LetStr,
    NameSig,
    NameStr,
    SealedStr,
    SharingSpec,
    Sig,
    SignatureDec,
    SigSig,
    Spec,
    Str,
    StructStr,
    StructureBinding,
    StructureDec,
    StructureSpec,
    TypeSpec,
    ValSpec,
    WhereSig,
)
from pn2code.ml.parsing.syntax_patterns import (
    AsPat,
    ConPat,
    FlatPat,
    ListPat,
    LitPat,
    NamePat,
    OrPat,
    Pat,
    RecordPat,
    TypedPat,
    VectorPat,
    WildPat,
)
from pn2code.ml.parsing.syntax_types import (
    Constraint,
    FunTy,
    Keyword,
    LitKind,
    NameTy,
    RecordTy,
    Ty,
    VarTy,
)

__all__ = [
    "AbstypeDec", "ApplyExp", "ApplyStr", "AsPat", "CaseExp", "Clause", "CodeSegment", "ConBinding", "ConPat",
    "Constraint", "DatatypeBinding", "DatatypeCopyDec", "DatatypeDec", "Dec", "ExceptionBinding", "ExceptionDec",
    "ExceptionSpec", "Exp", "ExpDec", "FlatClause", "FlatExp", "FlatFunBinding", "FlatPat", "FnExp", "FunBinding",
    "FunDec", "FunTy", "FunctorBinding", "FunctorDec", "HandleExp", "Handler", "IfExp", "IncludeSpec", "InfixDec",
    "InfixExp", "Keyword", "LetExp", "LetStr", "ListExp", "ListPat", "LitExp", "LitKind", "LitPat", "LocalDec",
    "LogicExp", "NameExp", "NamePat", "NameSig", "NameStr", "NameTy", "OpenDec", "OrPat", "Pat", "RaiseExp",
    "RecordExp", "RecordPat", "RecordTy", "Rule", "SealedStr", "SelectorExp", "SequenceExp", "SharingSpec", "Sig",
    "SigSig", "SignatureDec", "Spec", "Str", "StructStr", "StructureBinding", "StructureDec", "StructureSpec",
    "Ty", "TypeBinding", "TypeDec", "TypeSpec", "TypedExp", "TypedPat", "ValBinding", "ValDec", "ValSpec",
    "VarTy", "VectorExp", "VectorPat", "WhereSig", "WhileExp", "WildPat", "is_node",
]  # fmt: skip

_HOMES = frozenset(kind.__module__ for kind in (VarTy, WildPat, LitExp, ValDec, StructStr))
"""Modules whose classes are nodes."""


def is_node(item: object) -> bool:
    """Whether something is a node of the syntax tree (or a `LitKind`), and no name, span, number or tuple."""
    return type(item).__module__ in _HOMES
