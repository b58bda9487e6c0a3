"""Guard equations that CPN Tools cannot check, although they only test.

It looks at every condition `a = b` for a side that binds variables, a pattern with at least one. Where there is none it
counts the variables of both sides, and takes a variable that one side has twice for an unknown one: `x * x = 4`.
"""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.diagnostics import Diagnostics, Span
from pn2code.ml.core.terms import Apply, Builtin, Exp, RecordExp, Symbol
from pn2code.net.codes import GUARD_REPEATS
from pn2code.net.terms import TermReader
from pn2code.net.uses import NetVariables, pattern_variables


def warn(
    guards: Sequence[Exp], terms: TermReader, variables: NetVariables, name: str, d: Diagnostics
) -> None:
    """Warn of equations in the guard of transition `name` that keep CPN Tools from checking it."""
    for found in filter(None, (_repeated(guard, terms, variables) for guard in guards)):
        symbol, span = found
        d.warning(
            GUARD_REPEATS,
            f"CPN Tools cannot check transition `{name}`: one side of an equation in its guard has `{symbol.name}` "
            "twice, and no side is a pattern with variables",
            span,
            label="once more",
            hint="write `andalso true` behind the equation: then CPN Tools only tests it",
        )


def repeated(
    guards: Sequence[Exp], terms: TermReader, variables: NetVariables
) -> tuple[Symbol, Span] | None:
    """The first variable that is twice on a side of such an equation, and its second place."""
    return next(filter(None, (_repeated(guard, terms, variables) for guard in guards)), None)


def _repeated(guard: Exp, terms: TermReader, variables: NetVariables) -> tuple[Symbol, Span] | None:
    """The variable that one side of an equation without a binding side has twice, and its second place."""
    match guard:
        case Apply(Builtin("=") as operator, RecordExp((("1", left), ("2", right)))):
            sides = (left, right)
        case _:
            return None
    is_call = operator.span.text.startswith("op")
    if is_call or any(pattern_variables(terms.pattern(side)) for side in sides):
        return None
    for side in sides:
        first: dict[Symbol, Span] = {}
        for symbol, span in variables.sights(side):
            if symbol in first and first[symbol] != span:
                return symbol, span
            first.setdefault(symbol, span)
    return None
