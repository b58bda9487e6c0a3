"""Built-in functions that become a few lines of IR."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from pn2code.base.frozen import replace
from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Rep
from pn2code.lowering.expressions import clock, exceptions, higher_order, references
from pn2code.lowering.expressions.matching import negation
from pn2code.lowering.expressions.values import BuiltinFunction, ConstructorFunction, Partial, Val
from pn2code.ml.core.types import TCon, TFun, TVar, Type

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body


def _table(body: Body, t: IrType) -> str:
    return body.program.types.plain(t) if t.name and t.rep is not Rep.ENUM else ""


def equal(body: Body, a: Ir, b: Ir) -> Ir:
    """Structural equality."""
    a, b = body.addressable(a, "left"), body.addressable(b, "right")
    return ir.Op("=", (a, b), ir.BOOL, _table(body, a.type))


def same(body: Body, a: Ir, b: Ir) -> Ir:
    """Whether both are one token: as `equal`, but what is no number is like itself."""
    test = equal(body, a, b)
    assert isinstance(test, ir.Op)
    return replace(test, name="same") if test.table or a.type.rep is Rep.REAL else test


def _equality(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    a, b = (body.code(v, at) for v in body.components(arguments[0], 2))
    return equal(body, a, b)


def _inequality(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    return negation(body.code(_equality(body, arguments, result, at)))


def _now(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    return clock.now(body.program.real_time)


def _compose(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    f, g = body.components(arguments[0], 2)
    middle = TVar(
        0
    )  # only the representation of results that are C code matters, and `apply` knows it
    return body.apply(f, body.apply(g, arguments[1], _result_of(body, g, middle), at), result, at)


def _result_of(body: Body, function: Val, default: Type) -> Type:
    """The result type of a function value, where a built-in or constructor needs to be told."""

    match function:
        case BuiltinFunction(type=TFun(result=r)) | ConstructorFunction(type=TFun(result=r)):
            return r
        case Partial(function=BuiltinFunction(type=t), arguments=arguments):
            for _ in range(len(arguments) + 1):
                assert isinstance(t, TFun)
                t = t.result
            return t
    return default


def _before(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    value, after = body.components(arguments[0], 2)
    body.discard(after)
    return value


def _ignore(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    body.discard(arguments[0])
    return ir.Const(None, ir.UNIT)


def head_or(body: Body, cell: Ir) -> Ir:
    """The head of a list; a harmless value if it is empty (an exception was raised then)."""
    cell = body.atomic(cell, "cell")
    element = body.element(cell.type)
    return ir.Select(negation(ir.IsNil(cell)), ir.Head(cell, element), body.zero(element), element)


def _cell(
    op: str, *, tupled: bool = False, rest: bool = False
) -> Callable[[Body, tuple[Val, ...], Type, Span], Val]:
    """Functions that find a cell of a list and give its head."""

    def find(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
        values = body.components(arguments[0], 2) if tupled else list(arguments)
        operands = tuple(body.code(v, at) for v in values)
        found = ir.Op(op, operands, operands[0].type)
        return found if rest else head_or(body, found)

    return find


def _copies(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    n, value = (body.code(v, at) for v in body.components(arguments[0], 2))
    value = body.addressable(value, "value")
    t = body.program.types.lower(result)
    if isinstance(n, ir.Const) and n.value == 1:
        empty = ir.Op("list.nil", (), t)
        return ir.Op("list.cons", (value, empty), t, body.program.types.plain(t))
    return ir.Op("Ms.`", (n, value), t, body.program.types.plain(t))


def _if_all(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    """`[b1, ...] % x` and `[b1, ...] // ms`."""
    conditions, value = body.components(arguments[0], 2)
    operand = body.code(value, at)
    t = body.program.types.lower(result)
    flags = body.code(conditions, at)
    if operand.type != t:
        operand = body.addressable(operand, "value")
        empty = ir.Op("list.nil", (), t)
        operand = ir.Op("list.cons", (operand, empty), t, body.program.types.plain(t))
    return ir.Select(
        ir.Op("list.all_true", (flags,), ir.BOOL), operand, ir.Op("list.nil", (), t), t
    )


def _only(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    operand = body.code(arguments[0], at)
    return head_or(body, ir.Op("Ms.ms_to_col", (operand,), operand.type))


def _pick(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    operand = body.code(arguments[0], at)
    return head_or(body, body.spill(ir.Op("Ms.random", (operand,), operand.type), "picked"))


def _insert(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    values, value = (body.code(v, at) for v in arguments)
    value = body.addressable(value, "value")
    t, table = values.type, body.program.types.plain(values.type)
    last = ir.Op("list.cons", (value, ir.Op("list.nil", (), t)), t, table)
    return ir.Op("List.@", (values, last), t, table)


def _insert_new(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    values = body.atomic(body.code(arguments[0], at), "values")
    value = body.atomic(body.code(arguments[1], at), "value")
    is_there = ir.Op("List.mem", (values, value), ir.BOOL, body.program.types.plain(values.type))
    longer = body.code(_insert(body, (values, value), result, at))
    return ir.Select(is_there, values, longer, values.type)


def _value_of(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    option = body.atomic(body.code(arguments[0], at), "option")
    t = body.program.types.lower(result)
    is_some = ir.IsTag(option, 1)
    body.emit(ir.If(negation(is_some), (ir.Raise("Option"),), ()))
    return ir.Select(is_some, ir.Argument(option, 1, t), body.zero(t), t)


def _is_some(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    return ir.IsTag(body.atomic(body.code(arguments[0], at), "option"), 1)


def _value_or(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    option, default = (body.code(v, at) for v in body.components(arguments[0], 2))
    option = body.atomic(option, "option")
    return ir.Select(
        ir.IsTag(option, 1), ir.Argument(option, 1, default.type), default, default.type
    )


def _stamped(*, delayed: bool) -> Callable[[Body, tuple[Val, ...], Type, Span], Val]:
    """`v @ t` and one token `v @+ d`: the stamp itself, or now plus the delay."""

    def make(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
        value, time = (body.code(v, at) for v in body.components(arguments[0], 2))
        t = body.program.types.lower(result)
        make_stamp = clock.after_now if delayed else clock.in_clock
        stamp = make_stamp(body.program.real_time, time)
        return ir.MakeStruct(t, (("value", value), ("stamp", stamp)))

    return make


def _with_stamps(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    """`ms @+ d`."""
    multiset, delay = (body.code(v, at) for v in body.components(arguments[0], 2))
    t = body.program.types.lower(result)
    stamp = body.atomic(clock.after_now(body.program.real_time, delay), "stamp")
    timed = body.element(t)

    def stamped(value: Ir) -> Val:
        return ir.MakeStruct(timed, (("value", value), ("stamp", stamp)))

    return higher_order.map_list(body, multiset, t, stamped)


def _without_stamps(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    tokens = body.code(arguments[0], at)
    t = body.program.types.lower(result)
    element = body.element(t)
    return higher_order.map_list(body, tokens, t, lambda v: ir.Member(v, "value", element))


def _sum_timed(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
    a, b = (body.code(v, at) for v in body.components(arguments[0], 2))
    return ir.Op("List.@", (a, b), a.type, body.program.types.plain(a.type))


def _bound(value_for: Callable[[int], int]) -> Callable[[Body, tuple[Val, ...], Type, Span], Val]:
    """`Int.maxInt` and its like: SOME of a number that depends on the width of `int`."""

    def make(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
        assert isinstance(result, TCon)
        value = value_for(body.program.core.int_bits)
        return ir.MakeUnion(1, ir.Const(value, ir.INT), body.program.types.lower(result))

    return make


def _timed_part(label: str) -> Callable[[Body, tuple[Val, ...], Type, Span], Val]:
    def part(body: Body, arguments: tuple[Val, ...], result: Type, at: Span) -> Val:
        token = body.atomic(body.code(arguments[0], at), "token")
        return clock.timed_part(token, label, body.program.types.lower(result))

    return part


SPECIAL: dict[str, Callable[[Body, tuple[Val, ...], Type, Span], Val]] = {
    "=": _equality,
    "<>": _inequality,
    "General.o": _compose,
    "General.before": _before,
    "General.ignore": _ignore,
    **references.FUNCTIONS,
    **exceptions.FUNCTIONS,
    "List.hd": _cell("List.hd"),
    "List.tl": _cell("List.tl", rest=True),
    "List.last": _cell("List.last"),
    "List.nth": _cell("List.nth", tupled=True),
    "List.ins": _insert,
    "List.ins_new": _insert_new,
    "Ms.`": _copies,
    "Ms.%": _if_all,
    "Ms.//": _if_all,
    "Ms.ms_to_col": _only,
    "Ms.random": _pick,
    "Option.valOf": _value_of,
    "Option.isSome": _is_some,
    "Option.getOpt": _value_or,
    "Time.time": _now,
    "prim.timed_value": _timed_part("value"),
    "prim.timed_stamp": _timed_part("stamp"),
    "Time.@": _stamped(delayed=False),
    "Time.token@+": _stamped(delayed=True),
    "Time.token@++": _stamped(delayed=True),
    "Time.@+": _with_stamps,
    "Time.@++": _with_stamps,
    "Time.+++": _sum_timed,
    "Time.ms": _without_stamps,
    "Int.maxInt": _bound(lambda bits: 2 ** (bits - 1) - 1),
    "Int.minInt": _bound(lambda bits: -(2 ** (bits - 1))),
    "Int.precision": _bound(lambda bits: bits),
}
