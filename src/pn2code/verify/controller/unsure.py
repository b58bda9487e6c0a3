"""Conditions of a script that the model works out before the script comes to them: they may raise exceptions.

`stops.waits` makes probes whose guards are asked wherever the tokens are that they read. The script asks them later, or
never. So a guard that raises an exception holds for the probe: whether the script stops there is not known, and it is
taken to wait. A step beside the probe marks that this was so.
"""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, EXN

_TOTAL = frozenset({"=", "<>", "not"})


class Conditions:
    """Makes conditions that raise nothing.

    Args:
        true, false: the constructors of truth values.
    """

    def __init__(self, true: core.Constructor, false: core.Constructor) -> None:
        self._true = true
        self._false = false

    def held(self, guards: Sequence[core.Exp]) -> list[core.Exp]:
        """The guards; each holds where it would raise an exception."""
        return [g if is_total(g) else self._handled(g, g, self._true) for g in guards]

    def unsure(self, guards: Sequence[core.Exp]) -> list[core.Exp] | None:
        """Guards that hold where `held` do and one of the guards raises an exception; None: nowhere."""
        open_ = [g for g in guards if not is_total(g)]
        if not open_:
            return None
        raising = [self._raises(g) for g in open_]
        whole = raising[-1]
        for one in reversed(raising[:-1]):
            whole = core.If(one, self._truth(self._true, one), whole, BOOL, one.span)
        return [*self.held(guards), whole]

    def _raises(self, guard: core.Exp) -> core.Exp:
        """False whatever the guard is; true where it is nothing."""
        rule = core.Rule(core.PWild(BOOL, guard.span), self._truth(self._false, guard), guard.span)
        return self._handled(core.Case(guard, (rule,), BOOL, guard.span), guard, self._true)

    def _handled(self, body: core.Exp, guard: core.Exp, otherwise: core.Constructor) -> core.Exp:
        rule = core.Rule(core.PWild(EXN, guard.span), self._truth(otherwise, guard), guard.span)
        return core.Handle(body, (rule,), BOOL, guard.span)

    @staticmethod
    def _truth(constructor: core.Constructor, guard: core.Exp) -> core.Exp:
        return core.Con(constructor, BOOL, guard.span)


def is_total(e: core.Exp) -> bool:
    """Whether it surely raises no exception: comparisons of variables and constants."""
    match e:
        case core.Lit() | core.Var() | core.Con():
            return True
        case core.RecordExp(fields):
            return all(is_total(x) for _, x in fields)
        case core.Select(record=record):
            return is_total(record)
        case core.If(condition, then, otherwise):
            return all(map(is_total, (condition, then, otherwise)))
        case core.Apply(core.Builtin(name), argument):
            return _compares(name) and is_total(argument)
        case _:
            return False


def _compares(name: str) -> bool:
    return name in _TOTAL or name.rpartition(".")[2] in ("<", "<=", ">", ">=")
