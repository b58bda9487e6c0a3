"""Timed multi-sets of input arcs that are computed, without a delay: `if c then 1`n@+0 else empty`.

CPN Tools takes tokens with the values of the result. With a delay it takes them earlier, but looks whether it can only
at times that come about otherwise (seen with its engine: with `1`3@+1` its clock goes to 6 for a token that is there at
7, with `if c then 1`3@+1 else empty` to 7). So only what has no delay, or the delay 0, is taken for the multi-set
without stamps; and no timed multi-set that was made before (`val late = 1`3@+2`), whose times are those of its
declaration.
"""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TCon, TFun, list_of

MOST_DEPTH = 50


class Stamped:
    """Takes the stamps from timed multi-sets.

    Args:
        program: for its functions.
    """

    def __init__(self, program: core.Program) -> None:
        self._functions: Mapping[int, core.Lambda] = {
            symbol.uid: body
            for dec in program.declarations
            if isinstance(dec, core.RecBind)
            for symbol, body in dec.bindings
        }
        self._met: set[int] = set()
        """Functions that have been looked at for the expression; where one calls itself it gives what it gives else."""

    def tokens(self, e: core.Exp) -> core.Exp | None:
        """The multi-set without stamps; None if it may have a delay."""
        t = e.type
        if not (isinstance(t, TCon) and t.name == "list" and isinstance(t.args[0], TCon)):
            return None
        self._met.clear()
        return self._tokens(e, list_of(t.args[0].args[0]), 0)

    def _tokens(self, e: core.Exp, t: TCon, depth: int) -> core.Exp | None:
        if depth > MOST_DEPTH:
            return None
        match e:
            case core.Sequence((only,)):
                return self._tokens(only, t, depth + 1)
            case core.ListExp(()):
                return core.ListExp((), t, e.span)
            case core.Apply(
                core.Builtin("Time.@+" | "Time.@++"), core.RecordExp((("1", made), ("2", delay)))
            ):
                return made if isinstance(delay, core.Lit) and delay.value == 0 else None
            case core.If():
                parts = self._each((e.then, e.otherwise), t, depth)
                if parts is None:
                    return None
                then, otherwise = parts
                return core.If(e.condition, then, otherwise, t, e.span)
            case core.Case():
                bodies = self._each([rule.body for rule in e.rules], t, depth)
                if bodies is None:
                    return None
                rules = zip(e.rules, bodies, strict=True)
                chosen = tuple(core.Rule(r.pattern, body, r.span) for r, body in rules)
                return core.Case(e.scrutinee, chosen, t, e.span)
            case core.Let():
                inner = self._tokens(e.body, t, depth + 1)
                return None if inner is None else core.Let(e.declarations, inner, t, e.span)
            case core.Apply(core.Var(symbol)) if symbol.uid in self._functions:
                if symbol.uid not in self._met:
                    self._met.add(symbol.uid)
                    bodies = [rule.body for rule in self._functions[symbol.uid].rules]
                    if self._each(bodies, t, depth) is None:
                        return None
                bare = core.Builtin("Time.ms", TFun(e.type, t), e.span, t.args)
                return core.Apply(bare, e, t, e.span)
            case _:
                return None

    def _each(
        self, items: tuple[core.Exp, ...] | list[core.Exp], t: TCon, depth: int
    ) -> list[core.Exp] | None:
        found = [self._tokens(x, t, depth + 1) for x in items]
        known = [x for x in found if x is not None]
        return known if len(known) == len(found) else None
