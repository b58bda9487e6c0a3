"""Values of expressions that the front end must know: bounds of colour sets, priorities, names of files.

    Computing(constants, bodies).value(exp)       # 3 for `length workers`, None when it cannot be said

What `constants.fold` cannot say is computed here: user functions, lists, tuples, patterns, multi-sets, the library
functions that such expressions use. It is no evaluator of nets: no exceptions, references, loops or files; it gives
up after some thousands of steps. Integers are those of CPN Tools; beyond them there is no value. What is beyond all
this is asked of the evaluator, if the caller of the front end has one (`Compute`).
"""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.constants import Constant, binary, fold, unary

MOST_STEPS = 100_000
MOST_INT = 2**30
MOST_TOKENS = 10_000
_NAMES = {"length": "List.length", "rev": "List.rev", "size": "String.size"}


@frozen
class Computed:
    """What an evaluator says of an expression.

    Args:
        value: its value; None if there is none that the front end may use.
        why: why there is none.
    """

    value: Any
    why: str = ""


class Compute(Protocol):
    """An evaluator, lent to the front end."""

    def __call__(
        self, program: core.Program, exp: core.Exp, *, fixed: bool, real_time: bool
    ) -> Computed:
        """The value after the declarations of a program; `fixed`: it must never change."""


Value = Any
"""Constant; tuple: a list; frozenset of (label, value): a record; (Constructor, argument) in `_Data`; a function."""


class _UnknownError(Exception):
    """There is no value that could be said."""


class _Data(tuple[Any, ...]):
    """A constructed value: its constructor, and its argument or None."""

    __slots__ = ()


class Computing:
    """Computes from declarations.

    Args:
        constants: values of symbols by uid.
        bodies: of other symbols: what was declared to be their value.
    """

    def __init__(self, constants: Mapping[int, Constant], bodies: Mapping[int, core.Exp]) -> None:
        self._constants = constants
        self._bodies = bodies
        self._steps = 0

    def value(self, e: core.Exp) -> Constant | None:
        """The value, if it is a number, a text or a truth value."""
        folded = fold(e, self._constants)
        if folded is not None:
            return folded
        found = self._computed(e)
        return found if isinstance(found, int | float | str) else None

    def tokens(self, e: core.Exp, is_token: bool) -> Counter[Value] | None:
        """The tokens of an initial marking, which is one of them or a multi-set, if they can be said."""
        found = self._computed(e)
        if found is None or not (is_token or isinstance(found, tuple)):
            return None
        try:
            return Counter([found] if is_token else found)
        except TypeError:
            return None  # functions: no colour set has them

    def _computed(self, e: core.Exp) -> Value:
        self._steps = 0
        try:
            return self._value(e, {})
        except (_UnknownError, RecursionError):
            return None

    def _value(self, e: core.Exp, local: Mapping[int, Value]) -> Value:
        self._steps += 1
        if self._steps > MOST_STEPS:
            raise _UnknownError
        match e:
            case core.Lit():
                return e.value
            case core.Var():
                return self._symbol(e.symbol.uid, local)
            case core.Con():
                return _constructor(e.constructor)
            case core.Builtin():
                return _library(e.name)
            case core.Apply():
                function = self._value(e.function, local)
                if not callable(function):
                    raise _UnknownError
                return _checked(function(self._value(e.argument, local)))
            case core.Lambda():
                return self._function(e, local)
            case core.RecordExp():
                return frozenset((label, self._value(x, local)) for label, x in e.fields)
            case core.Select():
                return dict(self._value(e.record, local))[e.label]
            case core.ListExp():
                return tuple(self._value(x, local) for x in e.items)
            case core.If():
                chosen = e.then if self._value(e.condition, local) else e.otherwise
                return self._value(chosen, local)
            case core.Case():
                return self._rules(e.rules, self._value(e.scrutinee, local), local)
            case core.Let():
                return self._let(e, local)
            case _:
                raise _UnknownError

    def _symbol(self, uid: int, local: Mapping[int, Value]) -> Value:
        if uid in local:
            return local[uid]
        if uid in self._constants:
            return self._constants[uid]
        if uid in self._bodies:
            return self._value(self._bodies[uid], {})
        raise _UnknownError

    def _function(self, e: core.Lambda, local: Mapping[int, Value]) -> Callable[[Value], Value]:
        return lambda argument: self._rules(e.rules, argument, local)

    def _rules(
        self, rules: tuple[core.Rule, ...], value: Value, local: Mapping[int, Value]
    ) -> Value:
        for rule in rules:
            inner = dict(local)
            if _fits(rule.pattern, value, inner):
                return self._value(rule.body, inner)
        raise _UnknownError

    def _let(self, e: core.Let, local: Mapping[int, Value]) -> Value:
        inner = dict(local)
        for dec in e.declarations:
            match dec:
                case core.ValBind():
                    if not _fits(dec.pattern, self._value(dec.value, inner), inner):
                        raise _UnknownError
                case core.RecBind():
                    # Functions see the same scope, in which they will be themselves.
                    inner.update({s.uid: self._function(f, inner) for s, f in dec.bindings})
                case _:
                    pass
        return self._value(e.body, inner)


def _fits(pattern: core.Pat, value: Value, bound: dict[int, Value]) -> bool:
    match pattern:
        case core.PWild():
            return True
        case core.PVar():
            bound[pattern.symbol.uid] = value
            return True
        case core.PLit():
            return bool(value == pattern.value)
        case core.PRecord():
            parts = dict(value)
            return all(_fits(p, parts[label], bound) for label, p in pattern.fields)
        case core.PAs():
            bound[pattern.symbol.uid] = value
            return _fits(pattern.pattern, value, bound)
        case core.PCon():
            return _fits_constructor(pattern, value, bound)
        case core.PEqual():
            raise _UnknownError  # occurs in inscriptions only


def _fits_constructor(pattern: core.PCon, value: Value, bound: dict[int, Value]) -> bool:
    name = pattern.constructor.name
    if pattern.constructor.data_type == "bool":
        return bool(value is (name == "true"))
    if pattern.constructor.data_type == "list":
        if name == "nil" or not value:
            return name == "nil" and not value
        rest = _record(value[0], value[1:])
        return pattern.argument is None or _fits(pattern.argument, rest, bound)
    if not isinstance(value, _Data) or value[0] != pattern.constructor:
        return False
    return pattern.argument is None or _fits(pattern.argument, value[1], bound)


def _record(*items: Value) -> Value:
    """A tuple of CPN ML."""
    return frozenset((str(i), x) for i, x in enumerate(items, 1))


def _pair(value: Value) -> tuple[Value, Value]:
    parts = dict(value)
    return parts["1"], parts["2"]


def _constructor(c: core.Constructor) -> Value:
    if c.data_type == "bool":
        return c.name == "true"
    if c.data_type == "list":
        return () if not c.has_argument else lambda pair: (_pair(pair)[0], *_pair(pair)[1])
    return (lambda argument: _Data((c, argument))) if c.has_argument else _Data((c, None))


def _checked(value: Value) -> Value:
    is_large = isinstance(value, int) and not -MOST_INT <= value < MOST_INT
    if value is None or is_large:
        raise _UnknownError
    return value


def _fold_left(f: Value) -> Value:
    return lambda start: (
        lambda items: functools.reduce(lambda x, item: f(_record(item, x)), items, start)
    )


def _nth(argument: Value) -> Value:
    items, index = _pair(argument)
    return items[index] if 0 <= index < len(items) else None


def _times(pair: Value) -> Value:
    count, item = _pair(pair)
    return (item,) * max(count, 0) if count <= MOST_TOKENS else None


def _stamped(pair: Value) -> Value:
    """A token with its delay, which is its stamp in an initial marking."""
    return _record(*_pair(pair))


def _all_stamped(pair: Value) -> Value:
    items, delay = _pair(pair)
    return tuple(_record(item, delay) for item in items)


def _joined(pair: Value) -> Value:
    return _pair(pair)[0] + _pair(pair)[1]


_LIBRARY: dict[str, Callable[[Value], Value]] = {
    "List.length": len,
    "String.size": len,
    "List.rev": lambda items: items[::-1],
    "List.hd": lambda items: items[0] if items else None,
    "List.tl": lambda items: items[1:] if items else None,
    "List.null": lambda items: not items,
    "List.nth": _nth,
    "List.@": _joined,
    "Ms.`": _times,
    "Ms.++": _joined,
    "Time.+++": _joined,
    "Time.@+": _all_stamped,
    "Time.token@+": _stamped,
    "List.map": lambda f: lambda items: tuple(map(f, items)),
    "List.filter": lambda f: lambda items: tuple(filter(f, items)),
    "List.foldl": _fold_left,
    "List.foldr": lambda f: lambda start: lambda items: _fold_left(f)(start)(items[::-1]),
    "List.tabulate": lambda pair: tuple(map(_pair(pair)[1], range(max(_pair(pair)[0], 0)))),
}


def _library(name: str) -> Value:
    known = _LIBRARY.get(_NAMES.get(name, name))
    if known is not None:
        return known
    return lambda argument: _operator(name, argument)


def _operator(name: str, argument: Value) -> Value:
    if isinstance(argument, frozenset):
        if {label for label, _ in argument} != {"1", "2"}:
            raise _UnknownError
        left, right = _pair(argument)
        if name in ("=", "<>"):
            return (left == right) is (name == "=")
        return binary(name, left, right)
    return unary(name, argument)
