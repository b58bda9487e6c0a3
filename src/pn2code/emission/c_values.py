"""What is known of values when they are printed as C."""

from __future__ import annotations

from collections.abc import Container

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Rep

SCALARS = frozenset({Rep.BOOL, Rep.INT, Rep.CHAR, Rep.ENUM})
"""Representations whose values C compares with `==`."""


def constant(g: ir.Global) -> ir.Const | None:
    """What a `val` always is, if that is known when it is printed."""
    setup = g.setup[0] if len(g.setup) == 1 else None
    if not isinstance(setup, ir.SetGlobal) or g.is_reference or setup.is_reference:
        return None
    return setup.value if isinstance(setup.value, ir.Const) else None


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
