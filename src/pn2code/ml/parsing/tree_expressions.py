# ruff: noqa: D102  (each method is named after a rule of the grammar, which says what it is)
"""Expressions, patterns and types in the syntax tree."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.lexer import Lexeme
from pn2code.ml.parsing.tree_parts import Children, Dots, Group, NotANameError, TreeParts

_LITERALS = {
    "INT": s.LitKind.INT,
    "WORD": s.LitKind.WORD,
    "REAL": s.LitKind.REAL,
    "STRING": s.LitKind.STRING,
    "CHAR": s.LitKind.CHAR,
}


class TreeExpressions(TreeParts):
    """Makes expressions, patterns and types."""

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


def _number(items: Sequence[Any]) -> tuple[tuple[str, Any], ...]:
    return tuple((str(i), item) for i, item in enumerate(items, 1))
