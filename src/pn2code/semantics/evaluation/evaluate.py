"""The evaluator of the typed core language: what an expression of a net means.

    evaluator = Evaluator(program)
    evaluator.value(exp, {net_variable: 3})      # -> a value, or MlException

How it is built: `step(exp, env)` gives the value at once where no function of the net has to be called, else a *task*,
a Python generator. A task asks for the value of another step by yielding it, and ends by returning its value, or
`Tail(step)` to continue as another step. One loop, `run`, keeps the tasks that wait on a stack of its own: deep
recursion in CPN ML never becomes deep recursion in Python, tail calls do not grow the stack, and an exception of
CPN ML goes up through the waiting tasks as the Python exception `MlException`.

Environments map the `uid` of a symbol to its value. A new one is made for each call; none is changed once an
expression has seen it.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Mapping
from types import GeneratorType
from typing import Any, assert_never

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import TRecord
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.evaluation.matching import match
from pn2code.semantics.evaluation.random import RandomStream
from pn2code.semantics.evaluation.tasks import Step, Tail, Task
from pn2code.semantics.library.builtins import builtin, colset_builtin
from pn2code.semantics.values import data as v
from pn2code.semantics.values.colours import Colours
from pn2code.semantics.values.data import (
    MAX_BITS,
    MAX_ITEMS,
    MAX_STRING,
    Closure,
    Data,
    MlException,
    MlLimit,
    Native,
    Value,
    exception,
)

Environment = Mapping[int, Value]


@frozen
class Limits:
    """Where evaluation gives up with `MlLimit`.

    Args:
        steps: most steps in one evaluation, about one for each call of a function; None: no limit.
        depth: most tasks that may wait for each other, about two for each call.
    """

    steps: int | None = 1_000_000
    depth: int = 700_000


_LARGEST_INT = 1 << MAX_BITS

_RECURSION_LIMIT = 100_000
"""Python frames for one expression; they are not on C's stack."""


_GROWING = frozenset({str, tuple, int})


def _bounded(value: Any) -> Any:
    """A result that is not too large: a function that doubles one with each call would soon take all memory.

    Raises:
        MlException: Size, for a string.
        MlLimit: for a list, a multi-set or an unbounded integer.
    """
    if type(value) is int:
        if not -_LARGEST_INT < value < _LARGEST_INT:
            raise MlLimit(f"a number has more than {MAX_BITS:,} bits")
    elif len(value) > MAX_ITEMS:
        if type(value) is not str:
            raise MlLimit(f"a list or a multi-set has more than {MAX_ITEMS:,} elements")
        if len(value) > MAX_STRING:
            raise MlException(exception("Size"))
    return value


class Evaluator:
    """Evaluates the declarations of a program, then any expressions over them.

    Args:
        program: the checked declarations. They are evaluated here, in order.
        real_time: whether model time is real.
        seed: of the random functions.
        limits: against endless functions.
        output: is given every text that the net prints.
        files: what the net can do with files; nothing by default.

    Attributes:
        now: the model time that `time()` gives; set by the token game.
        steps: what `step()` gives.
        spent: steps, as `Limits` counts them, of all evaluations that have come to a value.
        random: the source of all random functions.
        colours: operations of the colour sets.
        globals: the values of the top-level symbols.

    Raises:
        MlException: a declaration raised it (`span` says where).
        MlLimit: a declaration does not come to an end.
    """

    def __init__(
        self,
        program: core.Program,
        *,
        real_time: bool = False,
        seed: int = 1,
        limits: Limits | None = None,
        output: Callable[[str], None] = lambda text: None,
        files: Files | None = None,
    ) -> None:
        self.program: core.Program = program
        self.limits = limits or Limits()
        self.files: Files = files or Files(output=output)
        self.random = RandomStream(seed)
        self.real_time = real_time
        self.max_int: int = 2 ** (program.int_bits - 1) - 1
        self.min_int: int = -(2 ** (program.int_bits - 1))
        self.now: int | float = 0.0 if real_time else 0
        self.steps = 0
        self.spent = 0
        # Both know each other: a subset colour set has a predicate, an expression colour-set functions.
        self.colours = Colours(self)
        self.globals: dict[int, Value] = {}
        for declaration in program.declarations:
            self.globals.update(self.run(self._declare(declaration, {})))

    # --- from outside --------------------------------------------------------------------------

    def value(self, exp: core.Exp, binding: Mapping[Symbol, Value] | None = None) -> Value:
        """The value of an expression over net variables."""
        # A task that ends gives a value.
        return self.evaluate(exp, {symbol.uid: value for symbol, value in (binding or {}).items()})  # type: ignore[no-any-return]

    def evaluate(self, exp: core.Exp, environment: Environment) -> Any:
        """The value of an expression in an environment; raises what `run` raises."""
        before = sys.getrecursionlimit()
        sys.setrecursionlimit(max(before, _RECURSION_LIMIT))
        try:
            try:
                found = self.step(exp, environment)
            except RecursionError:
                raise MlLimit("a value is nested too deeply") from None
            except MemoryError:
                raise MlLimit("a value needs more memory than there is") from None
            if type(found) is GeneratorType:
                return self._run(found)
            self.spent += 1
            return found
        finally:
            sys.setrecursionlimit(before)

    def apply(self, function: Value, argument: Value) -> Value:
        """The value of a function at an argument."""
        return self.run(self.call(function, argument))  # type: ignore[no-any-return]  # tasks give values

    def run(self, step: Step) -> Any:
        """Runs a step to its end.

        Raises:
            MlException: it raised an exception that nothing handles.
            MlLimit: the limits are reached.
        """
        # Nested expressions (`a ++ b ++ ...`) are nested calls here; those of functions are not.
        before = sys.getrecursionlimit()
        sys.setrecursionlimit(max(before, _RECURSION_LIMIT))
        try:
            return self._run(step)
        finally:
            sys.setrecursionlimit(before)

    def _run(self, step: Step) -> Any:
        waiting: list[Task] = []
        most = math.inf if self.limits.steps is None else self.limits.steps
        count = 0
        depth = self.limits.depth
        current: Any = step
        while True:
            if type(current) is GeneratorType:
                if len(waiting) >= depth:
                    raise MlLimit(f"recursion deeper than {depth} calls that wait for each other")
                waiting.append(current)
                current = None
            elif not waiting:
                self.spent += count
                return current
            count += 1
            if count > most:
                raise MlLimit(f"no end after {most} steps")
            try:
                current = waiting[-1].send(current)
            except StopIteration as stop:
                waiting.pop()
                current = stop.value
                if type(current) is Tail:
                    current = current.step
            except MlException as raised:
                waiting.pop()
                current = self._handled(waiting, raised)
            except RecursionError:
                raise MlLimit("a value is nested too deeply") from None
            except MemoryError:
                raise MlLimit("a value needs more memory than there is") from None

    def _handled(self, waiting: list[Task], raised: MlException) -> Step:
        """Gives an exception to the waiting tasks, the last one first, until one handles it: what that continues with.

        Raises:
            MlException: none does.
        """
        while waiting:
            try:
                # without the traceback, which would grow with every task on the way
                return waiting[-1].throw(raised.with_traceback(None))
            except StopIteration as stop:
                waiting.pop()
                return stop.value.step if type(stop.value) is Tail else stop.value
            except MlException as another:
                waiting.pop()
                raised = another
        raise raised

    # --- expressions ---------------------------------------------------------------------------

    def step(self, exp: core.Exp, env: Environment) -> Step:
        """The value of an expression, or the task that finds it.

        What needs no call of a function of the net is evaluated at once, and may raise MlException here.
        """
        return _STEPS[type(exp)](self, exp, env)

    def call(self, function: Value, argument: Value, span: Span | None = None) -> Step:
        """The value of a function at an argument, or the task that finds it."""
        if type(function) is Closure:
            return self._enter(function, argument, span)
        assert isinstance(function, Native), "not a function"
        arguments = (*function.arguments, argument)
        if len(arguments) < function.arity:
            return Native(function.name, function.arity, function.function, arguments)
        try:
            value = function.function(self, *arguments)
            return _bounded(value) if type(value) in _GROWING else value
        except MlException as raised:
            raised.span = raised.span or span
            raise

    def _enter(self, function: Closure, argument: Value, span: Span | None) -> Task:
        """The body of a function. Always a task, so that Python's stack does not grow with that of the net."""
        for rule in function.rules:
            bound: dict[int, Value] = {}
            if match(rule.pattern, argument, bound):
                return Tail(self.step(rule.body, {**function.environment, **bound}))
        raise MlException(exception("Match"), span)
        yield  # makes this a task

    def _variable(self, exp: core.Var, env: Environment) -> Step:
        uid = exp.symbol.uid
        return env[uid] if uid in env else self.globals[uid]

    def _builtin(self, exp: core.Builtin, env: Environment) -> Step:
        if exp.colset is None:
            return builtin(self, exp.name)
        return colset_builtin(self, exp.name, exp.colset)

    def _apply(self, exp: core.Apply, env: Environment) -> Step:
        function = self.step(exp.function, env)
        if type(function) is GeneratorType:
            return self._apply_found(exp, env, function)
        argument = self.step(exp.argument, env)
        if type(argument) is GeneratorType:
            return self._apply_to(exp, function, argument)
        return self.call(function, argument, exp.span)

    def _apply_found(self, exp: core.Apply, env: Environment, function: Task) -> Task:
        found = yield function
        argument = yield self.step(exp.argument, env)
        return Tail(self.call(found, argument, exp.span))

    def _apply_to(self, exp: core.Apply, function: Value, argument: Task) -> Task:
        return Tail(self.call(function, (yield argument), exp.span))

    def _record(self, exp: core.RecordExp, env: Environment) -> Step:
        fields = exp.fields
        values: list[Value] = []
        for _, field in fields:
            value = self.step(field, env)
            if type(value) is GeneratorType:
                return self._rest_of_record(exp, env, values, value)
            values.append(value)
        return _in_order(exp, values)

    def _rest_of_record(
        self, exp: core.RecordExp, env: Environment, values: list[Value], task: Task
    ) -> Task:
        values.append((yield task))
        for _, field in exp.fields[len(values) :]:
            values.append((yield self.step(field, env)))
        return _in_order(exp, values)

    def _construct(self, exp: core.Con, env: Environment) -> Step:
        return _construct(exp.constructor)

    def _select(self, exp: core.Select, env: Environment) -> Step:
        record = self.step(exp.record, env)
        if type(record) is GeneratorType:
            return self._select_from(exp, record)
        return _field(exp, record)

    def _select_from(self, exp: core.Select, record: Task) -> Task:
        return _field(exp, (yield record))

    def _list(self, exp: core.ListExp, env: Environment) -> Step:
        return self._items(exp.items, env) if exp.items else ()

    def _items(self, items: Iterable[core.Exp], env: Environment) -> Task:
        found: list[Value] = []
        for item in items:
            found.append((yield self.step(item, env)))
        return tuple(found)

    def _if(self, exp: core.If, env: Environment) -> Step:
        condition = self.step(exp.condition, env)
        if type(condition) is GeneratorType:
            return self._if_so(exp, env, condition)
        return self.step(exp.then if condition else exp.otherwise, env)

    def _if_so(self, exp: core.If, env: Environment, condition: Task) -> Task:
        found = yield condition
        return Tail(self.step(exp.then if found else exp.otherwise, env))

    def _case(self, exp: core.Case, env: Environment) -> Step:
        value = self.step(exp.scrutinee, env)
        if type(value) is GeneratorType:
            return self._case_of(exp, env, value)
        return self._chosen(exp, env, value)

    def _case_of(self, exp: core.Case, env: Environment, value: Task) -> Task:
        return Tail(self._chosen(exp, env, (yield value)))

    def _chosen(self, exp: core.Case, env: Environment, value: Value) -> Step:
        for rule in exp.rules:
            bound: dict[int, Value] = {}
            if match(rule.pattern, value, bound):
                return self.step(rule.body, {**env, **bound})
        raise MlException(exception("Match"), exp.span)

    def _lambda(self, exp: core.Lambda, env: Environment) -> Step:
        return Closure(exp.rules, env)

    def _let(self, exp: core.Let, env: Environment) -> Task:
        inner = env
        for declaration in exp.declarations:
            inner = {**inner, **(yield self._declare(declaration, inner))}
        return Tail(self.step(exp.body, inner))

    def _sequence(self, exp: core.Sequence, env: Environment) -> Task:
        for item in exp.items[:-1]:
            yield self.step(item, env)
        return Tail(self.step(exp.items[-1], env))

    def _while(self, exp: core.While, env: Environment) -> Task:
        while (yield self.step(exp.condition, env)):
            yield self.step(exp.body, env)
        return v.UNIT

    def _raise(self, exp: core.Raise, env: Environment) -> Task:
        exception = yield self.step(exp.exception, env)
        raise MlException(exception, exp.span)

    def _handle(self, exp: core.Handle, env: Environment) -> Task:
        try:
            # Not a tail: this task has to be there when the body raises.
            return (yield self.step(exp.body, env))
        except MlException as raised:
            for rule in exp.rules:
                bound: dict[int, Value] = {}
                if match(rule.pattern, raised.value, bound):
                    return Tail(self.step(rule.body, {**env, **bound}))
            raise

    # --- declarations --------------------------------------------------------------------------

    def _declare(self, declaration: core.Dec, env: Environment) -> Task:
        """Gives the values of the symbols that the declaration binds."""
        match declaration:
            case core.ValBind(pattern, value, span):
                bound: dict[int, Value] = {}
                if not match(pattern, (yield self.step(value, env)), bound):
                    raise MlException(exception("Bind"), span)
                return bound
            case core.RecBind(bindings):
                # The functions see each other: their one environment is completed before any is called.
                together: dict[int, Value] = dict(env)
                group: dict[int, Value] = {
                    symbol.uid: Closure(function.rules, together) for symbol, function in bindings
                }
                together.update(group)
                return group
            case core.ExceptionDec() | core.DatatypeDec():
                return {}
            case _:
                assert_never(declaration)


_STEPS: dict[type, Callable[[Evaluator, Any, Environment], Step]] = {
    core.Var: Evaluator._variable,
    core.Lit: lambda e, exp, env: exp.value,
    core.Apply: Evaluator._apply,
    core.Builtin: Evaluator._builtin,
    core.RecordExp: Evaluator._record,
    core.Con: Evaluator._construct,
    core.If: Evaluator._if,
    core.Select: Evaluator._select,
    core.ListExp: Evaluator._list,
    core.Case: Evaluator._case,
    core.Lambda: Evaluator._lambda,
    core.Let: Evaluator._let,
    core.Sequence: Evaluator._sequence,
    core.While: Evaluator._while,
    core.Raise: Evaluator._raise,
    core.Handle: Evaluator._handle,
}
"""How to evaluate each kind of expression."""


def _in_order(exp: core.RecordExp, values: list[Value]) -> Value:
    """A record from the values of its fields as written."""
    written = exp.fields
    fields = exp.type.fields  # type: ignore[union-attr]  # a record has the type of one
    for i in range(len(written)):
        if written[i][0] != fields[i][0]:
            break
    else:
        return tuple(values)
    found = dict(zip((label for label, _ in written), values, strict=True))
    return tuple(found[label] for label, _ in fields)


def _field(exp: core.Select, record: Any) -> Value:
    assert isinstance(exp.record.type, TRecord)
    labels = [label for label, _ in exp.record.type.fields]
    return record[labels.index(exp.label)]  # type: ignore[no-any-return]  # a record holds values


def _construct(constructor: core.Constructor) -> Value:
    """A constructor as a value: itself, or the function that applies it."""
    match constructor.data_type, constructor.name:
        case "bool", name:
            return name == "true"
        case "list", "nil":
            return ()
        case "list", _:
            return Native("::", 1, lambda evaluator, pair: (pair[0], *pair[1]))
        case _, name:
            tag = constructor.tag
            if not constructor.has_argument:
                return Data(name, tag)
            return Native(name, 1, lambda evaluator, argument: Data(name, tag, argument))
