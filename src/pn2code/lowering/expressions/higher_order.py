"""Built-in functions that take functions: loops with the function's body inside.

`List.map f l` becomes a loop over the cells of `l` that builds the result back to front, and turns it round at
the end.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Local
from pn2code.lowering.expressions.closures import argument_type
from pn2code.lowering.expressions.matching import negation
from pn2code.lowering.expressions.values import RecordVal, Val
from pn2code.ml.core.types import BOOL, UNIT, TCon, Type

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body

Special = Callable[["Body", tuple[Val, ...], Type, Span], Val]


def _loop(body: Body, values: Ir, step: Callable[[Ir], None], until: Local | None = None) -> None:
    """Runs `step` for each element."""
    cell = body.local("cell", values.type)
    element = body.element(values.type)
    with body.block() as statements:
        step(ir.Head(ir.Use(cell), element))
    body.emit(ir.ForList(cell, values, tuple(statements), until))


def _accumulator(body: Body, t: IrType, hint: str = "reversed") -> Local:
    local = body.local(hint, t)
    body.emit(ir.Let(local, ir.Op("list.nil", (), t), mutable=True))
    return local


def _push(body: Body, target: Local, value: Ir) -> None:
    table = body.program.types.plain(target.type)
    value = body.addressable(value, "item")
    body.emit(ir.Assign(target, ir.Op("list.cons", (value, ir.Use(target)), target.type, table)))


def _reversed(body: Body, local: Local) -> Ir:
    return ir.Op("List.rev", (ir.Use(local),), local.type, body.program.types.plain(local.type))


for_each = _loop


def collect(body: Body, t: IrType, fill: Callable[[Callable[[Ir], None]], None]) -> Ir:
    """The list of what `fill` hands over, in order."""
    out = _accumulator(body, t)
    fill(lambda value: _push(body, out, value))
    return _reversed(body, out)


def combinations(body: Body, lists: Mapping[str, Ir], t: IrType) -> Ir:
    """All combinations of the elements of lists, the last list fastest: a list (type `t`) of structs.

    `lists`: atomic, for each label of the struct one.
    """
    element = body.element(t)
    definition = body.program.types.definition(element)
    assert isinstance(definition, ir.StructDef)

    def combine(labels: list[str], chosen: dict[str, Ir], keep: Callable[[Ir], None]) -> None:
        if not labels:
            fields = tuple((label, chosen[label]) for label, _ in definition.fields)
            keep(ir.MakeStruct(element, fields))
            return
        label, *rest = labels
        for_each(body, lists[label], lambda x: combine(rest, {**chosen, label: x}, keep))

    return collect(body, t, lambda keep: combine(list(lists), {}, keep))


def map_list(body: Body, values: Ir, result: IrType, f: Callable[[Ir], Val]) -> Ir:
    """Each element through a function."""
    out = _accumulator(body, result)
    _loop(body, values, lambda x: _push(body, out, body.code(f(x))))
    return _reversed(body, out)


def _element_type(result: Type) -> Type:
    assert isinstance(result, TCon)
    return result.args[0]


def _map(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, values = arguments
    inner = _element_type(result)
    t = body.program.types.lower(result)
    return map_list(body, body.code(values, at), t, lambda x: body.apply(f, x, inner, at))


def _app(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, values = arguments

    def step(x: Ir) -> None:
        done = body.code(body.apply(f, x, UNIT, at))
        if not isinstance(done, ir.Const):
            body.emit(ir.Do(done))

    _loop(body, body.code(values, at), step)
    return ir.Const(None, ir.UNIT)


def _test(body: Body, f: Val, x: Ir, at: Span) -> Ir:
    return body.code(body.apply(f, x, BOOL, at))


def filter_values(body: Body, values: Ir, test: Callable[[Ir], Ir]) -> Ir:
    """The elements with a property."""
    out = _accumulator(body, values.type)

    def step(x: Ir) -> None:
        with body.block() as then:
            _push(body, out, x)
        body.emit(ir.If(test(x), tuple(then), ()))

    _loop(body, values, step)
    return _reversed(body, out)


def _filter(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, values = arguments
    out = _accumulator(body, body.program.types.lower(result))

    def step(x: Ir) -> None:
        condition = _test(body, f, x, at)
        with body.block() as then:
            _push(body, out, x)
        body.emit(ir.If(condition, tuple(then), ()))

    _loop(body, body.code(values, at), step)
    return _reversed(body, out)


def _partition(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, values = arguments
    code = body.code(values, at)
    yes = _accumulator(body, code.type, "with")
    no = _accumulator(body, code.type, "without")

    def step(x: Ir) -> None:
        condition = _test(body, f, x, at)
        with body.block() as then:
            _push(body, yes, x)
        with body.block() as otherwise:
            _push(body, no, x)
        body.emit(ir.If(condition, tuple(then), tuple(otherwise)))

    _loop(body, code, step)
    return RecordVal({"1": _reversed(body, yes), "2": _reversed(body, no)}, result)


def _searching(*, found: bool) -> Special:
    """`exists` (stops at the first that has the property) and `all` (at the first that has not)."""

    def search(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
        f, values = arguments
        stop = body.local("found", ir.BOOL)
        body.emit(ir.Let(stop, ir.Const(False, ir.BOOL), mutable=True))

        def step(x: Ir) -> None:
            holds = _test(body, f, x, at)
            body.emit(ir.Assign(stop, holds if found else negation(holds)))

        _loop(body, body.code(values, at), step, stop)
        return ir.Use(stop) if found else negation(ir.Use(stop))

    return search


def _find(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, values = arguments
    t = body.program.types.lower(result)
    answer = body.local("first", t)
    stop = body.local("found", ir.BOOL)
    body.emit(ir.Let(answer, ir.MakeUnion(0, None, t), mutable=True))
    body.emit(ir.Let(stop, ir.Const(False, ir.BOOL), mutable=True))

    def step(x: Ir) -> None:
        body.emit(ir.Assign(stop, _test(body, f, x, at)))
        with body.block() as then:
            body.emit(ir.Assign(answer, ir.MakeUnion(1, x, t)))
        body.emit(ir.If(ir.Use(stop), tuple(then), ()))

    _loop(body, body.code(values, at), step, stop)
    return ir.Use(answer)


def _folding(*, right: bool) -> Special:
    def fold(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
        f, start, values = arguments
        code = body.code(values, at)
        if right:
            code = ir.Op("List.rev", (code,), code.type, body.program.types.plain(code.type))
        initial = body.code(start, at)
        so_far = body.local("so_far", initial.type)
        body.emit(ir.Let(so_far, initial, mutable=True))

        both = argument_type(body.program, f)

        def step(x: Ir) -> None:
            pair = RecordVal({"1": x, "2": ir.Use(so_far)}, both)
            body.emit(ir.Assign(so_far, body.code(body.apply(f, pair, result, at))))

        _loop(body, code, step)
        return ir.Use(so_far)

    return fold


def _tabulate(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    count, f = body.components(arguments[0], 2)
    n = body.atomic(body.code(count, at), "count")
    t = body.program.types.lower(result)
    is_negative = ir.Op("Int.<", (n, ir.Const(0, ir.INT)), ir.BOOL)
    body.emit(ir.If(is_negative, (ir.Raise("Size"),), ()))
    out = _accumulator(body, t)
    index = body.local("i", ir.INT)
    with body.block() as statements:
        value = body.apply(f, ir.Use(index), _element_type(result), at)
        _push(body, out, body.code(value))
    body.emit(ir.ForCount(index, n, tuple(statements)))
    return _reversed(body, out)


def _map_partial(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, values = arguments
    t = body.program.types.lower(result)
    out = _accumulator(body, t)
    option = TCon("option", (_element_type(result),))

    def step(x: Ir) -> None:
        value = body.atomic(body.code(body.apply(f, x, option, at)), "option")
        with body.block() as then:
            _push(body, out, ir.Argument(value, 1, body.element(t)))
        body.emit(ir.If(ir.IsTag(value, 1), tuple(then), ()))

    _loop(body, body.code(values, at), step)
    return _reversed(body, out)


def _flat_map(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, values = arguments
    t = body.program.types.lower(result)
    table = body.program.types.plain(t)
    out = _accumulator(body, t)

    def step(x: Ir) -> None:
        part = body.code(body.apply(f, x, result, at))
        body.emit(ir.Assign(out, ir.Op("List.revAppend", (part, ir.Use(out)), t, table)))

    _loop(body, body.code(values, at), step)
    return _reversed(body, out)


def _option_map(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, option = arguments
    t = body.program.types.lower(result)
    value = body.atomic(body.code(option, at), "option")
    definition = body.program.types.definition(value.type)
    assert isinstance(definition, ir.UnionDef)
    argument = definition.constructors[1][1]
    assert argument is not None
    answer = body.local("mapped", t)
    body.emit(ir.Let(answer, ir.MakeUnion(0, None, t), mutable=True))
    with body.block() as then:
        inner = body.code(body.apply(f, ir.Argument(value, 1, argument), _element_type(result), at))
        body.emit(ir.Assign(answer, ir.MakeUnion(1, inner, t)))
    body.emit(ir.If(ir.IsTag(value, 1), tuple(then), ()))
    return ir.Use(answer)


FUNCTIONS: dict[str, Special] = {
    "List.map": _map,
    "Ms.ext_col": _map,
    "List.app": _app,
    "List.filter": _filter,
    "Ms.filter": _filter,
    "List.partition": _partition,
    "List.exists": _searching(found=True),
    "List.all": _searching(found=False),
    "List.find": _find,
    "List.foldl": _folding(right=False),
    "List.foldr": _folding(right=True),
    "List.tabulate": _tabulate,
    "List.mapPartial": _map_partial,
    "List.fmap": _flat_map,
    "Ms.ext_ms": _flat_map,
    "Option.map": _option_map,
}
"""Full name -> how it is lowered."""
