# ruff: noqa: D102  (each method is named after a rule of the grammar, which says what it is)
"""Declarations in the syntax tree."""

from __future__ import annotations

from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.lexer import Lexeme
from pn2code.ml.parsing.tree_parts import Children, Group, TreeParts, short_name


class TreeDeclarations(TreeParts):
    """Makes declarations."""

    def exp_unit(self, children: Children) -> Group:
        span = self._span(children)
        return Group((s.ExpDec(children[0], span),), span)

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
            short_name(binding.name, binding.span)
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
            short_name(name, self._of(children[1])), original, self._span(children)
        )

    def exception_dec(self, children: Children) -> s.ExceptionDec:
        return s.ExceptionDec(self._nodes(children), self._span(children))

    def exbind(self, children: Children) -> s.ExceptionBinding:
        types = self._nodes(children)
        (name,) = self._names(children)
        return s.ExceptionBinding(name, types[0] if types else None, None, self._span(children))

    def exbind_copy(self, children: Children) -> s.ExceptionBinding:
        name, original = self._texts(children, "ID")
        short_name(name, self._span(children))
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
