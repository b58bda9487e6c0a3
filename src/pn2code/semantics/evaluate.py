"""The evaluator of the typed core language: what an expression of a net means.

    evaluator = Evaluator(program)
    evaluator.value(exp, {net_variable: 3})      # -> a value, or MlException

How it is built: `step(exp, env)` gives either the value at once (literals, variables) or a *task*, a Python
generator. A task asks for the value of another step by yielding it, and ends by returning its value, or
`Tail(step)` to continue as another step. One loop, `run`, keeps the tasks that wait on a stack of its own: deep
recursion in CPN ML never becomes deep recursion in Python, tail calls do not grow the stack, and an exception of
CPN ML goes up through the waiting tasks as the Python exception `MlException`.

Environments map the `uid` of a symbol to its value. A new one is made for each call; none is changed once an
expression has seen it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Mapping
from dataclasses import dataclass
from types import GeneratorType
from typing import Any, assert_never

from pn2code.diagnostics import Span
from pn2code.ml import core
from pn2code.ml.core import Symbol
from pn2code.ml.types import TRecord
from pn2code.semantics import values as v
from pn2code.semantics.builtins import builtin, colset_builtin
from pn2code.semantics.colours import Colours
from pn2code.semantics.files import Files
from pn2code.semantics.random import RandomStream
from pn2code.semantics.values import Closure, Data, MlException, MlLimit, Native, Value, exception

Environment = Mapping[int, Value]
Task = Generator[Any, Any, Any]
"""Yields steps, is sent their values, returns a value or a `Tail`."""
Step = Value | Task


@dataclass(frozen=True, slots=True)
class Tail:
    """What a task returns to be replaced by another step."""

    step: Step


@dataclass(frozen=True, slots=True)
class Limits:
    """Where evaluation gives up with `MlLimit`.

    Args:
        steps: most steps in one evaluation; None: no limit.
        depth: most tasks that may wait for each other.
    """

    steps: int | None = 20_000_000
    depth: int = 200_000


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
        # Both know each other: a subset colour set has a predicate, an expression colour-set functions.
        self.colours = Colours(self)
        self.globals: dict[int, Value] = {}
        for declaration in program.declarations:
            self.globals.update(self.run(self._declare(declaration, {})))

    # --- from outside --------------------------------------------------------------------------

    def value(self, exp: core.Exp, binding: Mapping[Symbol, Value] | None = None) -> Value:
        """The value of an expression over net variables."""
        environment = {symbol.uid: value for symbol, value in (binding or {}).items()}
        return self.run(self.step(exp, environment))  # type: ignore[no-any-return]

    def apply(self, function: Value, argument: Value) -> Value:
        """The value of a function at an argument."""
        return self.run(self.call(function, argument))  # type: ignore[no-any-return]

    def run(self, step: Step) -> Any:
        """Runs a step to its end.

        Raises:
            MlException: it raised an exception that nothing handles.
            MlLimit: the limits are reached.
        """
        waiting: list[Task] = []
        fuel = self.limits.steps
        current: Any = step
        error: MlException | None = None
        while True:
            if fuel is not None:
                fuel -= 1
                if fuel < 0:
                    raise MlLimit(f"no end after {self.limits.steps} steps")
            if error is None and isinstance(current, GeneratorType):
                if len(waiting) >= self.limits.depth:
                    raise MlLimit(f"recursion deeper than {self.limits.depth}")
                waiting.append(current)
                current = None
            elif not waiting:
                if error is not None:
                    raise error
                return current
            task = waiting[-1]
            try:
                if error is None:
                    current = task.send(current)
                else:
                    # without the traceback, which would grow with every task on the way
                    thrown, error = error.with_traceback(None), None
                    current = task.throw(thrown)
            except StopIteration as stop:
                waiting.pop()
                current = stop.value.step if isinstance(stop.value, Tail) else stop.value
            except MlException as raised:
                waiting.pop()
                error = raised
            except RecursionError:
                raise MlLimit("a value is nested too deeply") from None

    # --- expressions ---------------------------------------------------------------------------

    def step(self, exp: core.Exp, env: Environment) -> Step:
        """The value of an expression, or the task that finds it."""
        match exp:
            case core.Var(symbol):
                return env[symbol.uid] if symbol.uid in env else self.globals[symbol.uid]
            case core.Lit(value):
                return value
            case core.Apply():
                return self._apply(exp, env)
            case core.Builtin(name, colset=colset):
                return builtin(self, name) if colset is None else colset_builtin(self, name, colset)
            case core.RecordExp():
                return self._record(exp, env)
            case core.Con(constructor):
                return _construct(constructor)
            case core.If():
                return self._if(exp, env)
            case core.Select():
                return self._select(exp, env)
            case core.ListExp(items):
                return self._all(items, env) if items else ()
            case core.Case():
                return self._case(exp, env)
            case core.Lambda(rules):
                return Closure(rules, dict(env))
            case core.Let():
                return self._let(exp, env)
            case core.Sequence():
                return self._sequence(exp, env)
            case core.While():
                return self._while(exp, env)
            case core.Raise():
                return self._raise(exp, env)
            case core.Handle():
                return self._handle(exp, env)
            case _:
                assert_never(exp)

    def call(self, function: Value, argument: Value, span: Span | None = None) -> Step:
        """The value of a function at an argument, or the task that finds it."""
        if isinstance(function, Closure):
            for rule in function.rules:
                bound: dict[int, Value] = {}
                if match(rule.pattern, argument, bound):
                    return self.step(rule.body, {**function.environment, **bound})
            raise MlException(exception("Match"), span)
        assert isinstance(function, Native), "not a function"
        arguments = (*function.arguments, argument)
        if len(arguments) < function.arity:
            return Native(function.name, function.arity, function.function, arguments)
        return function.function(self, *arguments)  # type: ignore[no-any-return]

    def _apply(self, exp: core.Apply, env: Environment) -> Task:
        function = yield self.step(exp.function, env)
        argument = yield self.step(exp.argument, env)
        try:
            return Tail(self.call(function, argument, exp.span))
        except MlException as raised:
            raised.span = raised.span or exp.span
            raise

    def _record(self, exp: core.RecordExp, env: Environment) -> Task:
        found: dict[str, Value] = {}
        for label, field in exp.fields:
            found[label] = yield self.step(field, env)
        assert isinstance(exp.type, TRecord)
        return tuple(found[label] for label, _ in exp.type.fields)

    def _select(self, exp: core.Select, env: Environment) -> Task:
        record = yield self.step(exp.record, env)
        assert isinstance(exp.record.type, TRecord)
        labels = [label for label, _ in exp.record.type.fields]
        return record[labels.index(exp.label)]

    def _all(self, items: Iterable[core.Exp], env: Environment) -> Task:
        found: list[Value] = []
        for item in items:
            found.append((yield self.step(item, env)))
        return tuple(found)

    def _if(self, exp: core.If, env: Environment) -> Task:
        condition = yield self.step(exp.condition, env)
        return Tail(self.step(exp.then if condition else exp.otherwise, env))

    def _case(self, exp: core.Case, env: Environment) -> Task:
        value = yield self.step(exp.scrutinee, env)
        for rule in exp.rules:
            bound: dict[int, Value] = {}
            if match(rule.pattern, value, bound):
                return Tail(self.step(rule.body, {**env, **bound}))
        raise MlException(exception("Match"), exp.span)

    def _let(self, exp: core.Let, env: Environment) -> Task:
        inner = dict(env)
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


def match(pattern: core.Pat, value: Any, bound: dict[int, Value]) -> bool:
    """Matches a value, adding to `bound` what the variables stand for.

    A variable that is in `bound` already must have an equal value: net variables may occur again.
    What was added before a mismatch stays, so a caller who goes on copies `bound` first.
    """
    match pattern:
        case core.PVar(symbol):
            return _bind(symbol, value, bound)
        case core.PWild():
            return True
        case core.PLit(literal):
            return bool(value == literal)
        case core.PRecord(fields):
            return all(
                match(field, item, bound) for (_, field), item in zip(fields, value, strict=True)
            )
        case core.PAs(symbol, inner):
            return _bind(symbol, value, bound) and match(inner, value, bound)
        case core.PCon(constructor, argument):
            match constructor.data_type, constructor.name:
                case "bool", name:
                    return bool(value == (name == "true"))
                case "list", "nil":
                    return len(value) == 0
                case "list", _:
                    assert argument is not None
                    return len(value) > 0 and match(argument, (value[0], value[1:]), bound)
                case _:
                    same = bool(value.tag == constructor.tag)
                    return same and (argument is None or match(argument, value.argument, bound))
        case _:
            assert_never(pattern)


def _bind(symbol: Symbol, value: Value, bound: dict[int, Value]) -> bool:
    if symbol.uid in bound:
        return v.equal(bound[symbol.uid], value)
    bound[symbol.uid] = value
    return True


def variables(node: core.Exp | core.Pat | core.Dec | core.Rule) -> frozenset[Symbol]:
    """Every symbol used or bound anywhere in a piece of the core language."""
    found: set[Symbol] = set()
    todo: list[Any] = [node]
    while todo:
        item = todo.pop()
        if isinstance(item, Symbol):
            found.add(item)
        elif isinstance(item, tuple):
            todo.extend(item)
        elif type(item).__module__ == core.__name__:
            todo.extend(getattr(item, name) for name in item.__slots__ if name not in _LEAVES)
    return frozenset(found)


_LEAVES = frozenset({"type", "span", "inst", "colset", "constructor"})
