"""Core expressions -> IR: the body of one function, guard, inscription or action.

`Body.exp` gives the value of an expression and appends to the present block the statements that must run
before it. Reading and changing references, drawing random numbers and the like happen in these statements, so
their order is that of CPN ML; what is pure stays an expression, so that simple ML becomes simple C.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from pn2code.diagnostics import Span
from pn2code.lowering import ir
from pn2code.lowering.block import UNIT_VALUE, Block
from pn2code.lowering.codes import (
    UNSUPPORTED_EXCEPTION,
    UNSUPPORTED_FUNCTION_VALUE,
    UnsupportedError,
)
from pn2code.lowering.functions import split_parameters
from pn2code.lowering.ir import Ir, IrType, Local, Rep
from pn2code.lowering.matching import (
    Match,
    conjunction,
    is_irrefutable,
    negation,
)
from pn2code.lowering.shapes import covers, handled_name, is_simple, nodes, size
from pn2code.lowering.types import has_function as type_has_function
from pn2code.lowering.types import substitute
from pn2code.lowering.values import (
    Binding,
    BuiltinFunction,
    Closure,
    ConstructorFunction,
    Env,
    NamedFunction,
    Partial,
    Polymorphic,
    RecordVal,
    Val,
    is_atomic,
    is_static,
)
from pn2code.ml import core
from pn2code.ml.types import INT, TFun, Type

_MAX_INLINE = 60
_UNIT = UNIT_VALUE


@dataclass(frozen=True, slots=True)
class Ways:
    """What becomes of rules: `finish` of the body of the one that fits; `give_up` after an exception where
    none does."""

    finish: Callable[[core.Exp, Env], None]
    give_up: Callable[[], None]


class Body(Block):
    """Lowers expressions into a growing list of statements."""

    # --- expressions ---------------------------------------------------------------------------

    def ir(self, e: core.Exp, env: Env) -> Ir:
        """The expression as C code."""
        return self.code(self.exp(e, env), e.span)

    def exp(self, e: core.Exp, env: Env) -> Val:
        """The value of an expression."""
        match e:
            case core.Lit():
                return self.literal(e.value, e.type, e.span)
            case core.Var():
                return self._variable(e, env)
            case core.Builtin():
                return self._builtin(e)
            case core.Con():
                return self._constructor(e)
            case core.Apply():
                function = self.exp(e.function, env)
                argument = self.exp(e.argument, env)
                return self.apply(function, argument, self.type_of(e.type), e.span)
            case core.Lambda():
                return Closure(e, env, self.types)
            case core.RecordExp(fields=()):
                return _UNIT
            case core.RecordExp():
                fields = {label: self.exp(part, env) for label, part in e.fields}
                return RecordVal(fields, self.type_of(e.type))
            case core.Select():
                return self._select(e, env)
            case core.ListExp():
                return self._list(e, env)
            case core.If() | core.Case() | core.Handle():
                return self._branching(e, env)
            case core.Let():
                return self.exp(e.body, self.declare(e.declarations, env))
            case core.Sequence():
                for item in e.items[:-1]:
                    self.effect(item, env)
                return self.exp(e.items[-1], env)
            case core.While():
                return self._while(e, env)
            case core.Raise():
                self._raise(e.exception)
                return self.zero(self.representation(e.type))

    def effect(self, e: core.Exp, env: Env) -> None:
        """Evaluate only for what it does."""
        value = self.exp(e, env)
        if not is_static(value):
            code = self.code(value)
            if not is_atomic(code):
                self.emit(ir.Do(code))

    def _variable(self, e: core.Var, env: Env) -> Val:
        inst = {i: self.type_of(t) for i, t in enumerate(e.inst)}
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
        if e.constructor.data_type == "exn":
            raise UnsupportedError(
                UNSUPPORTED_EXCEPTION, "an exception as a value is not supported", e.span
            )
        if e.constructor.has_argument:
            return ConstructorFunction(e.constructor, t)
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
        return self.select(record, e.label, e.type)

    def _list(self, e: core.ListExp, env: Env) -> Ir:
        t = self.representation(e.type)
        items = [self.addressable(self.ir(item, env), "item") for item in e.items]
        result: Ir = ir.Op("list.nil", (), t)
        for item in reversed(items):
            result = ir.Op("list.cons", (item, result), t, self.program.types.plain(t))
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
        raise UnsupportedError(
            UNSUPPORTED_FUNCTION_VALUE,
            "which function is called here is not known at compile time",
            at,
            hint="call the function directly, or pass it as an argument",
        )

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
        return ir.MakeUnion(function.constructor.tag, code, t)

    def _inline(self, function: Closure, argument: Val, at: Span) -> Val:
        if len(self._inlined) > _MAX_INLINE:
            raise UnsupportedError(
                UNSUPPORTED_FUNCTION_VALUE, "functions are nested too deeply to be followed", at
            )
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
            inner = self._bind_all(self._match(rule.pattern, argument), env)
            return self.exp(rule.body, inner)
        result = self.type_of(rule.body.type)
        if type_has_function(result):
            raise UnsupportedError(
                UNSUPPORTED_FUNCTION_VALUE,
                "which function is returned here depends on the argument",
                function.span,
                hint="take all arguments at once: `fun f 0 x = ... | f n x = ...`",
            )
        return self._choose(function.rules, argument, env, result, "Match")

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
        if type_has_function(substitute(body, function.types)):
            return self._unfold(function, arguments, at)
        return self.program.call(self, function, arguments, at)

    def _unfold(self, function: NamedFunction, arguments: tuple[Val, ...], at: Span) -> Val:
        """A function whose result is or contains a function is put in place."""
        if id(function.group) in self._inlined:
            raise UnsupportedError(
                UNSUPPORTED_FUNCTION_VALUE,
                f"`{function.symbol.name}` is recursive and returns a function",
                at,
            )
        self._inlined.append(id(function.group))
        try:
            value: Val = Closure(
                function.function, self.program.group_env(function), function.types
            )
            for argument in arguments:
                assert isinstance(value, Closure)
                value = self._inline(value, argument, at)
            return value
        finally:
            self._inlined.pop()

    # --- declarations --------------------------------------------------------------------------

    def declare(self, declarations: tuple[core.Dec, ...], env: Env) -> Env:
        """The environment after local declarations."""
        for dec in declarations:
            match dec:
                case core.ValBind(pattern=core.PVar(symbol=symbol)) if symbol.generics:
                    env = {**env, symbol.uid: Polymorphic(dec.value, env, self.types)}
                case core.ValBind():
                    value = self.exp(dec.value, env)
                    env = self._bind_all(self._match(dec.pattern, value), env, "Bind")
                case core.RecBind():
                    env = {
                        **env,
                        **{s.uid: NamedFunction(s, dec, env, self.types) for s, _ in dec.bindings},
                    }
                case core.ExceptionDec() | core.DatatypeDec():
                    pass
        return env

    def _match(self, pattern: core.Pat, value: Val) -> Match:
        if not isinstance(pattern, core.PVar | core.PWild):
            value = self.settle(value, "value")
        return self._matcher.match(pattern, value)

    def bind_pattern(self, pattern: core.Pat, value: Val, env: Env | None = None) -> Env:
        """The environment with the variables of a pattern; Bind is raised where it does not fit."""
        return self._bind_all(self._match(pattern, value), env or {}, "Bind")

    def match(self, pattern: core.Pat, value: Val) -> Match:
        """Match a value whose C parts are atomic."""
        return self._matcher.match(pattern, value)

    def _bind_all(self, match: Match, env: Env, exception: str = "") -> Env:
        """Bind the variables of a match; where it may fail, raise `exception` and bind harmless values."""
        condition = conjunction(match.conditions)
        bound: dict[int, Binding] = {}
        if condition is not None:
            condition = self.atomic(condition, "fits")
            with self.block() as otherwise:
                self.emit(ir.Raise(exception))
            self.emit(ir.If(negation(condition), tuple(otherwise), ()))
        for symbol, value in match.bindings:
            if condition is not None:
                code = self.code(value)
                value = ir.Select(condition, code, self.zero(code.type), code.type)
            bound[symbol.uid] = self.bind(symbol, value)
        return {**env, **bound}

    # --- branching -----------------------------------------------------------------------------

    def _branching(self, e: core.If | core.Case | core.Handle, env: Env) -> Val:
        if type_has_function(self.type_of(e.type)):
            return self._static_branch(e, env)
        if isinstance(e, core.If):
            simple = self._simple_if(e, env)
            if simple is not None:
                return simple
        rule = e.rules[0] if isinstance(e, core.Case) else None
        if isinstance(e, core.Case) and rule and len(e.rules) == 1 and is_irrefutable(rule.pattern):
            value = self.exp(e.scrutinee, env)
            return self.exp(rule.body, self._bind_all(self._match(rule.pattern, value), env))
        return self._into_temporary(e, env)

    def _into_temporary(self, e: core.Exp, env: Env) -> Ir:
        t = self.representation(e.type)
        if t.rep is Rep.UNIT:
            self.into(e, env, None)
            return _UNIT
        result = self.local("result", t)
        self.emit(ir.Declare(result))
        self.into(e, env, result)
        return ir.Use(result)

    def _static_branch(self, e: core.If | core.Case | core.Handle, env: Env) -> Val:
        """A choice among functions: only where the choice is known, or there is none."""
        if isinstance(e, core.If):
            condition = self.ir(e.condition, env)
            if isinstance(condition, ir.Const):
                return self.exp(e.then if condition.value else e.otherwise, env)
        if isinstance(e, core.Case) and len(e.rules) == 1:
            value = self.exp(e.scrutinee, env)
            rule = e.rules[0]
            return self.exp(
                rule.body, self._bind_all(self._match(rule.pattern, value), env, "Match")
            )
        raise UnsupportedError(
            UNSUPPORTED_FUNCTION_VALUE,
            "which function this is depends on a value",
            e.span,
            hint="choose between the results instead of between the functions",
        )

    def _simple_if(self, e: core.If, env: Env) -> Ir | None:
        """As a C expression, if both ways are simple."""
        if not (is_simple(e.then) and is_simple(e.otherwise)):
            return None
        condition = self.ir(e.condition, env)
        if isinstance(condition, ir.Const):
            return self.ir(e.then if condition.value else e.otherwise, env)
        with self.block() as first:
            then = self.ir(e.then, env)
        with self.block() as second:
            otherwise = self.ir(e.otherwise, env)
        if not first and not second:
            return self.choice(condition, then, otherwise)
        if then.type == ir.UNIT:
            self.emit(ir.If(condition, tuple(first), tuple(second)))
            return _UNIT
        result = self.local("result", then.type)
        self.emit(ir.Declare(result))
        first.append(ir.Assign(result, then))
        second.append(ir.Assign(result, otherwise))
        self.emit(ir.If(condition, tuple(first), tuple(second)))
        return ir.Use(result)

    @staticmethod
    def choice(condition: Ir, then: Ir, otherwise: Ir) -> Ir:
        """`if` as an expression."""
        if then.type == ir.UNIT:
            return _UNIT
        if isinstance(otherwise, ir.Const) and otherwise.value is False:
            return ir.Op("andalso", (condition, then), ir.BOOL)
        if isinstance(then, ir.Const) and then.value is True:
            return ir.Op("orelse", (condition, otherwise), ir.BOOL)
        return ir.Select(condition, then, otherwise, then.type)

    def into(self, e: core.Exp, env: Env, target: Local | None) -> None:
        """Evaluate into a local (None: a unit, nothing to keep)."""
        match e:
            case core.If() if not (is_simple(e.then) and is_simple(e.otherwise)):
                condition = self.ir(e.condition, env)
                with self.block() as then:
                    self.into(e.then, env, target)
                with self.block() as otherwise:
                    self.into(e.otherwise, env, target)
                self.emit(ir.If(condition, tuple(then), tuple(otherwise)))
            case core.Case():
                value = self.exp(e.scrutinee, env)
                self._chain(e.rules, value, env, "Match", self._filling(target))
            case core.Let():
                self.into(e.body, self.declare(e.declarations, env), target)
            case core.Sequence():
                for item in e.items[:-1]:
                    self.effect(item, env)
                self.into(e.items[-1], env, target)
            case core.Handle():
                self._handle(e, env, target)
            case _:
                self._store(self.exp(e, env), target)

    def _store(self, value: Val, target: Local | None) -> None:
        code = self.code(value)
        if target is not None:
            self.emit(ir.Assign(target, code))
        elif not is_atomic(code):
            self.emit(ir.Do(code))

    def _choose(
        self, rules: tuple[core.Rule, ...], value: Val, env: Env, result: Type, exception: str
    ) -> Ir:
        t = self.program.types.lower(result)
        target = None if t.rep is Rep.UNIT else self.local("result", t)
        if target is not None:
            self.emit(ir.Declare(target))
        self._chain(rules, value, env, exception, self._filling(target))
        return _UNIT if target is None else ir.Use(target)

    def _filling(self, target: Local | None) -> Ways:
        """Each rule's value goes into a local."""

        def give_up() -> None:
            if target is not None:
                self.emit(ir.Assign(target, self.zero(target.type)))

        return Ways(lambda body, env: self.into(body, env, target), give_up)

    def _chain(
        self, rules: tuple[core.Rule, ...], value: Val, env: Env, exception: str, ways: Ways
    ) -> None:
        """Rules tried one after the other."""
        value = self.settle(value, "value")
        self._rule(0, rules, value, env, exception, ways)

    def _rule(
        self,
        index: int,
        rules: tuple[core.Rule, ...],
        value: Val,
        env: Env,
        exception: str,
        ways: Ways,
    ) -> None:
        if index == len(rules):
            self.emit(ir.Raise(exception))
            ways.give_up()
            return
        rule = rules[index]
        match = self._matcher.match(rule.pattern, value)
        condition = conjunction(match.conditions)
        # The data type's constructors are all there: the last of them needs no test.
        is_last = index + 1 == len(rules) and covers(rules)
        if condition is None or is_last:
            ways.finish(rule.body, self._bind_all(Match([], match.bindings), env))
            return
        with self.block() as then:
            ways.finish(rule.body, self._bind_all(Match([], match.bindings), env))
        with self.block() as otherwise:
            self._rule(index + 1, rules, value, env, exception, ways)
        self.emit(ir.If(condition, tuple(then), tuple(otherwise)))

    # --- the rest ------------------------------------------------------------------------------

    def _while(self, e: core.While, env: Env) -> Ir:
        with self.block() as setup:
            condition = self.ir(e.condition, env)
        with self.block() as body:
            self.effect(e.body, env)
        self.emit(ir.While(tuple(setup), condition, tuple(body)))
        return _UNIT

    def _raise(self, exception: core.Exp) -> None:
        while isinstance(exception, core.Apply):
            exception = exception.function
        if not isinstance(exception, core.Con):
            raise UnsupportedError(
                UNSUPPORTED_EXCEPTION,
                "raising a computed exception is not supported",
                exception.span,
            )
        self.emit(ir.Raise(exception.constructor.name))

    def _handle(self, e: core.Handle, env: Env, target: Local | None) -> None:
        was_ok = self.local("was_ok", ir.BOOL)
        self.emit(ir.Let(was_ok, ir.Ok()))
        self.into(e.body, env, target)
        with self.block() as handler:
            self._handlers(e.rules, env, target)
        failed = ir.Op("andalso", (ir.Use(was_ok), negation(ir.Ok())), ir.BOOL)
        self.emit(ir.If(failed, tuple(handler), ()))

    def _handlers(self, rules: tuple[core.Rule, ...], env: Env, target: Local | None) -> None:
        if not rules:
            return
        rule, rest = rules[0], rules[1:]
        name = handled_name(rule.pattern)
        if name is None:
            raise UnsupportedError(
                UNSUPPORTED_EXCEPTION,
                "a handler that looks at the exception's value is not supported",
                rule.span,
                hint="use the exception's name, or `_`",
            )
        with self.block() as then:
            self.emit(ir.ClearError())
            self.into(rule.body, env, target)
        with self.block() as otherwise:
            self._handlers(rest, env, target)
        self.emit(ir.If(ir.HasError(name), tuple(then), tuple(otherwise)))

    # --- bodies of functions -------------------------------------------------------------------

    def tail(self, e: core.Exp, env: Env) -> None:
        """Evaluate and return."""
        match e:
            case core.If() if not self._is_short(e):
                condition = self.ir(e.condition, env)
                with self.block() as then:
                    self.tail(e.then, env)
                with self.block() as otherwise:
                    self.tail(e.otherwise, env)
                self.emit(ir.If(condition, tuple(then), tuple(otherwise)))
            case core.Case():
                value = self.exp(e.scrutinee, env)
                self.tail_rules(e.rules, value, env)
            case core.Let():
                self.tail(e.body, self.declare(e.declarations, env))
            case core.Sequence():
                for item in e.items[:-1]:
                    self.effect(item, env)
                self.tail(e.items[-1], env)
            case core.Apply():
                self._tail_call(e, env)
            case _:
                self._return(self.ir(e, env))

    def tail_rules(self, rules: tuple[core.Rule, ...], value: Val, env: Env) -> None:
        """Return what the rule that fits gives."""
        result = self.representation(rules[0].body.type)
        ways = Ways(self.tail, lambda: self._return(self.zero(result)))
        self._chain(rules, value, env, "Match", ways)

    def _is_short(self, e: core.If) -> bool:
        return size(e) <= 14 and is_simple(e) and not self._may_call_itself(e)

    def _may_call_itself(self, e: core.Exp) -> bool:
        return bool(self.key) and any(
            isinstance(n, core.Var) and n.symbol.name == self.key.split("/")[0] for n in nodes(e)
        )

    def _tail_call(self, e: core.Apply, env: Env) -> None:
        function = self.exp(e.function, env)
        argument = self.exp(e.argument, env)
        named: Val = function
        arguments: tuple[Val, ...] = (argument,)
        if isinstance(function, Partial):
            named, arguments = function.function, (*function.arguments, argument)
        if isinstance(named, NamedFunction) and self.key:
            parameters, _ = split_parameters(named.function)
            if len(parameters) == len(arguments) and not type_has_function(self.type_of(e.type)):
                key, code = self.program.prepare_call(self, named, arguments)
                if key == self.key:
                    self.has_self_call = True
                    self.emit(ir.SelfCall(code))
                    return
        self._return(
            self.code(self.apply(function, argument, self.type_of(e.type), e.span), e.span)
        )

    def _return(self, value: Ir) -> None:
        if value.type == ir.UNIT:
            if not is_atomic(value):
                self.emit(ir.Do(value))
            self.emit(ir.Return(None))
        else:
            self.emit(ir.Return(value))
