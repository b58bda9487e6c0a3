"""Multi-sets that are constants of the declarations, where an inscription names them.

    val start = 1`(0, "none");        a place with the initial marking `start`

How many tokens an inscription gives must be known when a script is made, so the name gives way to what it stands for.
The stamps of a timed one were made when the net began: 1`() @+ 5 in an inscription is a delay, in a constant it is not.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TCon


def opened(e: core.Exp, program: core.Program, *, at_start: bool) -> core.Exp:
    """The same multi-set without names of constants, as far as its size depends on them.

    Args:
        e: the multi-set.
        program: the declarations.
        at_start: whether it is evaluated when the net begins; later on timed constants keep their names.
    """

    def inner(part: core.Exp) -> core.Exp:
        return opened(part, program, at_start=at_start)

    match e:
        case core.Var(symbol) if symbol.is_global and (at_start or not _is_timed(e)):
            value = _value(symbol, program)
            return e if value is None else inner(value)
        case core.If(then=then, otherwise=otherwise):
            return replace(e, then=inner(then), otherwise=inner(otherwise))
        case core.Apply(core.Builtin("Ms.++"), core.RecordExp(((a, left), (b, right))) as pair):
            return replace(e, argument=replace(pair, fields=((a, inner(left)), (b, inner(right)))))
        case core.Apply(
            core.Builtin("Ms.`"), core.RecordExp(((a, core.Var() as n), token)) as pair
        ):
            return replace(e, argument=replace(pair, fields=((a, inner(n)), token)))
        case core.Apply(
            core.Builtin("Time.token@+" | "Time.token@++" | "Time.@+" | "Time.@++"),
            core.RecordExp(((a, value), delay)) as pair,
        ):
            return replace(e, argument=replace(pair, fields=((a, inner(value)), delay)))
        case _:
            return e


def _is_timed(e: core.Var) -> bool:
    match e.type:
        case TCon("list", (TCon("timed"),)):
            return True
    return False


def _value(symbol: core.Symbol, program: core.Program) -> core.Exp | None:
    """What a constant of the declarations stands for; None for functions and for variables of the net."""
    for dec in program.declarations:
        match dec:
            case core.ValBind(core.PVar(bound), value) if bound == symbol:
                return value
            case _:
                pass
    return None
