"""Built-in functions applied: most become an `Op` of the same name, some a few lines of IR.

What an `Op` looks like in C is the business of `ir.operations`; a built-in function is supported exactly if
it is in `DIRECT` or has a method here or in `higher_order`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Rep
from pn2code.lowering import prelude
from pn2code.lowering.codes import (
    UNSUPPORTED_BUILTIN,
    UnsupportedError,
)
from pn2code.lowering.expressions import (
    clock,
    colset_functions,
    exceptions,
    higher_order,
    references,
)
from pn2code.lowering.expressions.matching import negation
from pn2code.lowering.expressions.purity import is_impure_builtin
from pn2code.lowering.expressions.values import BuiltinFunction, Polymorphic, Val
from pn2code.lowering.prelude import representation
from pn2code.ml.core.types import TCon, TFun, TRecord, TVar, Type
from pn2code.ml.library.builtins import BUILTINS

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body

_INT = "+ - * ~ abs div mod quot rem < <= > >= min max sign compare toString toInt fromInt toLarge fromLarge"
_INTINF = _INT
_REAL = (
    "+ - * / ~ abs < <= > >= == != min max sign compare rem fromInt fromLargeInt floor ceil round trunc "
    "realFloor realCeil realRound realTrunc isNan isFinite posInf negInf toString"
)
_MATH = "pi e sqrt sin cos tan asin acos atan atan2 exp pow ln log10 sinh cosh tanh"
_STRING = "^ size sub substring concat explode implode str isPrefix isSuffix isSubstring compare < <= > >="
_CHAR = (
    "ord chr compare < <= > >= isDigit isAlpha isAlphaNum isSpace isUpper isLower toUpper toLower"
)
_LIST = (
    "@ null length rev revAppend take drop mem rm rmall contains contains_all union listsub concat "
    "remdupl intersect pos"
)
_MS = "++ -- ** == != << <<= >> >>= cf size"
_RANDOM = (
    "bernoulli binomial uniform discrete normal exponential poisson erlang chisq student gamma beta "
    "weibull rayleigh"
)

DIRECT = frozenset(
    f"{structure}.{name}"
    for structure, names in (
        ("Int", _INT), ("IntInf", _INTINF), ("Real", _REAL), ("Math", _MATH), ("String", _STRING),
        ("Char", _CHAR),
        ("List", _LIST), ("Ms", _MS), ("Random", _RANDOM), ("Bool", "not toString"), ("TextIO", "print"),
        ("Time", "step"), ("ModelTime", "fromInt fromIntInf toString toReal add sub mult lt leq cmp"),
    )
    for name in names.split()
)  # fmt: skip
"""Built-in functions that are one operation of the runtime or of C, on their operands side by side."""

SAME = frozenset(
    [
        "Ms.ms_to_list",
        "Ms.list_to_ms",
        "Int.toInt",
        "Int.fromInt",
        "IntInf.toLarge",
        "IntInf.fromLarge",
    ]
)
"""Built-in functions that give back their argument, as it is represented."""

_LIST_LAST = frozenset(["List.rm", "List.rmall", "List.pos", "Ms.cf"])
"""Those whose last operand is the list; the one before may be a list, too, which is looked for in a list of lists."""

_COMPARISONS = {
    "cmp": "compare",
    "lt": "<",
    "leq": "<=",
    "add": "+",
    "sub": "-",
    "mult": "*",
    "toString": "toString",
}


class Builtins:
    """The built-in functions of one net. `real_time`: model time is a real."""

    def __init__(self, real_time: bool) -> None:
        self._real_time = real_time

    @staticmethod
    def is_primitive(name: str) -> bool:
        """Whether it has a form of its own in IR, so that the prelude need not be asked."""
        return (
            name in DIRECT
            or name in SAME
            or name in _SPECIAL
            or name in higher_order.FUNCTIONS
            or name.startswith(("Colset.", "prim."))
        )

    @staticmethod
    def arity(function: BuiltinFunction) -> int:
        """The number of curried arguments it takes before it does anything."""
        info = BUILTINS.get(function.node.name)
        t: Type = info.type() if info is not None else function.node.type
        n = 0
        while isinstance(t, TFun):
            n, t = n + 1, t.result
        return n

    def apply(
        self,
        body: Body,
        function: BuiltinFunction,
        arguments: tuple[Val, ...],
        result: Type,
        at: Span,
    ) -> Val:
        """The value of a built-in function for all its arguments."""
        name = function.node.name
        if name.startswith("Colset."):
            return self._colset(body, function, arguments, result, at)
        if name in SAME:
            return arguments[0]
        special = _SPECIAL.get(name) or higher_order.FUNCTIONS.get(name)
        if special is not None:
            return special(body, arguments, result, at)
        if name not in DIRECT and not name.startswith("prim."):
            return self._of_prelude(body, function, arguments, result, at)
        is_library = not name.startswith("prim.")
        scheme = BUILTINS[name].type(self._real_time) if is_library else function.type
        if name.startswith("ModelTime."):
            name = self._model_time(name)
        operands = self._operands(body, scheme, arguments)
        t = body.program.types.lower(result, at)
        table = ""
        lists = [o.type for o in operands if o.type.rep is Rep.LIST]
        if name in ("String.explode", "List.concat"):
            table = body.program.types.plain(t)
        elif lists and name.split(".")[0] in ("List", "Ms"):
            table = body.program.types.plain(lists[-1 if name in _LIST_LAST else 0])
        if table:
            operands = [body.addressable(o, "operand") for o in operands]
        op = ir.Op(name, tuple(operands), t, table)
        if is_impure_builtin(name) or t.rep is Rep.UNIT:
            return body.spill(op, name.split(".")[-1])
        return op

    def _of_prelude(
        self,
        body: Body,
        function: BuiltinFunction,
        arguments: tuple[Val, ...],
        result: Type,
        at: Span,
    ) -> Val:
        """A function written in CPN ML, or one that stops the run."""
        name = function.node.name
        info = BUILTINS.get(name)
        if info is not None and info.unsupported:
            text = f"`{name}` is not available here: {info.unsupported}"
            body.emit(ir.Do(ir.Op("prim.stop", (ir.Const(text, ir.STRING),), ir.UNIT)))
            t = body.program.types.lower(result, at)
            return ir.Const(None, ir.UNIT) if t.rep is Rep.UNIT else body.zero(t)
        found = body.program.prelude_function(name)
        if found is None:
            raise UnsupportedError(
                UNSUPPORTED_BUILTIN,
                f"the built-in function `{name}` is not supported in compiled code",
                at,
            )
        file, symbol = found
        if symbol.name in file.values:
            return body.exp(file.values[symbol.name], {})
        inst = prelude.instance(symbol, function.type)
        value = body.program.global_value(body, symbol, inst, at)
        assert not isinstance(value, Polymorphic)
        rest: Type = representation(function.type)
        for argument in arguments:
            assert isinstance(rest, TFun)
            rest = rest.result
            value = body.apply(value, argument, rest, at)
        return value

    def _model_time(self, name: str) -> str:
        """Model time is an IntInf.int or a real."""
        op = name.split(".")[1]
        structure = "Real" if self._real_time else "IntInf"
        if op == "fromInt":
            return "Real.fromInt" if self._real_time else "IntInf.fromInt"
        if op == "fromIntInf":
            return "Real.fromLargeInt" if self._real_time else "time.same"
        if op == "toReal":
            return "time.same" if self._real_time else "Real.fromLargeInt"
        return f"{structure}.{_COMPARISONS[op]}"

    @staticmethod
    def _operands(body: Body, scheme: Type, arguments: tuple[Val, ...]) -> list[Ir]:
        """The arguments as C operands: tuples of the scheme side by side, units left out."""
        operands: list[Ir] = []
        for argument in arguments:
            assert isinstance(scheme, TFun)
            t, scheme = scheme.argument, scheme.result
            if isinstance(t, TRecord):
                operands.extend(body.code(v) for v in body.components(argument, len(t.fields)))
            else:
                operands.append(body.code(argument))
        return operands

    # --- functions of colour sets --------------------------------------------------------------

    def _colset(
        self,
        body: Body,
        function: BuiltinFunction,
        arguments: tuple[Val, ...],
        result: Type,
        at: Span,
    ) -> Val:
        colset = function.node.colset
        assert colset is not None
        name = function.node.name.removeprefix("Colset.")
        types = body.program.types
        table = types.colset(colset)
        t = types.lower(result, at)
        if name in colset_functions.LISTED and not types.is_small(table) and name != "base":
            return colset_functions.ColsetFunctions(body, colset, at).listed(name, arguments)
        if name == "read":
            text, position = (body.code(v) for v in body.components(arguments[0], 2))
            local = body.local("read", t)
            body.emit(ir.Declare(local))
            body.emit(ir.Fill(local, "input", table, (text, position)))
            return ir.Use(local)
        if name in ("lt", "cmp"):
            a, b = (
                body.addressable(body.code(v), "side") for v in body.components(arguments[0], 2)
            )
            if name == "cmp" and a.type.rep is Rep.REAL:
                return ir.Op("Real.compare", (a, b), t)
            return ir.Op(f"Colset.{name}", (a, b), t, table)
        if name in ("mkstr", "legal", "ord"):
            operand = body.addressable(body.code(arguments[0]), "value")
            return ir.Op(f"Colset.{name}", (operand,), t, table)
        if name == "size":
            return ir.Op("Colset.size", (), t, table)
        if name == "all":
            types.plain(t)
            return ir.Op("Colset.all", (), t, table)
        if name == "base":
            return colset_functions.base_value(body, colset, at)
        if name == "timed.base":
            value = colset_functions.base_value(body, colset, at)
            return ir.MakeStruct(
                t, (("value", value), ("stamp", ir.Now(clock.clock(self._real_time))))
            )
        if name in ("col", "ran"):
            local = body.local(name, t)
            operands = (body.code(arguments[0]),) if name == "col" else ()
            body.emit(ir.Declare(local))
            body.emit(ir.Fill(local, name, table, operands))
            return ir.Use(local)
        if name == "mult":
            return _combinations(body, arguments[0], t, colset.resolved.labels)
        if name.startswith("set_"):
            record, value = (body.code(v) for v in arguments)
            definition = types.definition(t)
            assert isinstance(definition, ir.StructDef)
            record = body.atomic(record, "record")
            label = name.removeprefix("set_")
            own = colset.resolved
            labels = own.labels or tuple(str(i) for i in range(1, len(own.components) + 1))
            component = own.components[labels.index(label)]
            assert component is not None
            table = types.colset(component)
            if types.is_restricted(table):
                value = body.atomic(value, "component")
                legal = ir.Op("Colset.legal", (value,), ir.BOOL, table)
                body.emit(ir.If(legal, (), (ir.Raise("CPN'Error"),)))
            fields = tuple(
                (x, value if x == label else ir.Member(record, x, part))
                for x, part in definition.fields
            )
            return ir.MakeStruct(t, fields)
        written = colset_functions.ColsetFunctions(body, colset, at).apply(name, arguments)
        if written is not None:
            return written
        if name.startswith("of_"):
            value = body.atomic(body.code(arguments[0]), "value")
            made = ir.IsTag(value, colset.names.index(name.removeprefix("of_")))
            if not types.is_restricted(table):
                return made
            value = body.addressable(value, "value")
            legal = ir.Op("Colset.legal", (value,), ir.BOOL, table)
            return ir.Op("andalso", (made, legal), ir.BOOL)
        raise UnsupportedError(
            UNSUPPORTED_BUILTIN, f"`{colset.name}.{name}` is not supported in compiled code", at
        )


def _combinations(body: Body, multisets: Val, t: IrType, declared: tuple[str, ...]) -> Ir:
    """All combinations of the elements of multi-sets, a tuple of them as declared, the last component fastest.

    `declared`: the labels of a record; none for a product.
    """
    element = body.element(t)
    definition = body.program.types.definition(element)
    assert isinstance(definition, ir.StructDef)
    order = list(declared) or [label for label, _ in definition.fields]
    parts = body.components(multisets, len(order))
    lists = {
        label: body.atomic(body.code(part), "items")
        for label, part in zip(order, parts, strict=True)
    }

    def combine(labels: list[str], chosen: dict[str, Ir], keep: Callable[[Ir], None]) -> None:
        if not labels:
            fields = tuple((label, chosen[label]) for label, _ in definition.fields)
            keep(ir.MakeStruct(element, fields))
            return
        label, *rest = labels
        higher_order.for_each(
            body, lists[label], lambda x: combine(rest, {**chosen, label: x}, keep)
        )

    return higher_order.collect(body, t, lambda keep: combine(order, {}, keep))


# --- functions with a few lines of their own ---------------------------------------------------


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
    from pn2code.lowering.expressions.values import ConstructorFunction, Partial

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


_SPECIAL: dict[str, Callable[[Body, tuple[Val, ...], Type, Span], Val]] = {
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
