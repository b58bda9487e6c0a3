"""Time inscriptions of transitions as CPN Tools reads them: behind a token, not for themselves.

1`1 and `@+ t + 1` together are (1`1 @+ t) + 1, because `@+` binds as tightly as `*`. That is no delay.
"""

from __future__ import annotations

from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.fixity import Fixities, resolve_expression
from pn2code.ml.parsing.parser import parse_expression

_RUN_FIRST = "before"
"""Its left operand is the whole value, so that nothing changes if that is a token with its delay."""


def is_whole_delay(text: SourceText, fixities: Fixities) -> bool:
    """Whether all that follows `@+` in a correct time inscription is the delay when a token stands before it."""
    silent = Diagnostics()
    delay = parse_expression(text, silent)
    if not isinstance(delay, s.FlatExp):
        return False
    one = s.LitExp(s.LitKind.INT, 1, delay.span)
    token = (one, s.NameExp("`", False, delay.span), one)
    whole = resolve_expression(s.FlatExp((*token, *delay.items), delay.span), fixities, silent)
    while True:
        match whole:
            case s.InfixExp(s.NameExp(name), left, _) if name == _RUN_FIRST:
                whole = left
            case s.HandleExp(exp, rules) if all(isinstance(r.body, s.RaiseExp) for r in rules):
                whole = exp
            case s.InfixExp(s.NameExp(name)):
                return name.startswith("@+")
            case _:
                return False
