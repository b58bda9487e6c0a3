"""Multi-sets that are constants of the declarations, where an inscription names them.

    val start = 1`(0, "none");        a place with the initial marking `start`

How many tokens an inscription gives must be known when a script is made, so the name gives way to what it stands for.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.ml.core import terms as core


def opened(e: core.Exp, program: core.Program) -> core.Exp:
    """The same multi-set without names of constants, as far as its size depends on them."""
    match e:
        case core.Var(symbol):
            value = _value(symbol, program)
            return e if value is None else opened(value, program)
        case core.If(then=then, otherwise=otherwise):
            return replace(e, then=opened(then, program), otherwise=opened(otherwise, program))
        case core.Apply(core.Builtin("Ms.++"), core.RecordExp(((a, left), (b, right))) as pair):
            sides = ((a, opened(left, program)), (b, opened(right, program)))
            return replace(e, argument=replace(pair, fields=sides))
        case core.Apply(
            core.Builtin("Ms.`"), core.RecordExp(((a, core.Var() as n), token)) as pair
        ):
            return replace(e, argument=replace(pair, fields=((a, opened(n, program)), token)))
        case core.Apply(
            core.Builtin("Time.token@+" | "Time.token@++" | "Time.@+" | "Time.@++"),
            core.RecordExp(((a, value), delay)) as pair,
        ):
            return replace(e, argument=replace(pair, fields=((a, opened(value, program)), delay)))
        case _:
            return e


def _value(symbol: core.Symbol, program: core.Program) -> core.Exp | None:
    """What a constant of the declarations stands for; None for functions and for variables of the net."""
    for dec in program.declarations:
        match dec:
            case core.ValBind(core.PVar(bound), value) if bound == symbol:
                return value
            case _:
                pass
    return None
