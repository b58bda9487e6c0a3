# ruff: noqa: D102  (each method is named after a rule of the grammar, which says what it is)
"""Builds the syntax tree from the parser's reductions (one method a grammar rule)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.diagnostics import NOWHERE, SourceText, Span
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.lexer import Lexeme


@frozen
class Group:
    """Several nodes and the text they cover."""

    items: tuple[Any, ...]
    span: Span


@frozen
class Dots:
    """`...` in a record pattern."""

    span: Span


_LITERALS = {
    "INT": s.LitKind.INT,
    "WORD": s.LitKind.WORD,
    "REAL": s.LitKind.REAL,
    "STRING": s.LitKind.STRING,
    "CHAR": s.LitKind.CHAR,
}

Children = list[Any]


class NotANameError(Exception):
    """A word stands where something gets a name, or where a label is, that is neither.

    Args:
        span: of the word.
        message: what is wrong.
    """

    def __init__(self, span: Span, message: str) -> None:
        super().__init__(message)
        self.span = span
        self.message = message


class TreeBuilder:
    """Used by the parser; `source` is set before each parse."""

    source: SourceText = SourceText("", NOWHERE)

    # --- helpers

    def _of(self, child: Any) -> Span:
        if isinstance(child, Lexeme):
            return Span(self.source, child.start, child.end)
        span: Span = child.span
        return span

    def _span(self, children: Children) -> Span:
        if not children:
            return Span(self.source, 0, 0)
        return self._of(children[0]).to(self._of(children[-1]))

    @staticmethod
    def _nodes(children: Iterable[Any]) -> tuple[Any, ...]:
        return tuple(c for c in children if not isinstance(c, Lexeme))

    @staticmethod
    def _texts(children: Iterable[Any], *kinds: str) -> tuple[str, ...]:
        return tuple(c.text for c in children if isinstance(c, Lexeme) and c.kind in kinds)

    def _name(self, token: Lexeme) -> str:
        """A name that is declared: one without points.

        Raises:
            NotANameError: it has points.
        """
        return _short(token.text, self._of(token))

    def _names(self, children: Children) -> tuple[str, ...]:
        """The names among the parts, which are declared there."""
        return tuple(self._name(c) for c in children if isinstance(c, Lexeme) and c.kind == "ID")

    def _group(self, children: Children) -> Group:
        return Group(self._nodes(children), self._span(children))

    unit = decs = match = specs = _group

    def program(self, children: Children) -> Group:
        decs = [dec for unit in self._nodes(children) for dec in unit.items]
        return Group(tuple(decs), self._span(children))

    # --- starts

    def expression(self, children: Children) -> s.Exp:
        exp: s.Exp = children[0]
        return exp

    def layered(self, children: Children) -> tuple[s.Exp, s.Pat]:
        """`x as pat`, an inscription of its own kind."""
        return children[0], children[2]

    def expressions(self, children: Children) -> Group:
        return self._group(children)

    def code(self, children: Children) -> s.CodeSegment:
        parts: dict[str, Any] = dict(children)
        return s.CodeSegment(
            parts.get("input"), parts.get("output"), parts.get("action"), self.source.span()
        )

    def code_input(self, children: Children) -> tuple[str, Any]:
        return "input", children[1]

    def code_output(self, children: Children) -> tuple[str, Any]:
        return "output", children[1]

    def code_action(self, children: Children) -> tuple[str, Any]:
        nodes = self._nodes(children)
        if len(nodes) < 2:
            return "action", nodes[0] if nodes else None
        return "action", s.SequenceExp(nodes, nodes[0].span.to(nodes[-1].span))

    # --- expressions

    def exp(self, children: Children) -> s.Exp:
        if len(children) == 1 and not isinstance(
            children[0], s.Keyword | s.Constraint | s.Handler | s.NameExp
        ):
            exp: s.Exp = children[0]
            return exp
        return s.FlatExp(tuple(children), self._span(children))

    def name_exp(self, children: Children) -> s.NameExp:
        return s.NameExp(children[-1].text, len(children) > 1, self._span(children))

    def literal(self, children: Children) -> s.LitExp:
        token: Lexeme = children[0]
        assert token.value is not None
        return s.LitExp(_LITERALS[token.kind], token.value, self._of(token))

    def unit_exp(self, children: Children) -> s.RecordExp:
        return s.RecordExp((), self._span(children))

    def paren(self, children: Children) -> Any:
        return children[1]

    def paren_exp(self, children: Children) -> s.FlatExp:
        """Kept as a sequence of one, which tells `(fn ..) x` from `fn .. x`; the fixity pass unpacks it."""
        return s.FlatExp((children[1],), self._span(children))

    def tuple_exp(self, children: Children) -> s.RecordExp:
        return s.RecordExp(_number(self._nodes(children)), self._span(children))

    def sequence_exp(self, children: Children) -> s.SequenceExp:
        return s.SequenceExp(self._nodes(children), self._span(children))

    def list_exp(self, children: Children) -> s.ListExp:
        return s.ListExp(self._nodes(children), self._span(children))

    def vector_exp(self, children: Children) -> s.VectorExp:
        return s.VectorExp(self._nodes(children), self._span(children))

    def record_exp(self, children: Children) -> s.RecordExp:
        fields = tuple((g.items[0], g.items[1]) for g in self._nodes(children))
        return s.RecordExp(fields, self._span(children))

    def field(self, children: Children) -> Group:
        return Group((children[0].items[0], children[2]), self._span(children))

    def label(self, children: Children) -> Group:
        token: Lexeme = children[0]
        if token.kind == "INT" and not re.fullmatch("[1-9][0-9]*", token.text):
            raise NotANameError(
                self._of(token), f"`{token.text}` is not a label: they count from 1"
            )
        return Group((self._name(token),), self._span(children))

    def selector(self, children: Children) -> s.SelectorExp:
        return s.SelectorExp(children[1].items[0], self._span(children))

    def let_exp(self, children: Children) -> s.LetExp:
        declarations, *bodies = self._nodes(children)
        body = (
            bodies[0]
            if len(bodies) == 1
            else s.SequenceExp(tuple(bodies), bodies[0].span.to(bodies[-1].span))
        )
        return s.LetExp(declarations.items, body, self._span(children))

    def keyword(self, children: Children) -> s.Keyword:
        return s.Keyword(children[0].text, self._span(children))

    def constraint(self, children: Children) -> s.Constraint:
        return s.Constraint(children[1], self._span(children))

    def handler(self, children: Children) -> s.Handler:
        return s.Handler(children[1].items, self._span(children))

    def raise_exp(self, children: Children) -> s.RaiseExp:
        return s.RaiseExp(children[1], self._span(children))

    def if_exp(self, children: Children) -> s.IfExp:
        return s.IfExp(children[1], children[3], children[5], self._span(children))

    def while_exp(self, children: Children) -> s.WhileExp:
        return s.WhileExp(children[1], children[3], self._span(children))

    def case_exp(self, children: Children) -> s.CaseExp:
        return s.CaseExp(children[1], children[3].items, self._span(children))

    def fn_exp(self, children: Children) -> s.FnExp:
        return s.FnExp(children[1].items, self._span(children))

    def rule(self, children: Children) -> s.Rule:
        return s.Rule(children[0], children[2], self._span(children))

    # --- patterns

    def pat(self, children: Children) -> s.Pat:
        if len(children) == 1 and not isinstance(children[0], s.Keyword | s.Constraint | s.NamePat):
            pattern: s.Pat = children[0]
            return pattern
        return s.FlatPat(tuple(children), self._span(children))

    def name_pat(self, children: Children) -> s.NamePat:
        return s.NamePat(children[-1].text, len(children) > 1, self._span(children))

    def literal_pat(self, children: Children) -> s.LitPat:
        token: Lexeme = children[0]
        assert token.value is not None
        return s.LitPat(_LITERALS[token.kind], token.value, self._of(token))

    def wild_pat(self, children: Children) -> s.WildPat:
        return s.WildPat(self._span(children))

    def unit_pat(self, children: Children) -> s.RecordPat:
        return s.RecordPat((), False, self._span(children))

    def tuple_pat(self, children: Children) -> s.RecordPat:
        return s.RecordPat(_number(self._nodes(children)), False, self._span(children))

    def or_pat(self, children: Children) -> s.OrPat:
        return s.OrPat(self._nodes(children), self._span(children))

    def list_pat(self, children: Children) -> s.ListPat:
        return s.ListPat(self._nodes(children), self._span(children))

    def vector_pat(self, children: Children) -> s.VectorPat:
        return s.VectorPat(self._nodes(children), self._span(children))

    def record_pat(self, children: Children) -> s.RecordPat:
        parts = self._nodes(children)
        fields = tuple((p.items[0], p.items[1]) for p in parts if isinstance(p, Group))
        return s.RecordPat(fields, any(isinstance(p, Dots) for p in parts), self._span(children))

    def pfield(self, children: Children) -> Group:
        return Group((children[0].items[0], children[2]), self._span(children))

    def pfield_pun(self, children: Children) -> Group:
        """`a`, `a : ty`, `a as p`: the variable is the label."""
        pattern: s.Pat = children[0]
        first = pattern.items[0] if isinstance(pattern, s.FlatPat) else pattern
        label = first.name if isinstance(first, s.NamePat) else ""
        return Group((label, pattern), self._span(children))

    def pfield_dots(self, children: Children) -> Dots:
        return Dots(self._span(children))

    # --- types

    def fun_ty(self, children: Children) -> s.FunTy:
        return s.FunTy(children[0], children[2], self._span(children))

    def product_ty(self, children: Children) -> s.RecordTy:
        return s.RecordTy(_number(self._nodes(children)), self._span(children))

    def var_ty(self, children: Children) -> s.VarTy:
        return s.VarTy(children[0].text, self._span(children))

    def name_ty(self, children: Children) -> s.NameTy:
        return s.NameTy(children[-1].text, self._nodes(children), self._span(children))

    def record_ty(self, children: Children) -> s.RecordTy:
        fields = tuple((g.items[0], g.items[1]) for g in self._nodes(children))
        return s.RecordTy(fields, self._span(children))

    def tyfield(self, children: Children) -> Group:
        return Group((children[0].items[0], children[2]), self._span(children))

    def tyvars(self, children: Children) -> Group:
        return Group(self._texts(children, "TYVAR"), self._span(children))

    # --- declarations

    def exp_unit(self, children: Children) -> Group:
        span = self._span(children)
        return Group((s.ExpDec(children[0], span),), span)

    def _only(self, children: Children, kind: type) -> tuple[Any, ...]:
        return tuple(c for c in children if isinstance(c, kind))

    def val_dec(self, children: Children) -> s.ValDec:
        bindings = []
        recursive = False
        for binding in self._only(children, s.ValBinding):
            recursive = recursive or binding.recursive  # `rec` counts for all that follow
            bindings.append(s.ValBinding(binding.pattern, binding.value, recursive, binding.span))
        return s.ValDec(tuple(bindings), self._span(children), self._tyvars(children))

    def _tyvars(self, children: Children) -> tuple[str, ...]:
        """The type variables written after `val` or `fun`."""
        return tuple(n for g in self._only(children, Group) for n in g.items)

    def valbind(self, children: Children) -> s.ValBinding:
        pattern, value = self._nodes(children)
        return s.ValBinding(
            pattern, value, bool(self._texts(children, "REC")), self._span(children)
        )

    def fun_dec(self, children: Children) -> s.FunDec:
        return s.FunDec(
            self._only(children, s.FlatFunBinding), self._span(children), self._tyvars(children)
        )

    def funbind(self, children: Children) -> s.FlatFunBinding:
        return s.FlatFunBinding(self._nodes(children), self._span(children))

    def clause(self, children: Children) -> s.FlatClause:
        return s.FlatClause(children[0], children[2], self._span(children))

    def type_dec(self, children: Children) -> s.TypeDec:
        return s.TypeDec(self._named_types(self._group(children)).items, self._span(children))

    def tybind(self, children: Children) -> s.TypeBinding:
        parameters = children[0].items if isinstance(children[0], Group) else ()
        (name,) = self._texts(children, "ID")
        return s.TypeBinding(parameters, name, children[-1], self._span(children))

    def datatype_dec(self, children: Children) -> s.DatatypeDec:
        withtypes = self._only(children, Group)
        return s.DatatypeDec(
            self._only(children, s.DatatypeBinding),
            withtypes[0].items if withtypes else (),
            self._span(children),
        )

    def withtypes(self, children: Children) -> Group:
        return self._named_types(self._group(children))

    @staticmethod
    def _named_types(group: Group) -> Group:
        """Type declarations, whose names have no points; those of `where type` may."""
        for binding in group.items:
            _short(binding.name, binding.span)
        return group

    def datbind(self, children: Children) -> s.DatatypeBinding:
        parameters = children[0].items if isinstance(children[0], Group) else ()
        (name,) = self._names(children)
        constructors = self._only(children, s.ConBinding)
        return s.DatatypeBinding(parameters, name, constructors, self._span(children))

    def conbind(self, children: Children) -> s.ConBinding:
        types = self._nodes(children)
        (name,) = self._names(children)
        return s.ConBinding(name, types[0] if types else None, self._span(children))

    def datatype_copy(self, children: Children) -> s.DatatypeCopyDec:
        name, original = self._texts(children, "ID")
        return s.DatatypeCopyDec(
            _short(name, self._of(children[1])), original, self._span(children)
        )

    def exception_dec(self, children: Children) -> s.ExceptionDec:
        return s.ExceptionDec(self._nodes(children), self._span(children))

    def exbind(self, children: Children) -> s.ExceptionBinding:
        types = self._nodes(children)
        (name,) = self._names(children)
        return s.ExceptionBinding(name, types[0] if types else None, None, self._span(children))

    def exbind_copy(self, children: Children) -> s.ExceptionBinding:
        name, original = self._texts(children, "ID")
        _short(name, self._span(children))
        return s.ExceptionBinding(name, None, original, self._span(children))

    def local_dec(self, children: Children) -> s.LocalDec:
        hidden, visible = self._nodes(children)
        return s.LocalDec(hidden.items, visible.items, self._span(children))

    def open_dec(self, children: Children) -> s.OpenDec:
        return s.OpenDec(self._texts(children, "ID"), self._span(children))

    def infix_dec(self, children: Children) -> s.InfixDec:
        kind = {"INFIX": "left", "INFIXR": "right", "NONFIX": "nonfix"}[children[0].kind]
        digits = [c.value for c in children if isinstance(c, Lexeme) and c.kind == "INT"]
        names = tuple(str(g.items[0]) for g in self._only(children, Group))
        # What is not between 0 and 9 is reported where the declaration takes effect.
        return s.InfixDec(kind, int(digits[0] or 0) if digits else 0, names, self._span(children))

    def opname(self, children: Children) -> Group:
        return Group((self._name(children[0]),), self._span(children))

    def abstype_dec(self, children: Children) -> s.AbstypeDec:
        *withtypes, body = self._only(children, Group)
        datatypes = s.DatatypeDec(
            self._only(children, s.DatatypeBinding),
            withtypes[0].items if withtypes else (),
            self._span(children[: 2 + len(withtypes)]),
        )
        return s.AbstypeDec(datatypes, body.items, self._span(children))

    # --- modules

    def structure_dec(self, children: Children) -> s.StructureDec:
        return s.StructureDec(self._only(children, s.StructureBinding), self._span(children))

    def strbind(self, children: Children) -> s.StructureBinding:
        (name,) = self._names(children)
        body = self._sealed(children[-1], children[1])
        return s.StructureBinding(name, body, self._span(children))

    def ascription(self, children: Children) -> Group:
        return Group((children[0].kind == "SEAL", children[1]), self._span(children))

    def _sealed(self, body: s.Str, ascription: Any) -> s.Str:
        if not isinstance(ascription, Group):
            return body
        opaque, signature = ascription.items
        return s.SealedStr(body, signature, opaque, body.span)

    def struct_str(self, children: Children) -> s.StructStr:
        return s.StructStr(children[1].items, self._span(children))

    def name_str(self, children: Children) -> s.NameStr:
        return s.NameStr(children[0].text, self._span(children))

    def apply_str(self, children: Children) -> s.ApplyStr:
        argument = children[2]
        if isinstance(argument, Group):
            argument = s.StructStr(argument.items, self._span(children))
        return s.ApplyStr(children[0].text, argument, self._span(children))

    def let_str(self, children: Children) -> s.LetStr:
        return s.LetStr(children[1].items, children[3], self._span(children))

    def sealed_str(self, children: Children) -> s.Str:
        return self._sealed(children[0], children[1])

    def signature_dec(self, children: Children) -> s.SignatureDec:
        bindings = tuple(g.items for g in self._only(children, Group))
        return s.SignatureDec(bindings, self._span(children))

    def sigbind(self, children: Children) -> Group:
        return Group((self._name(children[0]), children[2]), self._span(children))

    def sig_sig(self, children: Children) -> s.SigSig:
        return s.SigSig(_spread(children[1].items), self._span(children))

    def name_sig(self, children: Children) -> s.NameSig:
        return s.NameSig(children[0].text, self._span(children))

    def where_sig(self, children: Children) -> s.WhereSig:
        return s.WhereSig(children[0], self._only(children, s.TypeBinding), self._span(children))

    def valspec(self, children: Children) -> s.ValSpec:
        return s.ValSpec(children[0].items[0], children[2], self._span(children))

    def opid(self, children: Children) -> Group:
        return Group((self._name(children[-1]),), self._span(children))

    def type_spec(self, children: Children) -> Group:
        equality = children[0].kind == "EQTYPE"
        specs = self._only(children, s.TypeSpec)
        return Group(tuple(replace(x, equality=equality) for x in specs), self._span(children))

    def tyspec(self, children: Children) -> s.TypeSpec:
        parameters = children[0].items if isinstance(children[0], Group) else ()
        (name,) = self._names(children)
        written = None if isinstance(children[-1], Lexeme) else children[-1]
        return s.TypeSpec(parameters, name, written, False, self._span(children))

    def exspec(self, children: Children) -> s.ExceptionSpec:
        argument = None if len(children) == 1 else children[2]
        return s.ExceptionSpec(self._name(children[0]), argument, self._span(children))

    def strspec(self, children: Children) -> s.StructureSpec:
        return s.StructureSpec(self._name(children[0]), children[2], self._span(children))

    def include_spec(self, children: Children) -> s.IncludeSpec:
        signatures = tuple(
            s.NameSig(c.text, self._of(c)) if isinstance(c, Lexeme) else c for c in children[1:]
        )
        return s.IncludeSpec(signatures, self._span(children))

    def sharing_spec(self, children: Children) -> s.SharingSpec:
        return s.SharingSpec(self._texts(children, "ID"), self._span(children))

    def functor_dec(self, children: Children) -> s.FunctorDec:
        return s.FunctorDec(self._only(children, s.FunctorBinding), self._span(children))

    def funcbind(self, children: Children) -> s.FunctorBinding:
        parameter, signature = children[2].items
        body = self._sealed(children[-1], children[4])
        return s.FunctorBinding(
            self._name(children[0]), parameter, signature, body, self._span(children)
        )

    def funcparam(self, children: Children) -> Group:
        if len(children) == 3:
            return Group((self._name(children[0]), children[2]), self._span(children))
        specs: Group = children[0]
        return Group(("", s.SigSig(_spread(specs.items), specs.span)), self._span(children))


def _short(name: str, span: Span) -> str:
    """A name that is declared.

    Raises:
        NotANameError: it has points.
    """
    if is_long(name):
        raise NotANameError(
            span,
            f"`{name}` is the name of something inside a structure, which cannot be declared here",
        )
    return name


def is_long(name: str) -> bool:
    """Whether a name says in which structure to look: `List.map`."""
    return "." in name and name[0].isalpha()


def _spread(items: Sequence[Any]) -> tuple[Any, ...]:
    """Specifications without the groups of `val .. and ..`."""
    out: list[Any] = []
    for item in items:
        out += _spread(item.items) if isinstance(item, Group) else [item]
    return tuple(out)


def _number(items: Sequence[Any]) -> tuple[tuple[str, Any], ...]:
    return tuple((str(i), item) for i, item in enumerate(items, 1))


Builder = Callable[[Children], Any]
