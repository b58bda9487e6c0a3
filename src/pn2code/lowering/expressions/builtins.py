"""Built-in functions applied: most become an `Op` of the same name, some a few lines of IR.

What an `Op` looks like in C is the business of `ir.operations`; a built-in function is supported exactly if
it is in `DIRECT` or has a method here or in `higher_order`.
"""

from __future__ import annotations

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
    colset_values,
    higher_order,
)
from pn2code.lowering.expressions.direct import DIRECT, SAME
from pn2code.lowering.expressions.purity import is_impure_builtin
from pn2code.lowering.expressions.special import SPECIAL
from pn2code.lowering.expressions.values import BuiltinFunction, Polymorphic, Val
from pn2code.lowering.prelude import representation
from pn2code.ml.core.types import TFun, TRecord, Type
from pn2code.ml.library.builtins import BUILTINS

if TYPE_CHECKING:
    from pn2code.lowering.expressions.body import Body


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
            or name in SPECIAL
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
        special = SPECIAL.get(name) or higher_order.FUNCTIONS.get(name)
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
            return colset_values.base_value(body, colset, at)
        if name == "timed.base":
            value = colset_values.base_value(body, colset, at)
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
    definition = body.program.types.definition(body.element(t))
    assert isinstance(definition, ir.StructDef)
    order = list(declared) or [label for label, _ in definition.fields]
    parts = body.components(multisets, len(order))
    lists = {
        label: body.atomic(body.code(part), "items")
        for label, part in zip(order, parts, strict=True)
    }
    return higher_order.combinations(body, lists, t)
