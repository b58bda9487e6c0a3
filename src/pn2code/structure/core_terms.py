"""Questions about expressions of the typed core, and new ones made of them."""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TCon, Type
from pn2code.net.uses import walk


def is_multiset(t: Type) -> bool:
    """Whether a type is that of multi-sets."""
    return isinstance(t, TCon) and t.name == "list"


def builtin_of(e: core.Exp) -> str:
    """The name of the built-in function that is applied; "" if none is."""
    if isinstance(e, core.Apply) and isinstance(e.function, core.Builtin):
        return e.function.name
    return ""


def arguments_of(e: core.Exp) -> tuple[core.Exp, ...]:
    """What a function is applied to: both components of a pair, or else the one argument. `e` is an application."""
    assert isinstance(e, core.Apply)
    if isinstance(e.argument, core.RecordExp) and len(e.argument.fields) == 2:
        return pair_of(e.argument)
    return (e.argument,)


def pair_of(e: core.RecordExp) -> tuple[core.Exp, core.Exp]:
    """The components of a record of two, in order."""
    fields = dict(e.fields)
    # The record has two fields.
    return (fields["1"], fields["2"]) if "1" in fields else tuple(fields.values())  # type: ignore[return-value]


def negation_of(e: core.Exp) -> core.Exp | None:
    """The condition of which this is the negation: `not c`, `a <> b`."""
    name = builtin_of(e)
    if name == "<>":
        assert isinstance(e, core.Apply)
        assert isinstance(e.function, core.Builtin)
        equal = core.Builtin("=", e.function.type, e.function.span, e.function.inst)
        return core.Apply(equal, e.argument, e.type, e.span)
    if name in ("Bool.not", "not"):
        return arguments_of(e)[0]
    if isinstance(e, core.If) and is_bool(e.then, "false") and is_bool(e.otherwise, "true"):
        return e.condition
    return None


def is_bool(e: core.Exp, name: str) -> bool:
    """Whether it is the truth value of that name."""
    return (
        isinstance(e, core.Con) and e.constructor.data_type == "bool" and e.constructor.name == name
    )


def whole_record(fields: tuple[tuple[str, core.Exp], ...], e: core.RecordExp) -> core.Exp:
    """`(#1 x, #2 x)` is x."""
    if len(fields) > 0 and all(isinstance(x, core.Select) and x.label == k for k, x in fields):
        records = {x.record for _, x in fields if isinstance(x, core.Select)}
        if len(records) == 1:
            (record,) = records
            if record.type == e.type:
                return record
    return core.RecordExp(fields, e.type, e.span)


def variables_of(e: core.Exp) -> set[core.Symbol]:
    """All variables in an expression."""
    return {x.symbol for x in walk(e) if isinstance(x, core.Var)}


def always_matches(p: core.Pat) -> bool:
    """Whether every value of its type matches a pattern; False where that is not plain to see."""
    match p:
        case core.PVar() | core.PWild():
            return True
        case core.PRecord(fields):
            return all(always_matches(x) for _, x in fields)
        case _:
            return False


def bind_pattern(p: core.Pat, value: core.Exp, values: dict[core.Symbol, core.Exp]) -> bool:
    """Values of the pattern's variables; False if that is not known without evaluation."""
    match p:
        case core.PVar(symbol):
            values[symbol] = value
            return True
        case core.PWild():
            return True
        case core.PRecord(fields):
            parts = dict(value.fields) if isinstance(value, core.RecordExp) else None
            for label, inner in fields:
                part = (
                    parts[label]
                    if parts is not None
                    else core.Select(label, value, inner.type, value.span)
                )
                if not bind_pattern(inner, part, values):
                    return False
            return True
        case _:
            return False


def substituted(e: core.Exp, values: Mapping[core.Symbol, core.Exp]) -> core.Exp:
    """With values for variables; only in expressions that bind none (others are left alone)."""
    match e:
        case core.Var(symbol):
            return values.get(symbol, e)
        case core.Apply(function, argument):
            return core.Apply(
                substituted(function, values), substituted(argument, values), e.type, e.span
            )
        case core.RecordExp(fields):
            made = tuple((k, substituted(x, values)) for k, x in fields)
            return core.RecordExp(made, e.type, e.span)
        case core.Select(label, record):
            return core.Select(label, substituted(record, values), e.type, e.span)
        case core.ListExp(items):
            return core.ListExp(tuple(substituted(x, values) for x in items), e.type, e.span)
        case core.If(condition, then, otherwise):
            c, one, two = (substituted(x, values) for x in (condition, then, otherwise))
            return core.If(c, one, two, e.type, e.span)
        case _:
            return e
