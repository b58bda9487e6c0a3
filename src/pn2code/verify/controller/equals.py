"""Whether an expression has a given value, as an expression: also of types that have no equality in CPN ML.

known = Equals(program)
known.condition(x, value)      # case x of {x = a, y = b} => Real.== (a, 5.0) andalso ... | _ => false
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import count

from pn2code.diagnostics import Span
from pn2code.lowering.expressions.type_terms import substitute
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import (
    BOOL,
    CHAR,
    INT,
    INTINF,
    REAL,
    STRING,
    TCon,
    TFun,
    TRecord,
    Type,
    tuple_of,
)
from pn2code.semantics.values.data import Data, Value

_LITERALS = (INT, INTINF, STRING, CHAR)


class NoPatternError(Exception):
    """Values of a type that no pattern is made for; the text names the type."""


class Equals:
    """Makes conditions on the values of expressions.

    Args:
        program: the declarations, with the data types.
        uids: gives numbers that no symbol has.
    """

    def __init__(self, program: core.Program, uids: count[int]) -> None:
        self._types: Mapping[str, core.DatatypeDec] = program.datatypes
        self._uids = uids
        booleans = {c.name: c for c, _ in program.datatypes["bool"].constructors}
        self._true, self._false = booleans["true"], booleans["false"]

    def condition(self, e: core.Exp, value: Value) -> core.Exp:
        """That the expression has the value.

        Raises:
            NoPatternError: there is no pattern for values of its type.
        """
        reals: list[tuple[core.Var, float]] = []
        pattern = self._pattern(e.type, value, e.span, reals)
        is_so: core.Exp = core.Con(self._true, BOOL, e.span)
        not_so = core.Con(self._false, BOOL, e.span)
        for part, number in reversed(reals):
            is_so = core.If(_same(part, number), is_so, not_so, BOOL, e.span)
        other = core.Rule(core.PWild(e.type, e.span), not_so, e.span)
        return core.Case(e, (core.Rule(pattern, is_so, e.span), other), BOOL, e.span)

    def all(self, conditions: list[core.Exp], span: Span) -> core.Exp:
        """That all of them hold; where there are none it is so."""
        holds: core.Exp = core.Con(self._true, BOOL, span)
        for condition in reversed(conditions):
            holds = core.If(condition, holds, core.Con(self._false, BOOL, span), BOOL, span)
        return holds

    def none(self, conditions: list[core.Exp]) -> core.Exp:
        """That none of them holds; there is at least one."""
        span = conditions[0].span
        holds: core.Exp = core.Con(self._true, BOOL, span)
        for condition in reversed(conditions):
            holds = core.If(condition, core.Con(self._false, BOOL, span), holds, BOOL, span)
        return holds

    def _pattern(
        self, t: Type, value: Value, span: Span, reals: list[tuple[core.Var, float]]
    ) -> core.Pat:
        if t == REAL:
            assert isinstance(value, float)
            symbol = core.Symbol(next(self._uids), "number", REAL)
            reals.append((core.Var(symbol, REAL, span), value))
            return core.PVar(symbol, REAL, span)
        if t in _LITERALS:
            assert isinstance(value, int | str)
            return core.PLit(value, t, span)
        match t, value:
            case TRecord(fields), tuple():
                parts = tuple(
                    (label, self._pattern(own, x, span, reals))
                    for (label, own), x in zip(fields, value, strict=True)
                )
                return core.PRecord(parts, t, span)
            case TCon("list", (item,)), tuple():
                return self._list(t, item, value, span, reals)
            case TCon(name, arguments), bool() | Data() if name in self._types:
                tag = value.tag if isinstance(value, Data) else -1
                for constructor, argument in self._types[name].constructors:
                    if isinstance(value, bool):
                        if constructor.name == str(value).lower():
                            return core.PCon(constructor, None, t, span)
                    elif constructor.tag == tag:
                        inner = None
                        if argument is not None:
                            own = substitute(argument, dict(enumerate(arguments)))
                            assert value.argument is not None
                            inner = self._pattern(own, value.argument, span, reals)
                        return core.PCon(constructor, inner, t, span)
        raise NoPatternError(str(t))

    def _list(
        self,
        t: Type,
        item: Type,
        values: tuple[Value, ...],
        span: Span,
        reals: list[tuple[core.Var, float]],
    ) -> core.Pat:
        constructors = {c.name: c for c, _ in self._types["list"].constructors}
        found: core.Pat = core.PCon(constructors["nil"], None, t, span)
        pair = tuple_of(item, t)
        for value in reversed(values):
            head = self._pattern(item, value, span, reals)
            both = core.PRecord((("1", head), ("2", found)), pair, span)
            found = core.PCon(constructors["::"], both, t, span)
        return found


def _same(part: core.Var, number: float) -> core.Exp:
    span = part.span
    pair = tuple_of(REAL, REAL)
    function = core.Builtin("Real.==", TFun(pair, BOOL), span)
    both = core.RecordExp((("1", part), ("2", core.Lit(number, REAL, span))), pair, span)
    return core.Apply(function, both, BOOL, span)
