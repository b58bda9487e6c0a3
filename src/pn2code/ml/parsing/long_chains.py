"""Long chains of operators as something that is not nested as deeply."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pn2code.ml.parsing import syntax as s

LONG_CHAIN = 50
"""Operators side by side from which on a chain of them is taken apart, so that it is not nested so deeply."""

_FLAT_ANYWAY = {"++", "+++", "^", "^^"}
"""Operators whose chains the type checker makes balanced trees of."""


def shortened(e: s.Exp, fixities: Mapping[str, tuple[int, str]]) -> s.Exp:
    """A long chain of operators as something that is not nested as deeply.

    `a :: b :: ... :: tail` is a list in front of the tail, `a + b - c ...` is cut into pieces that have names.
    """
    if not isinstance(e, s.InfixExp):
        return e
    if e.operator.name == "::":
        return _shortened_list(e, fixities)
    precedence = fixities.get(e.operator.name)
    spine: list[s.InfixExp] = []
    node: s.Exp = e
    while isinstance(node, s.InfixExp) and fixities.get(node.operator.name) == precedence:
        spine.append(node)
        node = node.left
    if precedence is None or precedence[1] == "right" or len(spine) <= LONG_CHAIN:
        left, right = shortened(e.left, fixities), shortened(e.right, fixities)
        return replace(e, left=left, right=right)
    if {x.operator.name for x in spine} <= _FLAT_ANYWAY:
        return e
    value = shortened(node, fixities)
    pieces: list[s.Dec] = []
    for i, x in enumerate(reversed(spine), 1):
        value = replace(x, left=value, right=shortened(x.right, fixities))
        if i % LONG_CHAIN == 0:
            name = f"{i} terms"  # no name that a user can write
            binding = s.ValBinding(s.NamePat(name, False, x.span), value, False, x.span)
            pieces.append(s.ValDec((binding,), x.span))
            value = s.NameExp(name, False, x.span)
    return s.LetExp(tuple(pieces), value, e.span)


def _shortened_list(e: s.InfixExp, fixities: Mapping[str, tuple[int, str]]) -> s.Exp:
    items: list[s.Exp] = []
    node: s.Exp = e
    while isinstance(node, s.InfixExp) and node.operator.name == "::":
        items.append(shortened(node.left, fixities))
        node = node.right
    front = s.ListExp(tuple(items), e.span)
    if isinstance(node, s.ListExp):
        return replace(front, items=(*items, *node.items))
    return s.InfixExp(s.NameExp("List.@", False, e.operator.span), front, node, e.span)
