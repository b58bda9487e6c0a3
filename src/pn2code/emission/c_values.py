"""What is known of values when they are printed as C."""

from __future__ import annotations

from collections.abc import Container

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Rep

SCALARS = frozenset({Rep.BOOL, Rep.INT, Rep.CHAR, Rep.ENUM})
"""Representations whose values C compares with `==`."""


def is_structural(value: ir.Ir, references: Container[str]) -> bool:
    """Whether a value is put together from constants and variables alone: each evaluation gives the same."""
    match value:
        case ir.Const() | ir.EnumValue() | ir.Bound():
            return True
        case ir.GlobalUse(name=name):
            return name not in references
        case ir.MakeStruct(fields=fields):
            return all(is_structural(part, references) for _, part in fields)
        case ir.MakeUnion(argument=argument):
            return argument is None or is_structural(argument, references)
        case ir.Op(name="list.cons", arguments=arguments):
            return all(is_structural(part, references) for part in arguments)
    return False
