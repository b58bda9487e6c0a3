"""What a computed number of seconds can be: of a wait (`pause (real k)`), or of a delay (`@+ k`).

    durations = Durations(net, storage)
    durations.values(argument, {})       # (0.5,), or those for all `k` of a small colour set; None: not known

An expression is evaluated for all values of its variables. Those of a variable of the net are the values of its colour
set, if they are few; those of a parameter or of a local name are what it is given.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any

from pn2code.ml.core import terms as core
from pn2code.net.enumerable import size as number_of_values
from pn2code.net.flat import FlatNet
from pn2code.net.uses import pattern_variables, walk
from pn2code.semantics.evaluation.evaluate import Limits
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.data import MlException, MlLimit, MlUnavailable
from pn2code.structure.symbolic import Symbolic

MOST_VALUES = 2_000
"""For more combinations of its variables an expression is not evaluated."""
_STEPS = 50_000

Known = Mapping[int, tuple[Any, ...]]
"""The values that a name can have, by the number of its symbol."""
NOTHING: Known = MappingProxyType({})


class Durations:
    """The durations of a net; `storage`: as for `Game`."""

    def __init__(self, net: FlatNet, storage: Mapping[str, str]) -> None:
        self._net = net
        self._storage = storage
        variables = net.program.variables.values()
        # What a code segment gives need not be in the colour set of the variable.
        given = {s.uid for t in net.transitions if t.code is not None for s in t.code.outputs}
        self._variables = {s.uid: s for s in variables if s.uid not in given}

    @cached_property
    def _symbolic(self) -> Symbolic:
        try:
            return Symbolic(self._net, Game(self._net, self._storage).evaluator)
        except GameError:  # whoever plays the net says so
            return Symbolic(self._net, None)

    def seconds(self, e: core.Exp, known: Known = NOTHING) -> float | None:
        """The most seconds that an expression can mean; None: it is not known."""
        values = self.values(e, known)
        if values is None or not all(isinstance(v, int | float) for v in values):
            return None
        most = max(map(float, values), default=0.0)
        return most if math.isfinite(most) else None

    def values(self, e: core.Exp, known: Known = NOTHING) -> tuple[Any, ...] | None:
        """All values that an expression can have, or more; None: they are not known."""
        match e:
            case core.Lit(value):
                return (value,)
            case core.If(_, then, otherwise):
                both = self.values(then, known), self.values(otherwise, known)
                return None if both[0] is None or both[1] is None else (*both[0], *both[1])
        evaluator = self._symbolic.evaluator
        if evaluator is None or not self._symbolic.is_timeless(e):
            return None
        free = _free(e)
        choices = [self._of_symbol(symbol, known) for symbol in free]
        found = [c for c in choices if c is not None]
        if len(found) < len(free) or math.prod(map(len, found)) > MOST_VALUES:
            return None
        before, evaluator.limits = evaluator.limits, Limits(steps=_STEPS, depth=_STEPS)
        values: list[Any] = []
        try:
            for row in itertools.product(*found):
                try:
                    values.append(evaluator.value(e, dict(zip(free, row, strict=True))))
                except MlException:
                    continue  # then the script stops, which is looked at elsewhere
        except (MlLimit, MlUnavailable, RecursionError):
            return None
        finally:
            evaluator.limits = before
        return tuple(values)

    def _of_symbol(self, symbol: core.Symbol, known: Known) -> tuple[Any, ...] | None:
        if symbol.uid in known:
            return known[symbol.uid]
        variable = self._variables.get(symbol.uid)
        evaluator = self._symbolic.evaluator
        if variable is None or variable.colset is None or evaluator is None:
            return None
        if number_of_values(variable.colset, MOST_VALUES) is None:
            return None
        return tuple(evaluator.colours.all(variable.colset))

    def bind(self, pattern: core.Pat, value: core.Exp, known: Known) -> Known:
        """What is known after a name, or a tuple of names, has been given a value."""
        match pattern, value:
            case core.PVar(symbol), _:
                values = self.values(value, known)
                return known if values is None else {**known, symbol.uid: values}
            case core.PRecord(names), core.RecordExp(fields):
                given = dict(fields)
                for label, part in names:
                    known = self.bind(part, given[label], known) if label in given else known
                return known
        return known


def _free(e: core.Exp) -> list[core.Symbol]:
    """The names in an expression that are bound neither inside it nor at top level, each once."""
    used: dict[core.Symbol, None] = {}
    inside: set[core.Symbol] = set()
    for x in walk(e):
        match x:
            case core.Var(symbol=symbol) if not symbol.is_global:
                used.setdefault(symbol)
            case core.Lambda(rules=rules) | core.Case(rules=rules) | core.Handle(rules=rules):
                inside |= _bound(rule.pattern for rule in rules)
            case core.Let(declarations=declarations):
                for d in declarations:
                    if isinstance(d, core.ValBind):
                        inside |= _bound((d.pattern,))
                    elif isinstance(d, core.RecBind):
                        inside |= {symbol for symbol, _ in d.bindings}
    return [symbol for symbol in used if symbol not in inside]


def _bound(patterns: Iterable[core.Pat]) -> set[core.Symbol]:
    return {symbol for pattern in patterns for symbol in pattern_variables(pattern)}
