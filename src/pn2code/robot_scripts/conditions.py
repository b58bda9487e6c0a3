"""The conditions of a transition in the order of the net, so that none fails where the net does not ask it.

`guard [n > 0]` and an input arc `10 div n`: the guard first. The order is that of the binding plan (docs/semantics.md):
after each of its steps the guards whose variables have values, then tokens that are wanted by inscriptions that cannot
fail; after the last step all others, arc by arc.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.ml.core import terms as core
from pn2code.net.flat import BindAll, BindEquation, BindRandom, BindTerm, FlatTransition, Term
from pn2code.net.total import is_total
from pn2code.net.uses import NetVariables, pattern_variables
from pn2code.robot_scripts.failing import Known
from pn2code.robot_scripts.strict import Done, Owed, open_of
from pn2code.robot_scripts.values import FALSE, TRUE, conjunction
from pn2code.tdl import tree as t

Place = tuple[int, int, int]
"""In the order: after how many steps of the plan, what kind of condition, which of these."""

_MATCH, _GUARD, _TOKEN, _LATE = range(4)


class Order:
    """Where the net asks the conditions of a transition."""

    def __init__(self, transition: FlatTransition, program: core.Program) -> None:
        self._transition = transition
        self._uses = NetVariables(program.variables)
        self._bound: list[set[int]] = [set()]
        self._found: dict[tuple[int, int], int] = {}
        for i, step in enumerate(transition.plan, 1):
            match step:
                case BindTerm(arc, term):
                    self._found[arc, term] = i
                    new = _uids(self._term(arc, term).pattern)
                case BindEquation(_, pattern, _):
                    new = _uids(pattern)
                case BindAll(symbol) | BindRandom(symbol):
                    new = {symbol.uid}
            self._bound.append(self._bound[-1] | new)

    def of_pattern(self, arc: int, index: int) -> Place:
        """Of the pattern of an input arc's term."""
        at = self._found.get((arc, index))
        if at is not None:
            return at, _MATCH, 0
        return self._when(_uids(self._term(arc, index).pattern)), _TOKEN, arc

    def of_equation(self, step: int) -> Place:
        """Of a guard that gives variables their values."""
        return step + 1, _MATCH, 0

    def of_guard(self, guard: int) -> Place:
        """Of a guard."""
        return self._when(self._variables(self._transition.guards[guard])), _GUARD, guard

    def of_value(self, arc: int, term: Term) -> Place:
        """Of an input arc's term that is computed."""
        if is_total(term.value):
            return self._when(self._variables(term.value)), _TOKEN, arc
        return len(self._bound) - 1, _LATE, arc

    def _term(self, arc: int, index: int) -> Term:
        inscription = self._transition.arcs[arc].inscription
        assert inscription is not None
        return inscription.terms[index]

    def _variables(self, e: core.Exp) -> set[int]:
        own = {s.uid for s in self._transition.variables}
        return {s.uid for s in self._uses.of(e)} & own

    def _when(self, needed: set[int]) -> int:
        return next(i for i, bound in enumerate(self._bound) if needed <= bound)


def _uids(pattern: core.Pat | None) -> set[int]:
    return {s.uid for s in pattern_variables(pattern)}


@record
class Asked:
    """Conditions as they are found, in whatever order.

    Args:
        known: what is known of numbers before.
    """

    known: Known
    _found: list[tuple[Place, list[t.Expression], list[Owed]]] = field(default_factory=list)

    def add(self, at: Place, conditions: Iterable[t.Expression], owed: Iterable[Owed] = ()) -> None:
        """Conditions that the net asks at one place, and what it computes for them."""
        self._found.append((at, list(conditions), list(owed)))

    def conditions(self) -> tuple[t.Expression, ...]:
        """All conditions in order, with what has to be computed; those that are never reached are left out."""
        out: dict[t.Expression, None] = {}
        known, done = self.known, Done()
        for _, conditions, owed in sorted(self._found, key=lambda x: x[0]):
            whole = conjunction(conditions)
            value = None if whole in (TRUE, FALSE) else whole
            needed = [o.as_condition() for o in open_of(owed, value, known) if o not in done]
            for c in [*needed, *conditions]:
                if c == TRUE or c in out:
                    continue
                out[c] = None
                if c == FALSE:
                    return _shortened(tuple(out), self.known)
                done.add(c)
                known = known.with_condition(c)
        return tuple(out)


def _shortened(conditions: tuple[t.Expression, ...], known: Known) -> tuple[t.Expression, ...]:
    """Conditions of which the last one is false: those before it count only if they may fail."""
    return conditions if _may_fail(conditions, known) else (FALSE,)


def _may_fail(conditions: Iterable[t.Expression], known: Known) -> bool:
    for c in conditions:
        if known.fails(c):
            return True
        known = known.with_condition(c)
    return False


def all_hold(conditions: Iterable[t.Expression]) -> t.Expression:
    """The conditions as one; where the last one is false, those before it stay that `Asked` has left."""
    found = list(conditions)
    if len(found) > 1 and FALSE in found:
        return t.Binary("and", conjunction(found[: found.index(FALSE)]), FALSE)
    return conjunction(found)
