"""The values of a colour set: all of them, also where the runtime cannot number them, or some value.

The runtime numbers no lists, strings and subsets, nor what is made of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from pn2code.diagnostics import Origin, SourceText, Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir
from pn2code.lowering.expressions import higher_order
from pn2code.lowering.expressions.prelude_calls import call
from pn2code.lowering.expressions.values import RecordVal, Val
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import CHAR, INT, STRING, TFun, Type, list_of, tuple_of

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body


def all_values(body: Body, colset: Colset, at: Span | Origin) -> Ir:
    """A list of all values, in order."""
    types = body.program.types
    c = colset.resolved
    table = types.colset(colset)
    t = types.lower(list_of(colset.type))
    types.plain(t)
    span = at if isinstance(at, Span) else _no_span(colset, at)
    if types.is_small(table):
        return ir.Op("Colset.all", (), t, table)
    match c.kind:
        case Kind.SUBSET:
            return _subset(body, c, t, table, span)
        case Kind.PRODUCT | Kind.RECORD:
            return _combinations(body, c, t, span)
        case Kind.UNION:
            return _constructors(body, c, t, span)
        case Kind.LIST if isinstance(c.low, int) and isinstance(c.high, int):
            part = c.components[0]
            assert part is not None
            items = body.atomic(all_values(body, part, span), "items")
            return _sequences(body, "sequences", items, list_of(part.type), c.low, c.high, t, span)
        case Kind.STRING if (
            c.length is not None and isinstance(c.low, str) and isinstance(c.high, str)
        ):
            pair = RecordVal(
                {"1": ir.Const(ord(c.low), ir.INT), "2": ir.Const(ord(c.high), ir.INT)},
                tuple_of(INT, INT),
            )
            letters_type = TFun(tuple_of(INT, INT), list_of(CHAR))
            letters = call(body, "Colour.letters", letters_type, [(pair, list_of(CHAR))], span)
            return _sequences(
                body, "strings", body.code(letters), list_of(CHAR), *c.length, t, span
            )
    # Without bounds: the runtime raises CPN'Error.
    return ir.Op("Colset.all", (), t, table)


def is_countable(colset: Colset) -> bool:
    """Whether `all_values` gives something."""
    c = colset.resolved
    match c.kind:
        case Kind.SUBSET:
            return c.members is not None or all(is_countable(p) for p in c.components if p)
        case Kind.PRODUCT | Kind.RECORD | Kind.UNION:
            return all(is_countable(p) for p in c.components if p is not None)
        case Kind.LIST:
            part = c.components[0]
            return (
                isinstance(c.low, int) and isinstance(c.high, int) and part is not None
            ) and is_countable(part)
        case Kind.STRING:
            return c.length is not None and isinstance(c.low, str) and isinstance(c.high, str)
        case Kind.INT | Kind.INTINF | Kind.INDEX:
            return isinstance(c.low, int) and isinstance(c.high, int)
        case Kind.UNIT | Kind.BOOL | Kind.ENUM:
            return True
    return False


def _no_span(colset: Colset, at: Origin) -> Span:

    return Span(SourceText(colset.name, at), 0, 0)


def _sequences(
    body: Body, name: str, items: Ir, items_type: Type, low: int, high: int, t: ir.IrType, at: Span
) -> Ir:
    argument = tuple_of(items_type, INT, INT)
    result = list_of(STRING) if name == "strings" else list_of(items_type)
    values: dict[str, Val] = {
        "1": items,
        "2": ir.Const(low, ir.INT),
        "3": ir.Const(high, ir.INT),
    }
    step: tuple[Val, Type] = (RecordVal(values, argument), result)
    made = body.code(call(body, f"Colour.{name}", TFun(argument, result), [step], at))
    assert made.type == t
    return made


def _subset(body: Body, c: Colset, t: ir.IrType, table: str, at: Span) -> Ir:
    """Those of the base that belong to it, or those it lists, in order."""
    base = c.components[0]
    assert base is not None
    own = c.members
    candidates = all_values(body, base, at) if own is None else body.atomic(body.ir(own, {}), "all")
    return higher_order.filter_values(
        body, candidates, lambda v: ir.Op("Colset.legal", (v,), ir.BOOL, table)
    )


def _combinations(body: Body, c: Colset, t: ir.IrType, at: Span) -> Ir:
    """All combinations, the last component fastest."""
    labels = c.labels or tuple(str(i) for i in range(1, len(c.components) + 1))
    parts = {x: p for x, p in zip(labels, c.components, strict=True) if p is not None}
    lists = {x: body.atomic(all_values(body, p, at), "all") for x, p in parts.items()}
    return higher_order.combinations(body, lists, t)


def _constructors(body: Body, c: Colset, t: ir.IrType, at: Span) -> Ir:
    """Each constructor with all its arguments."""
    element = body.element(t)

    def fill(keep: Callable[[Ir], None]) -> None:
        for tag, part in enumerate(c.components):
            if part is None:
                keep(ir.MakeUnion(tag, None, element))
            else:
                higher_order.for_each(
                    body,
                    all_values(body, part, at),
                    # The default keeps the tag of this round.
                    lambda x, tag=tag: keep(ir.MakeUnion(tag, x, element)),  # type: ignore[misc]
                )

    return higher_order.collect(body, t, fill)


def base_value(body: Body, colset: Colset, at: Span) -> Ir:
    """Some value: the first one, or the simplest of an unbounded colour set."""
    c = colset.resolved
    types = body.program.types
    t = types.lower(colset.type)
    match c.kind:
        case Kind.REAL if isinstance(c.low, int | float):
            return ir.Const(float(c.low), ir.REAL)
        case Kind.STRING:
            return ir.Const("", ir.STRING)
        case Kind.LIST:
            return ir.Op("list.nil", (), t)
        case Kind.PRODUCT | Kind.RECORD:
            labels = c.labels or tuple(str(i) for i in range(1, len(c.components) + 1))
            parts = {
                x: base_value(body, p, at)
                for x, p in zip(labels, c.components, strict=True)
                if p is not None
            }
            definition = types.definition(t)
            assert isinstance(definition, ir.StructDef)
            return ir.MakeStruct(t, tuple((x, parts[x]) for x, _ in definition.fields))
        case Kind.UNION if (part := c.components[0]) is not None:
            return ir.MakeUnion(0, base_value(body, part, at), t)
        case Kind.SUBSET if c.members is None and c.components[0] is not None:
            return base_value(body, c.components[0], at)
        case Kind.SUBSET:
            values = body.atomic(all_values(body, colset, at), "all")
            return ir.Select(ir.IsNil(values), body.zero(t), ir.Head(values, t), t)
    local = body.local("base", t)
    body.emit(ir.Declare(local))
    body.emit(ir.Fill(local, "base", types.colset(colset), ()))
    return ir.Use(local)
