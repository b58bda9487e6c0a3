"""Choices: `if`, `case`, rules, `handle`, as values, into a local, or at the end of a function.

What the parts of an expression are is the business of `expressions.Body`, which inherits this.
"""

from __future__ import annotations

from collections.abc import Callable

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, Local, Rep
from pn2code.lowering.expressions.block import UNIT_VALUE, Block
from pn2code.lowering.expressions.matching import (
    Match,
    Matcher,
    conjunction,
    is_irrefutable,
    negation,
)
from pn2code.lowering.expressions.parameters import split_parameters
from pn2code.lowering.expressions.shapes import covers, handled_name, is_simple, nodes, size
from pn2code.lowering.expressions.type_terms import has_function as type_has_function
from pn2code.lowering.expressions.values import Binding, Env, NamedFunction, Partial, Val, is_atomic
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import Type

_UNIT = UNIT_VALUE


@frozen
class Outcomes:
    """What becomes of rules: `finish` of the body of the one that fits; `give_up` after an exception where
    none does."""

    finish: Callable[[core.Exp, Env], None]
    give_up: Callable[[], None]


class Branching(Block):
    """Lowers what chooses between expressions, and what is evaluated last."""

    def ir(self, e: core.Exp, env: Env) -> Ir:
        """The expression as C code. Of a unit only what happens on the way to it is left: in C it has no value."""
        code = self.code(self.exp(e, env), e.span)
        if code.type != ir.UNIT or isinstance(code, ir.Const | ir.Bound | ir.Use):
            return code
        self.discard(code)
        return ir.Const(None, ir.UNIT)

    def exp(self, e: core.Exp, env: Env) -> Val:
        """The value of an expression."""
        raise NotImplementedError

    def effect(self, e: core.Exp, env: Env) -> None:
        """Evaluate only for what it does."""
        raise NotImplementedError

    def apply(self, function: Val, argument: Val, result: Type, at: Span) -> Val:
        """Apply a function."""
        raise NotImplementedError

    def declare(self, let: core.Let, env: Env) -> Env:
        """The environment after the declarations of a `let`."""
        raise NotImplementedError

    # --- patterns ------------------------------------------------------------------------------

    def match_stored(self, pattern: core.Pat, value: Val) -> Match:
        """Match a value of any kind: what a pattern looks into is computed first."""
        if isinstance(pattern, core.PWild):
            self.discard(value)
        elif not isinstance(pattern, core.PVar):
            value = self.store_in_locals(value, "value")
        return Matcher(self).match(pattern, value)

    def bind_pattern(
        self, pattern: core.Pat, value: Val, env: Env | None = None, exception: str = "Bind"
    ) -> Env:
        """The environment with the variables of a pattern; the exception is raised where it does not fit."""
        return self.bind_all(self.match_stored(pattern, value), env or {}, exception)

    def match(self, pattern: core.Pat, value: Val) -> Match:
        """Match a value whose C parts are atomic."""
        return Matcher(self).match(pattern, value)

    def bind_all(self, match: Match, env: Env, exception: str = "") -> Env:
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

    def branching(self, e: core.If | core.Case | core.Handle, env: Env) -> Val:
        """The value of a choice."""
        if type_has_function(self.type_of(e.type)):
            known = self._static_branch(e, env)
            if known is not None:
                return known
        if isinstance(e, core.If):
            known_truth = self.program.truth(e.condition)
            if known_truth is not None:
                return self.exp(e.then if known_truth else e.otherwise, env)
            simple = self._simple_if(e, env)
            if simple is not None:
                return simple
        rule = e.rules[0] if isinstance(e, core.Case) else None
        if isinstance(e, core.Case) and rule and len(e.rules) == 1 and is_irrefutable(rule.pattern):
            value = self.exp(e.scrutinee, env)
            return self.exp(rule.body, self.bind_all(self.match_stored(rule.pattern, value), env))
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

    def _static_branch(self, e: core.If | core.Case | core.Handle, env: Env) -> Val | None:
        """A choice among functions that is known, or that there is none in."""
        if isinstance(e, core.If) and isinstance(e.condition, core.Con):
            return self.exp(e.then if e.condition.constructor.tag == 1 else e.otherwise, env)
        if isinstance(e, core.Case) and len(e.rules) == 1:
            value = self.exp(e.scrutinee, env)
            rule = e.rules[0]
            return self.exp(
                rule.body, self.bind_all(self.match_stored(rule.pattern, value), env, "Match")
            )
        return None

    def _simple_if(self, e: core.If, env: Env) -> Ir | None:
        """As a C expression, if both outcomes are simple."""
        if not (is_simple(e.then) and is_simple(e.otherwise)):
            return None
        condition = self.ir(e.condition, env)
        if isinstance(condition, ir.Const):
            return self.ir(e.then if condition.value else e.otherwise, env)
        with self.block() as first:
            then = self.ir(e.then, env)
        with self.block() as second:
            otherwise = self.ir(e.otherwise, env)
        if (
            then.type == ir.UNIT
        ):  # also where neither way does anything: the condition may raise an exception
            self.emit(ir.If(condition, tuple(first), tuple(second)))
            return _UNIT
        if not first and not second:
            return self._choice(condition, then, otherwise)
        result = self.local("result", then.type)
        self.emit(ir.Declare(result))
        first.append(ir.Assign(result, then))
        second.append(ir.Assign(result, otherwise))
        self.emit(ir.If(condition, tuple(first), tuple(second)))
        return ir.Use(result)

    @staticmethod
    def _choice(condition: Ir, then: Ir, otherwise: Ir) -> Ir:
        """`if` as an expression."""
        if isinstance(otherwise, ir.Const) and otherwise.value is False:
            return ir.Op("andalso", (condition, then), ir.BOOL)
        if isinstance(then, ir.Const) and then.value is True:
            return ir.Op("orelse", (condition, otherwise), ir.BOOL)
        return ir.Select(condition, then, otherwise, then.type)

    def into(self, e: core.Exp, env: Env, target: Local | None) -> None:
        """Evaluate into a local (None: a unit, nothing to keep)."""
        match e:
            case core.If() if self.program.truth(e.condition) is not None:
                self.into(e.then if self.program.truth(e.condition) else e.otherwise, env, target)
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
                self.into(e.body, self.declare(e, env), target)
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

    def choose(
        self, rules: tuple[core.Rule, ...], value: Val, env: Env, result: Type, exception: str
    ) -> Ir:
        """What the first rule that fits gives."""
        t = self.program.types.lower(result)
        target = None if t.rep is Rep.UNIT else self.local("result", t)
        if target is not None:
            self.emit(ir.Declare(target))
        self._chain(rules, value, env, exception, self._filling(target))
        return _UNIT if target is None else ir.Use(target)

    def _filling(self, target: Local | None) -> Outcomes:
        """Each rule's value goes into a local."""

        def give_up() -> None:
            if target is not None:
                self.emit(ir.Assign(target, self.zero(target.type)))

        return Outcomes(lambda body, env: self.into(body, env, target), give_up)

    def _chain(
        self, rules: tuple[core.Rule, ...], value: Val, env: Env, exception: str, outcomes: Outcomes
    ) -> None:
        """Rules tried one after the other."""
        value = self.store_in_locals(value, "value")
        self._rule(0, rules, value, env, exception, outcomes)

    def _rule(
        self,
        index: int,
        rules: tuple[core.Rule, ...],
        value: Val,
        env: Env,
        exception: str,
        outcomes: Outcomes,
    ) -> None:
        if index == len(rules):
            self.emit(ir.Raise(exception))
            outcomes.give_up()
            return
        rule = rules[index]
        match = Matcher(self).match(rule.pattern, value)
        condition = conjunction(match.conditions)
        # The data type's constructors are all there: the last of them needs no test.
        is_last = index + 1 == len(rules) and covers(rules)
        if is_last and condition is not None and self._is_recursive(value):
            # It does: after an error there may be no argument behind the pointer.
            with self.block() as then:
                outcomes.finish(rule.body, self.bind_all(Match([], match.bindings), env))
            with self.block() as otherwise:
                outcomes.give_up()
            self.emit(ir.If(condition, tuple(then), tuple(otherwise)))
            return
        if condition is None or is_last:
            outcomes.finish(rule.body, self.bind_all(Match([], match.bindings), env))
            return
        with self.block() as then:
            outcomes.finish(rule.body, self.bind_all(Match([], match.bindings), env))
        with self.block() as otherwise:
            self._rule(index + 1, rules, value, env, exception, outcomes)
        self.emit(ir.If(condition, tuple(then), tuple(otherwise)))

    def _is_recursive(self, value: Val) -> bool:
        return self.program.types.is_recursive(self.code(value).type)

    # --- exceptions ----------------------------------------------------------------------------

    def raise_exception(self, exception: core.Exp, env: Env) -> None:
        """`raise e`."""
        if isinstance(exception, core.Con) and self.program.exceptions.is_plain(
            exception.constructor
        ):
            self.program.exceptions.note_raised(exception.constructor)
            self.emit(ir.Raise(exception.constructor.name))
            return
        value = self.addressable(self.ir(exception, env), "exception")
        self.emit(ir.RaiseValue(value, self.program.exceptions.table()))

    def _handle(self, e: core.Handle, env: Env, target: Local | None) -> None:
        self.program.handles = True
        was_ok = self.local("was_ok", ir.BOOL)
        self.emit(ir.Let(was_ok, ir.Ok()))
        self.into(e.body, env, target)
        with self.block() as handler:
            if all(self._is_by_name(rule) for rule in e.rules):
                self._handlers(e.rules, env, target)
            else:
                self._handlers_of_values(e.rules, env, target)
        failed = ir.Op("andalso", (ir.Use(was_ok), negation(ir.Ok())), ir.BOOL)
        self.emit(ir.If(failed, tuple(handler), ()))

    def _is_by_name(self, rule: core.Rule) -> bool:
        pattern = rule.pattern
        if isinstance(pattern, core.PCon) and not self.program.exceptions.is_alone(
            pattern.constructor
        ):
            return False
        return handled_name(rule) is not None

    def _handlers(self, rules: tuple[core.Rule, ...], env: Env, target: Local | None) -> None:
        if not rules:
            return
        rule, rest = rules[0], rules[1:]
        name = handled_name(rule)
        assert name is not None
        with self.block() as then:
            self.emit(ir.ClearError())
            self.into(rule.body, env, target)
        with self.block() as otherwise:
            self._handlers(rest, env, target)
        self.emit(ir.If(ir.HasError(name), tuple(then), tuple(otherwise)))

    def _handlers_of_values(
        self, rules: tuple[core.Rule, ...], env: Env, target: Local | None
    ) -> None:
        """The rules of a handler that looks at the exception."""
        with self.block() as statements:
            raised = self.spill(self.program.exceptions.raised(), "raised")
            self._value_handler(rules, raised, env, target)
        self.emit(ir.If(ir.HasError(""), tuple(statements), ()))

    def _value_handler(
        self, rules: tuple[core.Rule, ...], raised: Ir, env: Env, target: Local | None
    ) -> None:
        if not rules:
            return
        rule, rest = rules[0], rules[1:]
        match = Matcher(self).match(rule.pattern, raised)
        condition = conjunction(match.conditions)
        with self.block() as then:
            self.emit(ir.ClearError())
            self.into(rule.body, self.bind_all(Match([], match.bindings), env), target)
        if condition is None:
            self.statements.extend(then)
            return
        with self.block() as otherwise:
            self._value_handler(rest, raised, env, target)
        self.emit(ir.If(condition, tuple(then), tuple(otherwise)))

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
                self.tail(e.body, self.declare(e, env))
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
        outcomes = Outcomes(self.tail, lambda: self._return(self.zero(result)))
        self._chain(rules, value, env, "Match", outcomes)

    def _is_short(self, e: core.If) -> bool:
        return size(e) <= 14 and is_simple(e) and not self._may_call_itself(e)

    def _may_call_itself(self, e: core.Exp) -> bool:
        return bool(self.key) and any(
            isinstance(n, core.Var) and n.symbol.name == self.key.split("/")[0] for n in nodes(e)
        )

    def _tail_call(self, e: core.Apply, env: Env) -> None:
        function, argument = self.in_order(
            [lambda: self.exp(e.function, env), lambda: self.exp(e.argument, env)]
        )
        named: Val = function
        arguments: tuple[Val, ...] = (argument,)
        if isinstance(function, Partial):
            named, arguments = function.function, (*function.arguments, argument)
        if isinstance(named, NamedFunction) and named.symbol.name == self.key.split("/")[0]:
            parameters, _ = split_parameters(named.function)
            if len(parameters) == len(arguments):
                key, code = self.program.prepare_call(self, named, arguments, e.span)
                if key == self.key:
                    self.has_self_call = True
                    self.emit(ir.SelfCall(code))
                    return
        self._return(
            self.code(self.apply(function, argument, self.type_of(e.type), e.span), e.span)
        )

    def finish(self, value: Val) -> None:
        """Return a value."""
        self._return(self.code(value))

    def _return(self, value: Ir) -> None:
        if value.type == ir.UNIT:
            if not is_atomic(value):
                self.emit(ir.Do(value))
            self.emit(ir.Return(None))
        else:
            self.emit(ir.Return(value))
