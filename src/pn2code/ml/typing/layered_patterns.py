"""`x as pattern` on an input arc, in core: whether a token matches, and the pattern that binds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.ml.core.types import BOOL, TFun, tuple_of
from pn2code.ml.library.datatypes import FALSE, TRUE


def matches(whole: core.Var, pattern: core.Pat, variables: Mapping[str, Symbol]) -> core.Exp:
    """Whether a token matches a pattern whose variables have the values of net variables."""
    span = pattern.span
    test: core.Exp = core.Con(TRUE, BOOL, span)
    false = core.Con(FALSE, BOOL, span)
    for own in _symbols(pattern):
        pair = core.RecordExp(
            (
                ("1", core.Var(own, own.type, span)),
                ("2", core.Var(variables[own.name], own.type, span)),
            ),
            tuple_of(own.type, own.type),
            span,
        )
        equals = core.Builtin("=", TFun(pair.type, BOOL), span, (own.type,))
        test = core.If(core.Apply(equals, pair, BOOL, span), test, false, BOOL, span)
    rules = [core.Rule(pattern, test, span), core.Rule(core.PWild(whole.type, span), false, span)]
    return core.Case(whole, tuple(rules), BOOL, span)


def comparing(pattern: core.Pat, constants: Mapping[Symbol, core.Var]) -> core.Pat:
    """The pattern, which compares with declared values instead of binding their names."""
    match pattern:
        case core.PVar(symbol, t, span) if symbol in constants:
            return core.PEqual(constants[symbol], t, span)
        case core.PAs(pattern=inner):
            return replace(pattern, pattern=comparing(inner, constants))
        case core.PRecord(fields):
            return replace(pattern, fields=tuple((k, comparing(p, constants)) for k, p in fields))
        case core.PCon(argument=inner) if inner is not None:
            return replace(pattern, argument=comparing(inner, constants))
        case _:
            return pattern


def _symbols(pattern: core.Pat) -> list[Symbol]:
    match pattern:
        case core.PVar(symbol):
            return [symbol]
        case core.PAs(symbol, inner):
            return [symbol, *_symbols(inner)]
        case core.PRecord(fields):
            return [x for _, p in fields for x in _symbols(p)]
        case core.PCon(argument=inner) if inner is not None:
            return _symbols(inner)
        case _:
            return []
