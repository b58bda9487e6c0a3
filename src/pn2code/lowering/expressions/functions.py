"""The functions and values of a net's declarations, made into C functions and constants as inscriptions ask for them.

A function is compiled once for each choice of its types and of the functions that are passed to it. The ML text

    fun twice f x = f (f x);   twice (fn y => y + k) 3

gives `twice/1 (cx, k, x)`: what the passed function captures (`k`) is a parameter.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import TYPE_CHECKING

from pn2code.diagnostics import Origin, Span
from pn2code.ir import nodes as ir
from pn2code.ir.calls import order_functions
from pn2code.ir.nodes import Ir, Local, Rep
from pn2code.lowering.codes import UNSUPPORTED_EXPRESSION, UnsupportedError
from pn2code.lowering.expressions.closures import FunctionValues, is_intricate
from pn2code.lowering.expressions.exceptions import Exceptions
from pn2code.lowering.expressions.parameters import (
    hint_of,
    is_split,
    parameter_names,
    parameters_of,
    split_parameters,
)
from pn2code.lowering.expressions.reaching import Reaching, nodes
from pn2code.lowering.expressions.type_terms import has_function as type_has_function
from pn2code.lowering.expressions.type_terms import substitute
from pn2code.lowering.expressions.types import Types
from pn2code.lowering.expressions.values import (
    Binding,
    BuiltinFunction,
    Captured,
    NamedFunction,
    Polymorphic,
    RecordVal,
    Reference,
    TypeEnv,
    Val,
    capture,
    declared,
    has_function,
    is_static,
    pattern_symbols,
    type_key,
)
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import TCon, TRecord, Type

if TYPE_CHECKING:
    from pn2code.lowering.expressions.block import Block
    from pn2code.lowering.expressions.body import Body
    from pn2code.lowering.expressions.builtins import Builtins

_MAX_COPIES = 60
"""Of a function for different functions that are passed to it; from then on they are passed as values."""


class Program(Reaching):
    """All that is asked for of the declarations. One per net.

    Args:
        new_body: makes the body of a function with these types for its type variables, and its key (`Body` itself).
    """

    def __init__(
        self,
        program: core.Program,
        types: Types,
        builtins: Builtins,
        real_time: bool,
        new_body: Callable[[Program, TypeEnv, str], Body],
    ) -> None:
        super().__init__(program, builtins, real_time)
        self.types = types
        self._new_body = new_body
        self.position = Origin("")
        self.lists_are_functions = False
        self._functions: dict[Hashable, str] = {}
        self._made: dict[str, ir.Function] = {}
        self._pending: list[tuple[str, NamedFunction, tuple[Binding, ...], list[Local]]] = []
        self._counters: dict[str, int] = {}
        self._globals: dict[Hashable, Reference | ir.GlobalUse] = {}
        self._setups: dict[tuple[int, Hashable], tuple[ir.Global, ...]] = {}
        self._global_names: set[str] = set()
        self.handles = any(
            isinstance(node, core.Handle)
            for dec in program.declarations
            for e in declared(dec)
            for node in nodes(e)
        )
        self.function_values = FunctionValues(self)
        self.exceptions = Exceptions(self)

    # --- top-level names -----------------------------------------------------------------------

    def global_value(
        self, body: Body, symbol: Symbol, inst: Mapping[int, Type], at: Span
    ) -> Binding:
        """What a top-level name stands for."""
        if symbol.uid in self._primitives:
            primitive = self._primitives[symbol.uid]
            return BuiltinFunction(primitive, primitive.type)
        if symbol.uid in self._groups:
            return NamedFunction(symbol, self._groups[symbol.uid], {}, dict(inst))
        if symbol.uid not in self._values:
            raise UnsupportedError(
                UNSUPPORTED_EXPRESSION, f"`{symbol.name}` has no value that the compiler knows", at
            )
        position, dec = self._values[symbol.uid]
        t = substitute(symbol.type, inst)
        if type_has_function(t) and self._is_static(dec.value):
            return self._static_global(body, symbol, dec, inst)
        key: Hashable = (symbol.uid, type_key(inst))
        if key not in self._globals:
            self._make_globals(position, dec, inst)
        return self._globals[key]

    @staticmethod
    def _static_global(
        body: Body, symbol: Symbol, dec: core.ValBind, inst: Mapping[int, Type]
    ) -> Binding:
        """`val f = fn x => ...`: looked at anew for each use."""
        outer, body.types = body.types, inst
        try:
            value = body.exp(dec.value, {})
            if isinstance(dec.pattern, core.PVar):
                return value
            return body.bind_pattern(dec.pattern, value)[symbol.uid]
        finally:
            body.types = outer

    def body(self) -> Body:
        """A body of a function that no ML function is."""
        return self._new_body(self, {}, "")

    def _make_globals(self, position: int, dec: core.ValBind, inst: Mapping[int, Type]) -> None:
        value = dec.value
        is_reference = False
        if (
            isinstance(dec.pattern, core.PVar)
            and isinstance(value, core.Apply)
            and _is_builtin(value.function, "Ref.ref")
        ):
            value, is_reference = value.argument, True
        body = self._new_body(self, inst, "")
        made: list[ir.Global] = []
        names: dict[int, str] = {}
        for symbol in pattern_symbols(dec.pattern):
            t = substitute(symbol.type, inst)
            if is_reference:
                assert isinstance(t, TCon)
                t = t.args[0]
            lowered = self.types.lower(t, dec.span)
            name = self._fresh_global(symbol.name)
            names[symbol.uid] = name
            table = self.types.plain(lowered)
            key: Hashable = (symbol.uid, type_key(inst))
            if is_reference:
                self._globals[key] = Reference(name, lowered, table)
            else:
                self._globals[key] = ir.GlobalUse(name, lowered)
            text = dec.span.text
            source = text if text.startswith("val ") or is_reference else f"val {text}"
            made.append(
                ir.Global(
                    name, symbol.name, lowered, table, is_reference, (), source, dec.span.origin
                )
            )
        code = body.exp(value, {})
        if isinstance(dec.pattern, core.PVar):
            body.emit(ir.SetGlobal(names[dec.pattern.symbol.uid], body.code(code)))
        else:
            env = body.bind_pattern(dec.pattern, code)
            if isinstance(dec.pattern, core.PWild):
                body.discard(code)
            for symbol in pattern_symbols(dec.pattern):
                stored = env[symbol.uid]
                assert not isinstance(stored, Polymorphic)
                body.emit(ir.SetGlobal(names[symbol.uid], body.code(stored)))
        if not made and body.statements:
            name = self._fresh_global("effect")
            made.append(
                ir.Global(
                    name, "effect", ir.UNIT, self.types.plain(ir.UNIT), False, (),
                    dec.span.text, dec.span.origin,
                )
            )  # fmt: skip
        if made:
            first = made[0]
            made[0] = ir.Global(
                first.name, first.hint, first.type, first.table, is_reference,
                tuple(body.statements), first.source, first.origin,
            )  # fmt: skip
        self._setups[(position, type_key(inst))] = tuple(made)

    def _fresh_global(self, name: str) -> str:
        fresh, n = name, 2
        while fresh in self._global_names:
            fresh, n = f"{name} {n}", n + 1
        self._global_names.add(fresh)
        return fresh

    def globals(self) -> tuple[ir.Global, ...]:
        """The values asked for, in order of declaration."""
        ordered = sorted(self._setups.items(), key=lambda item: (item[0][0], str(item[0][1])))
        return tuple(g for _, group in ordered for g in group)

    # --- functions -----------------------------------------------------------------------------

    @staticmethod
    def group_env(function: NamedFunction) -> Mapping[int, Binding]:
        """What the body of a function sees outside its parameters: its surroundings and its group."""
        siblings = {
            s.uid: NamedFunction(s, function.group, function.env, function.types)
            for s, _ in function.group.bindings
        }
        return {**function.env, **siblings}

    def call(
        self, body: Body, function: NamedFunction, arguments: tuple[Val, ...], at: Span
    ) -> Val:
        """A call of the C function for these arguments."""
        key, code = self.prepare_call(body, function, arguments, at)
        _, result = split_parameters(function.function)
        t = self.types.lower(substitute(result, function.types), at)
        call = ir.FunCall(key, code, t)
        impure = (
            self.is_impure(function.function)
            or any(map(self._is_impure_value, arguments))
            or any(self.types.holds_function(c.type) for c in code)
        )
        if impure or t.rep is Rep.UNIT:
            return body.spill(call, function.symbol.name)
        return call

    def prepare_call(
        self, body: Block, function: NamedFunction, arguments: tuple[Val, ...], at: Span
    ) -> tuple[str, tuple[Ir, ...]]:
        """The key of the C function and the C arguments."""
        parts = [capture(function)]
        is_crowded = self._counters.get(function.symbol.name, 0) >= _MAX_COPIES
        for slot in self._slots(body, function, arguments):
            part = capture(slot)
            if is_intricate(part.key) or (is_crowded and is_static(slot)):
                part = capture(body.code(slot, at))
            parts.append(part)
        identity: Hashable = tuple(part.key for part in parts)
        code = tuple(c for part in parts for c in part.code)
        if identity not in self._functions:
            number = self._counters.get(function.symbol.name, 0) + 1
            self._counters[function.symbol.name] = number
            key = f"{function.symbol.name}/{number}"
            self._functions[identity] = key
            self._enter(key, function, parts)
        return self._functions[identity], code

    def _slots(self, body: Block, function: NamedFunction, arguments: tuple[Val, ...]) -> list[Val]:
        """The arguments as they are passed: tuples that are taken apart by the patterns, component by component."""
        slots: list[Val] = []
        for (rules, t), argument in zip(parameters_of(function), arguments, strict=True):
            if isinstance(argument, RecordVal):
                if is_split(rules, t):
                    assert isinstance(t, TRecord)
                    slots.extend(self._slot(body, argument.fields[x]) for x, _ in t.fields)
                    continue
            elif is_split(rules, t) and not is_static(argument):
                assert isinstance(t, TRecord)
                whole = body.store_in_locals(argument, function.symbol.name)
                t = substitute(t, function.types)
                assert isinstance(t, TRecord)
                slots.extend(body.select(whole, label, part) for label, part in t.fields)
                continue
            slots.append(self._slot(body, argument))
        return slots

    @staticmethod
    def _slot(body: Block, value: Val) -> Val:
        return (
            body.code(value) if isinstance(value, RecordVal) and not has_function(value) else value
        )

    def _enter(self, key: str, function: NamedFunction, parts: list[Captured]) -> None:
        """Note a function to be made: with parameters in the place of what was captured."""
        parameters: list[Local] = []
        rebuilt: list[Binding] = []
        names = parameter_names(function)
        counter = 0
        for i, part in enumerate(parts):
            hint = names[i - 1] if 0 < i <= len(names) else "captured"
            fresh = []
            for c in part.code:
                counter += 1
                # An argument has the parameter's name, what a function captured the name it has where it is captured.
                is_argument = i > 0 and isinstance(part.key, tuple) and part.key[0] == "code"
                name = hint if is_argument else hint_of(c) or "captured"
                fresh.append(Local(-counter, name, c.type))
            parameters.extend(fresh)
            rebuilt.append(part.rebuild([ir.Use(p) for p in fresh]))
        self._pending.append((key, function, tuple(rebuilt), parameters))

    def make_pending(self) -> None:
        """Make all functions that are asked for, and those that they ask for."""
        for position, dec in enumerate(self.core.declarations):
            # What a declaration does is done, whether its value is used or not.
            is_made = (position, type_key({})) in self._setups
            if isinstance(dec, core.ValBind) and self.is_impure(dec.value) and not is_made:
                self.position = dec.span.origin
                self._make_globals(position, dec, {})
        while self._pending or self.function_values.work():
            if self._pending:
                key, function, rebuilt, parameters = self._pending.pop()
                self._made[key] = self._make(key, function, rebuilt, parameters)

    def finish(self) -> tuple[ir.Function, ...]:
        """All functions, each behind those that it calls; nothing is asked for after this."""
        self.make_pending()
        self._made.update(self.function_values.finish())
        self._made.update(self.exceptions.finish())
        self.types.close()
        return order_functions(self._made)

    def add_function(
        self,
        hint: str,
        parameters: tuple[Local, ...],
        result: ir.IrType,
        body: tuple[ir.Stmt, ...],
        span: Span,
    ) -> str:
        """A function that no declaration has; gives its key. Equal ones are one."""
        for key, known in self._made.items():
            if (known.hint, known.parameters, known.body) == (hint, parameters, body):
                return key
        key = f"{hint} {len(self._made) + 1}"
        self._made[key] = ir.Function(
            key, hint, parameters, result, body, False, False, span.text, span.origin
        )
        return key

    def _make(
        self,
        key: str,
        function: NamedFunction,
        rebuilt: tuple[Binding, ...],
        parameters: list[Local],
    ) -> ir.Function:
        head, *slots = rebuilt
        assert isinstance(head, NamedFunction)
        self.position = function.function.span.origin
        body = self._new_body(self, head.types, key)
        env = dict(self.group_env(head))
        at = 0
        remaining: core.Exp = function.function
        for rules, t in parameters_of(function):
            if is_split(rules, t):
                assert isinstance(t, TRecord)
                n = len(t.fields)
                fields = dict(
                    zip((label for label, _ in t.fields), slots[at : at + n], strict=True)
                )
                # The slots of parameters are values, not declared functions of many types.
                argument: Val = RecordVal(fields, substitute(t, head.types))  # type: ignore[arg-type]
                at += n
            else:
                argument = slots[at]  # type: ignore[assignment]  # likewise
                at += 1
            assert isinstance(remaining, core.Lambda)
            if len(remaining.rules) > 1:
                body.tail_rules(remaining.rules, argument, env)
                break
            env = dict(body.bind_pattern(remaining.rules[0].pattern, argument, env, "Match"))
            remaining = remaining.rules[0].body
        else:
            body.tail(remaining, env)
        _, result = split_parameters(function.function)
        span = function.group.span if len(function.group.bindings) == 1 else function.function.span
        return ir.Function(
            key, function.symbol.name, tuple(parameters),
            self.types.lower(substitute(result, head.types)), tuple(body.statements),
            body.has_self_call, False, span.text, span.origin,
        )  # fmt: skip


def _is_builtin(e: core.Exp, name: str) -> bool:
    return isinstance(e, core.Builtin) and e.name == name
