"""References: variables of C at top level, variables of the C function where they are never values, else cells.

A cell lies in the arena like lists, and is shared: `pn_relocate` keeps it one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Rep
from pn2code.lowering.expressions.values import LocalReference, Reference, Val
from pn2code.ml.core.types import Type

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body

Special = Callable[["Body", tuple[Val, ...], Type, Span], Val]


def _new(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    first = body.addressable(body.code(arguments[0], at), "first")
    return body.spill(ir.NewRef(first, body.program.types.lower(result, at)), "reference")


def _target(body: Body, value: Val) -> tuple[Ir | None, IrType]:
    """The reference as code (None: at top level), and the type of what it holds."""
    if isinstance(value, Reference):
        return None, value.type
    if isinstance(value, LocalReference):
        return ir.Use(value.local), value.local.type
    code = body.atomic(body.code(value), "reference")
    assert code.type.rep is Rep.REF
    definition = body.program.types.definition(code.type)
    assert isinstance(definition, ir.RefDef)
    return code, definition.target


def _contents(value: Val, code: Ir | None, t: IrType) -> Ir:
    if isinstance(value, Reference):
        return ir.GlobalUse(value.name, t)
    assert code is not None
    return code if isinstance(value, LocalReference) else ir.Contents(code, t)


def _read(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    reference = arguments[0]
    code, t = _target(body, reference)
    hint = reference.name if isinstance(reference, Reference) else "contents"
    if isinstance(reference, LocalReference):
        hint = reference.local.hint
    return body.spill(_contents(reference, code, t), hint)


def _assigning(op: str) -> Special:
    def assign(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
        value: Ir = ir.Const(1, ir.INT)
        if op in ("inc", "dec"):
            reference = arguments[0]
        else:
            reference, operand = body.components(arguments[0], 2)
            value = body.addressable(body.code(operand, at), "value")
        code, t = _target(body, reference)
        old = _contents(reference, code, t)
        new = value
        if op in ("+=", "inc"):
            new = ir.Op("Int.+", (old, value), ir.INT)
        elif op in ("-=", "dec"):
            new = ir.Op("Int.-", (old, value), ir.INT)
        elif op == "*=":
            new = ir.Op("Int.*", (old, value), ir.INT)
        elif op == "::=":
            new = ir.Op("list.cons", (value, old), t, body.program.types.plain(t))
        if isinstance(reference, Reference):
            body.emit(ir.SetGlobal(reference.name, new, True))
        else:
            assert code is not None
            body.emit(ir.SetContents(code, new))
        return ir.Const(None, ir.UNIT)

    return assign


FUNCTIONS: dict[str, Special] = {
    "Ref.ref": _new,
    "Ref.!": _read,
    **{f"Ref.{op}": _assigning(op) for op in (":=", "+=", "-=", "*=", "::=", "inc", "dec")},
}
"""Full name -> how it is lowered."""
