"""Structural reductions to a fixed point, for one question.

    reduced = reduced_for(tables, [condition], until=deadline)
    reduced.tables, reduced.condition(condition)      # a smaller net, and the question in its places

Which rules apply depends on what the question needs: each rule of the table says what it keeps, and where it is from.
The net need not be reduced to the end: after each rule it is equivalent to the one before.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from pn2code.base.frozen import frozen
from pn2code.contest import conditions
from pn2code.contest.conditions import AtMost, Condition, Dead
from pn2code.contest.reduction import agglomerations, places, transitions
from pn2code.contest.reduction.net import Goal, Net
from pn2code.contest.tables import Tables

ALL = tuple(Goal)
STUTTERING = (Goal.REACHABILITY, Goal.DEADLOCK, Goal.LINEAR, Goal.BRANCHING)
REACHABILITY = (Goal.REACHABILITY,)
BERTHELOT = "Berthelot 1987, Transformations and decompositions of nets"
THIERRY_MIEG = "Thierry-Mieg 2020, Structural reductions revisited"
SLICING = "Rakow 2012, Safety slicing Petri nets"
COLOM_SILVA = "Colom, Silva 1991, Improving the linearly based characterization of P/T nets"
MURATA = "Murata 1989, Petri nets: properties, analysis and applications"


@frozen
class Rule:
    """A reduction.

    Args:
        apply: changes the net; how often it has.
        keeps: for which goals it may be used.
        source: where it is from.
    """

    apply: Callable[[Net], int]
    keeps: tuple[Goal, ...]
    source: str

    @property
    def name(self) -> str:
        """The name of the rule."""
        return self.apply.__name__


RULES = (
    Rule(transitions.dead_transitions, ALL, MURATA),
    Rule(places.constant_places, ALL, THIERRY_MIEG),
    Rule(transitions.irrelevant_parts, REACHABILITY, SLICING),
    Rule(places.sink_places, ALL, THIERRY_MIEG),
    Rule(transitions.idle_transitions, REACHABILITY, BERTHELOT),
    Rule(transitions.losing_transitions, REACHABILITY, THIERRY_MIEG),
    Rule(transitions.identical_transitions, ALL, BERTHELOT),
    Rule(places.proportional_places, ALL, COLOM_SILVA),
    Rule(places.implied_places, ALL, COLOM_SILVA),
    Rule(places.common_weights, ALL, THIERRY_MIEG),
    Rule(agglomerations.free_moves, STUTTERING, THIERRY_MIEG),
    Rule(agglomerations.post_agglomeration, STUTTERING, BERTHELOT),
    Rule(agglomerations.pre_agglomeration, STUTTERING, BERTHELOT),
)


class Reduced:
    """A smaller net.

    Args:
        net: as the rules have left it.

    Attributes:
        tables: the net; no ids lead to its places and transitions.
    """

    def __init__(self, net: Net) -> None:
        self._net = net
        self._numbers = {p: i for i, p in enumerate(net.marking)}
        self.tables = _tables(net, self._numbers)

    def condition(self, c: Condition) -> Condition:
        """A question that the net was reduced for, in its places."""
        return conditions.mapped(c, lambda a: conditions.at_most(*self._moved(a)))

    def sum(self, c: AtMost) -> tuple[AtMost, int]:
        """A sum in places of the net, without its limit, and the constant that has to be added to it."""
        factors, limit = self._moved(AtMost(c.factors, 0))
        return AtMost(tuple(sorted((p, n) for p, n in factors.items() if n)), 0), -limit

    def _moved(self, c: AtMost) -> tuple[dict[int, int], int]:
        factors: dict[int, int] = {}
        limit = c.limit
        for p, n in c.factors:
            value = self._net.value(p)
            limit -= n * value.constant
            for q, m in value.factors.items():
                at = self._numbers[q]
                factors[at] = factors.get(at, 0) + n * m
        return factors, limit


def reduced_for(
    tables: Tables,
    asked: Sequence[Condition],
    *,
    until: float,
    rules: Sequence[Rule] = RULES,
    goal: Goal = Goal.REACHABILITY,
) -> Reduced:
    """The net reduced for some questions together.

    Args:
        tables: the net.
        asked: conditions whose reachability is asked, sums that are to be largest; or `Dead` alone.
        until: when to stop, on the monotonic clock.
        rules: to be used.
        goal: what has to be kept of the conditions; for `Dead` there is only one.
    """
    is_dead = any(isinstance(c, Dead) for c in asked)
    assert not is_dead or len(asked) == 1
    goal = Goal.DEADLOCK if is_dead else goal
    net = Net(tables, set().union(*map(conditions.places, asked)), goal)
    apply_all(net, [r for r in rules if goal in r.keeps], until)
    return Reduced(net)


def apply_all(net: Net, rules: Sequence[Rule], until: float) -> None:
    """Rule after rule, until none changes anything or the time is over."""
    since = 0
    while since < len(rules):
        for rule in rules:
            since = 0 if rule.apply(net) else since + 1
            if since >= len(rules) or time.monotonic() > until:
                return


def _tables(net: Net, numbers: dict[int, int]) -> Tables:
    return Tables(
        tuple(net.marking.values()),
        tuple({numbers[p]: n for p, n in arcs.items()} for arcs in net.pre.values()),
        tuple({numbers[p]: n for p, n in net.post[t].items()} for t in net.pre),
        {},
        {},
    )
