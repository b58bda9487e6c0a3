# ruff: noqa: D102  (each method is named after a rule of the grammar, which says what it is)
"""Structures, signatures and functors in the syntax tree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.lexer import Lexeme
from pn2code.ml.parsing.tree_parts import Children, Group, TreeParts


class TreeModules(TreeParts):
    """Makes modules and their specifications."""

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


def _spread(items: Sequence[Any]) -> tuple[Any, ...]:
    """Specifications without the groups of `val .. and ..`."""
    out: list[Any] = []
    for item in items:
        out += _spread(item.items) if isinstance(item, Group) else [item]
    return tuple(out)
