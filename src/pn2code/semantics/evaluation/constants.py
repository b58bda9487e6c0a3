"""Values that the front end needs and cannot compute itself: bounds of colour sets, priorities, names of files.

    load(path, d, compute=constants.compute)      # the front end asks where its own folding ends

The engine of CPN Tools evaluates a bound once, where it is declared, with all of CPN ML; so does the evaluator here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from pn2code.diagnostics import Diagnostics
from pn2code.ml.core import terms as core
from pn2code.ml.core.computing import Computed
from pn2code.net import generative
from pn2code.net.uses import pattern_variables, walk
from pn2code.semantics.evaluation.effects import OUTSIDE, Effect, Effects
from pn2code.semantics.evaluation.evaluate import Evaluator, Limits
from pn2code.semantics.evaluation.references import References
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable

LIMITS = Limits(steps=100_000)
"""Of each declaration, and of the expression."""


def compute(program: core.Program, exp: core.Exp, *, fixed: bool, real_time: bool) -> Computed:
    """The value of an expression after the declarations of a net.

    Only the declarations that it uses are evaluated, or all of them if it reads references or asks about colour sets.

    Args:
        program: the declarations before it.
        exp: the expression.
        fixed: whether it must have this value for ever, so that it may not read references.
        real_time: whether the clock is real.
    """
    effects = Effects(program).of(exp)
    if effects & OUTSIDE:
        return Computed(None, "it draws random numbers, or looks at files or clocks")
    if fixed and Effect.READ in effects:
        return Computed(None, "it reads a reference")
    if generative.refuse_beside(program.declarations, [exp], Diagnostics()):
        return Computed(
            None, "it uses an exception that one call of a function may raise for another"
        )
    chosen = _used(program.declarations, exp)
    if Effect.READ in effects or any(
        map(_asks_colset, (exp, *(v for dec in chosen for v in _values(dec))))
    ):
        chosen = list(program.declarations)
    try:
        evaluator = Evaluator(
            replace(program, declarations=tuple(chosen)), real_time=real_time, limits=LIMITS
        )
        references = References(evaluator)
        before = references.contents()
        value = evaluator.value(exp)
    except MlException as raised:
        return Computed(None, f"computing it raises {raised.name}")
    except (MlLimit, MlUnavailable) as reason:
        return Computed(None, str(reason))
    if references.contents() != before:
        return Computed(None, "computing it changes a reference")
    return Computed(value)


def _used(declarations: Sequence[core.Dec], exp: core.Exp) -> list[core.Dec]:
    """The declarations of values that an expression uses, directly or through others, and all others."""
    wanted = _names(exp)
    kept: list[core.Dec] = []
    for dec in reversed(declarations):  # each uses only what stands before it
        if isinstance(dec, core.ValBind | core.RecBind):
            if wanted.isdisjoint(symbol.uid for symbol in _declared(dec)):
                continue
            for value in _values(dec):
                wanted |= _names(value)
        kept.append(dec)
    return kept[::-1]


def _declared(dec: core.ValBind | core.RecBind) -> Iterator[core.Symbol]:
    if isinstance(dec, core.ValBind):
        yield from pattern_variables(dec.pattern)
    else:
        yield from (symbol for symbol, _ in dec.bindings)


def _values(dec: core.Dec) -> Iterator[core.Exp]:
    if isinstance(dec, core.ValBind):
        yield dec.value
    elif isinstance(dec, core.RecBind):
        yield from (function for _, function in dec.bindings)


def _names(exp: core.Exp) -> set[int]:
    return {x.symbol.uid for x in walk(exp) if isinstance(x, core.Var)}


def _asks_colset(exp: core.Exp) -> bool:
    return any(isinstance(x, core.Builtin) and x.name.startswith("Colset.") for x in walk(exp))
