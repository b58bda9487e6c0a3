"""Matching values with patterns."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.semantics.values import data as v
from pn2code.semantics.values.data import Value


def match(pattern: core.Pat, value: Any, bound: dict[int, Value]) -> bool:
    """Matches a value, adding to `bound` what the variables stand for.

    A variable that is in `bound` already must have an equal value: net variables may occur again. So have declared
    values that a pattern names: `bound` begins with those of `Enabling.constants`.
    What was added before a mismatch stays, so a caller who goes on copies `bound` first.
    """
    return _MATCHES[type(pattern)](pattern, value, bound)


def _match_record(pattern: core.PRecord, value: Any, bound: dict[int, Value]) -> bool:
    for (_, field), item in zip(pattern.fields, value, strict=True):
        if not _MATCHES[type(field)](field, item, bound):
            return False
    return True


def _match_constructor(pattern: core.PCon, value: Any, bound: dict[int, Value]) -> bool:
    constructor, argument = pattern.constructor, pattern.argument
    match constructor.data_type, constructor.name:
        case "bool", name:
            return bool(value == (name == "true"))
        case "list", "nil":
            return len(value) == 0
        case "list", _:
            assert argument is not None
            return len(value) > 0 and match(argument, (value[0], value[1:]), bound)
        case "timed", _:
            assert argument is not None
            return match(argument, (value.value, value.stamp), bound)
        case _:
            same = bool(value.tag == constructor.tag)
            return same and (argument is None or match(argument, value.argument, bound))


def _bind(symbol: Symbol, value: Value, bound: dict[int, Value]) -> bool:
    if symbol.uid in bound:
        return v.same(bound[symbol.uid], value)
    bound[symbol.uid] = value
    return True


_MATCHES: dict[type, Callable[[Any, Any, dict[int, Value]], bool]] = {
    core.PVar: lambda pattern, value, bound: _bind(pattern.symbol, value, bound),
    core.PWild: lambda pattern, value, bound: True,
    core.PEqual: lambda pattern, value, bound: v.same(bound[pattern.value.symbol.uid], value),
    core.PRecord: _match_record,
    core.PLit: lambda pattern, value, bound: bool(value == pattern.value),
    core.PAs: lambda pattern, value, bound: (
        _bind(pattern.symbol, value, bound) and match(pattern.pattern, value, bound)
    ),
    core.PCon: _match_constructor,
}
"""How to match each kind of pattern."""
