"""Core expressions -> IR: the body of one function, guard, inscription or action.

`Body.exp` gives the value of an expression and appends to the present block the statements that must run
before it. Reading and changing references, drawing random numbers and the like happen in these statements, so
their order is that of CPN ML; what is pure stays an expression, so that simple ML becomes simple C.
"""

from __future__ import annotations

from functools import partial

from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType, Rep
from pn2code.lowering.expressions.block import UNIT_VALUE
from pn2code.lowering.expressions.branching import Branching
from pn2code.lowering.expressions.matching import is_irrefutable
from pn2code.lowering.expressions.parameters import split_parameters
from pn2code.lowering.expressions.shapes import escapes, is_recursive_group
from pn2code.lowering.expressions.type_terms import has_function as type_has_function
from pn2code.lowering.expressions.type_terms import substitute
from pn2code.lowering.expressions.values import (
    Binding,
    BuiltinFunction,
    Closure,
    ConstructorFunction,
    Env,
    LocalReference,
    NamedFunction,
    Partial,
    Polymorphic,
    RecordVal,
    Val,
    function_type,
    is_atomic,
    is_static,
)
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import INT, TFun, Type

_MAX_INLINE = 60
"""Functions in each other's places."""
_MAX_INLINES = 1000
"""Functions put in place in one C function."""
_ITEMS_AT_ONCE = 50
"""Items of a list that one C expression puts together."""
_UNIT = UNIT_VALUE


class Body(Branching):
    """Lowers expressions into a growing list of statements."""

    # --- expressions ---------------------------------------------------------------------------

    def exp(self, e: core.Exp, env: Env) -> Val:
        """The value of an expression."""
        match e:
            case core.Lit(value=int() as value) if abs(value) >= 2**63 and (
                self.representation(e.type) == ir.INT
            ):
                text = f"the integer {value} is beyond 64 bits"
                self.emit(ir.Do(ir.Op("prim.stop", (ir.Const(text, ir.STRING),), ir.UNIT)))
                return self.zero(ir.INT)
            case core.Lit():
                return self.literal(e.value, e.type, e.span)
            case core.Var():
                return self._variable(e, env)
            case core.Builtin():
                return self._builtin(e)
            case core.Con():
                return self._constructor(e)
            case core.Apply():
                function, argument = self.in_order(
                    [lambda: self.exp(e.function, env), lambda: self.exp(e.argument, env)]
                )
                return self.apply(function, argument, self.type_of(e.type), e.span)
            case core.Lambda():
                return Closure(e, env, self.types)
            case core.RecordExp(fields=()):
                return _UNIT
            case core.RecordExp():
                values = self.in_order(partial(self.exp, part, env) for _, part in e.fields)
                fields = dict(zip((label for label, _ in e.fields), values, strict=True))
                return RecordVal(fields, self.type_of(e.type))
            case core.Select():
                return self._select(e, env)
            case core.ListExp():
                return self._list(e, env)
            case core.If() | core.Case() | core.Handle():
                return self.branching(e, env)
            case core.Let():
                return self.exp(e.body, self.declare(e, env))
            case core.Sequence():
                for item in e.items[:-1]:
                    self.effect(item, env)
                return self.exp(e.items[-1], env)
            case core.While():
                return self._while(e, env)
            case core.Raise():
                self.raise_exception(e.exception, env)
                return self.zero(self.representation(e.type))

    def effect(self, e: core.Exp, env: Env) -> None:
        """Evaluate only for what it does."""
        value = self.exp(e, env)
        if is_static(value):
            self.discard(value)
            return
        code = self.code(value)
        if not is_atomic(code):
            self.emit(ir.Do(code))

    def _variable(self, e: core.Var, env: Env) -> Val:
        inst = {i: self.type_of(t) for i, t in enumerate(e.inst, e.symbol.first_generic)}
        value: Binding | None = env.get(e.symbol.uid)
        if value is None:
            value = self.program.global_value(self, e.symbol, inst, e.span)
        if isinstance(value, NamedFunction) and inst and value.symbol == e.symbol:
            return NamedFunction(value.symbol, value.group, value.env, {**value.types, **inst})
        if isinstance(value, Polymorphic):
            outer, self.types = self.types, {**value.types, **inst}
            try:
                return self.exp(value.value, value.env)
            finally:
                self.types = outer
        return value

    def _builtin(self, e: core.Builtin) -> Val:
        t = self.type_of(e.type)
        value = BuiltinFunction(e, t)
        if isinstance(t, TFun):
            return value
        return self.program.builtins.apply(self, value, (), t, e.span)

    def _constructor(self, e: core.Con) -> Val:
        t = self.type_of(e.type)
        if e.constructor.has_argument:
            return ConstructorFunction(e.constructor, t)
        if e.constructor.data_type == "exn":
            return ir.MakeUnion(self.tag_of(e.constructor, None), None, self.representation(t))
        return self.constant(e.constructor, self.representation(t))

    def constant(self, constructor: core.Constructor, t: IrType) -> Ir:
        """A constructor without argument."""
        if t.rep is Rep.BOOL:
            return ir.Const(constructor.tag == 1, t)
        if t.rep is Rep.LIST:
            return ir.Op("list.nil", (), t)
        if t.rep is Rep.ENUM:
            return ir.EnumValue(constructor.tag, t)
        return ir.MakeUnion(constructor.tag, None, t)

    def _select(self, e: core.Select, env: Env) -> Val:
        record = self.exp(e.record, env)
        if isinstance(record, RecordVal):
            for label, part in record.fields.items():
                if label != e.label:
                    self.discard(part)
        return self.select(record, e.label, e.type)

    def _list(self, e: core.ListExp, env: Env) -> Ir:
        t = self.representation(e.type)
        values = self.in_order(partial(self.exp, item, env) for item in e.items)
        items = [self.addressable(self.code(value, e.span), "item") for value in values]
        result: Ir = ir.Op("list.nil", (), t)
        for n, item in enumerate(reversed(items), 1):
            result = ir.Op("list.cons", (item, result), t, self.program.types.plain(t))
            if n % _ITEMS_AT_ONCE == 0:
                result = self.spill(result, "rest")
        return result

    # --- application ---------------------------------------------------------------------------

    def apply(self, function: Val, argument: Val, result: Type, at: Span) -> Val:
        """Apply a function that is known at compile time."""
        match function:
            case Closure():
                return self._inline(function, argument, at)
            case ConstructorFunction():
                return self._construct(function, argument, result)
            case NamedFunction() | BuiltinFunction():
                return self._saturate(function, (argument,), result, at)
            case Partial():
                arguments = (*function.arguments, argument)
                return self._saturate(function.function, arguments, result, at)
        return self.program.function_values.apply(self, self.code(function, at), argument, at)

    def _construct(self, function: ConstructorFunction, argument: Val, result: Type) -> Ir:
        t = self.representation(result)
        code = self.code(argument)
        if t.rep is Rep.LIST:
            pair = argument
            head = self.code(self.select(pair, "1", INT)) if isinstance(pair, RecordVal) else None
            if head is None:
                pair = self.atomic(code, "pair")
                head = ir.Member(pair, "1", self.element(t))
                rest: Ir = ir.Member(pair, "2", t)
            else:
                assert isinstance(pair, RecordVal)
                rest = self.code(pair.fields["2"])
            head = self.addressable(head, "item")
            return ir.Op("list.cons", (head, rest), t, self.program.types.plain(t))
        if t.rep is not Rep.UNION:
            return code  # an index is its number
        return ir.MakeUnion(self.tag_of(function.constructor, code.type), code, t)

    def _inline(self, function: Closure, argument: Val, at: Span) -> Val:
        self._inlines += 1
        if len(self._inlined) > _MAX_INLINE or self._inlines > _MAX_INLINES:
            # Too many functions in each other's places: a call of a value ends that.
            code = self.code(function, at)
            return self.program.function_values.apply(self, code, argument, at)
        self._inlined.append(id(function.function))
        outer, self.types = self.types, function.types
        try:
            return self._rules(function.function, argument, function.env)
        finally:
            self.types = outer
            self._inlined.pop()

    def _rules(self, function: core.Lambda, argument: Val, env: Env) -> Val:
        rule = function.rules[0]
        if len(function.rules) == 1 and is_irrefutable(rule.pattern):
            inner = self.bind_all(self.match_stored(rule.pattern, argument), env)
            return self.exp(rule.body, inner)
        result = self.type_of(rule.body.type)
        return self.choose(function.rules, argument, env, result, "Match")

    def _saturate(
        self,
        function: NamedFunction | BuiltinFunction,
        arguments: tuple[Val, ...],
        result: Type,
        at: Span,
    ) -> Val:
        if isinstance(function, BuiltinFunction):
            if len(arguments) < self.program.builtins.arity(function):
                return Partial(function, arguments)
            return self.program.builtins.apply(self, function, arguments, result, at)
        parameters, body = split_parameters(function.function)
        if len(arguments) < len(parameters):
            return Partial(function, arguments)
        is_recursive = id(function.group) in self._inlined or is_recursive_group(function.group)
        if type_has_function(substitute(body, function.types)) and not is_recursive:
            return self._unfold(function, arguments, at)
        return self.program.call(self, function, arguments, at)

    def _unfold(self, function: NamedFunction, arguments: tuple[Val, ...], at: Span) -> Val:
        """A function whose result is or contains a function is put in place."""
        self._inlined.append(id(function.group))
        try:
            t = function_type(function)
            value: Val = Closure(
                function.function, self.program.group_env(function), function.types
            )
            for argument in arguments:
                value = self.apply(value, argument, t.result, at)
                if isinstance(t.result, TFun):
                    t = t.result
            return value
        finally:
            self._inlined.pop()

    # --- declarations --------------------------------------------------------------------------

    def declare(self, let: core.Let, env: Env) -> Env:
        """See `Branching`."""
        for dec in let.declarations:
            match dec:
                case core.ValBind(pattern=core.PVar(symbol=symbol)) if symbol.generics:
                    env = {**env, symbol.uid: Polymorphic(dec.value, env, self.types)}
                case core.ValBind(
                    pattern=core.PVar(symbol=symbol),
                    value=core.Apply(function=core.Builtin(name="Ref.ref"), argument=first),
                ) if not escapes(let, symbol.uid):
                    code = self.ir(first, env)
                    local = self.local(symbol.name, code.type)
                    self.emit(ir.Let(local, code, mutable=True))
                    env = {**env, symbol.uid: LocalReference(local)}
                case core.ValBind():
                    value = self.exp(dec.value, env)
                    env = self.bind_all(self.match_stored(dec.pattern, value), env, "Bind")
                case core.RecBind():
                    env = {
                        **env,
                        **{s.uid: NamedFunction(s, dec, env, self.types) for s, _ in dec.bindings},
                    }
                case core.ExceptionDec() | core.DatatypeDec():
                    pass
        return env

    # --- the rest ------------------------------------------------------------------------------

    def _while(self, e: core.While, env: Env) -> Ir:
        with self.block() as setup:
            condition = self.ir(e.condition, env)
        with self.block() as body:
            self.effect(e.body, env)
        self.emit(ir.While(tuple(setup), condition, tuple(body)))
        return _UNIT
