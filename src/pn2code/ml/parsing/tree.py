# ruff: noqa: D102  (each method is named after a rule of the grammar, which says what it is)
"""Builds the syntax tree from the parser's reductions (one method a grammar rule)."""

from __future__ import annotations

from typing import Any

from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.tree_declarations import TreeDeclarations
from pn2code.ml.parsing.tree_expressions import TreeExpressions
from pn2code.ml.parsing.tree_modules import TreeModules
from pn2code.ml.parsing.tree_parts import Children, Group, TreeParts


class TreeBuilder(TreeExpressions, TreeDeclarations, TreeModules):
    """Used by the parser; `source` is set before each parse."""

    unit = decs = match = specs = TreeParts._group

    def program(self, children: Children) -> Group:
        decs = [dec for unit in self._nodes(children) for dec in unit.items]
        return Group(tuple(decs), self._span(children))

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
