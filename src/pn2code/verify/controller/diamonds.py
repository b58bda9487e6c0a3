"""Why the order in which a supervisor fires does not matter, where it has a choice: any two firings commute.

    pairs = undecided(net, storage, firings, channels)   # None: it is not shown in this way
    ask(questions, pairs)                                # questions that have to be answered with "yes" in each state

*Claim*: if no run of firings goes on for ever, and in each state any two firings that are possible can occur in either
order and lead to the same state, then all runs of firings from a state come to rest in one state (M. Newman, *On
theories with a combinatorial definition of "equivalence"*, 1942). Nothing else occurs between two firings of a cycle.
Two firings t and u are two transitions, or one with two bindings. It is shown that

  one binding     a transition of the supervisor has one binding at most: each variable of it is in a token that it
                  takes, or tests, of a place, or channel, that holds one at most (or follows from such), and its code
                  segment gives nothing
  one urgency     all transitions of the supervisor have the same priority: what one firing enables holds none back
  both at once    no place has to be empty, or is emptied, that the other one changes, nor is one emptied that the
                  other one takes from or tests; and of a place from which one takes tokens the other one neither takes
                  nor tests any, unless the place holds one token, and the two change it in ways that commute
                  (`updates`). What is put there besides hinders nobody: the binding that was enabled still is, and
                  tokens add up in any order; but not where tokens have reals, since of 0.0 and ~0.0, which are one
                  token, a place keeps the sign of what was there first
  never at once   or the two are never enabled together: constants, or an invariant of the net, exclude it
                  (`structure.relations`); or there is no such state among all that the supervisor comes to when it
                  takes any of its firings

Of the last it is asked in states of which each stands for many markings (`exploring.counts`): what is enabled there is
what is enabled in the markings. So a "yes" is certain; nothing is said where one of these is not shown.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import combinations

from pn2code.ml.core import terms as core
from pn2code.ml.core.reals import may_hold_reals
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    FlatNet,
    FlatTransition,
    Term,
)
from pn2code.net.uses import pattern_variables
from pn2code.properties import meaning as m
from pn2code.properties.questions import Questions
from pn2code.structure.relations import Relations, relations
from pn2code.verify.exploring.dependency import Use
from pn2code.verify.exploring.updates import accesses, commute

MOST_PAIRS = 2_000
"""That are asked about."""
Pairs = tuple[tuple[int, int], ...]


def undecided(
    net: FlatNet, storage: Mapping[str, str], firings: Collection[int], channels: Collection[int]
) -> Pairs | None:
    """Pairs of transitions that commute unless both are enabled in one state; None: it is not shown.

    Args:
        net, storage: as for `explore`.
        firings: transitions of the supervisor.
        channels: places that are known to hold one token at most.
    """
    own = [net.transitions[i] for i in sorted(firings)]
    if len({t.priority for t in own}) > 1:
        return None
    known = relations(net, storage)
    single = known.single | set(channels)
    if not all(_has_one_binding(t, single) for t in own):
        return None
    uses = {t.index: _uses(t, known) for t in own}
    found = [
        (t.index, u.index)
        for t, u in combinations(own, 2)
        if not known.exclude(t.index, u.index)
        and any(_clash(net, t, u, p, uses, known) for p in uses[t.index].keys() & uses[u.index])
    ]
    return tuple(found) if len(found) <= MOST_PAIRS else None


def ask(asked: Questions, pairs: Sequence[tuple[int, int]]) -> None:
    """Adds one question for each pair: whether they are never enabled in one state."""
    for t, u in pairs:
        both = m.conjunction(m.Atom("enabled", t), m.Atom("enabled", u))
        asked.asked.append(f"? invariant {asked.item(m.negation(both))}")


def _has_one_binding(t: FlatTransition, single: Collection[int]) -> bool:
    if t.code is not None and t.code.outputs:
        return False
    if any(isinstance(step, BindAll | BindRandom) for step in t.plan):
        return False
    bound = {
        symbol
        for arc in t.arcs
        if arc.place in single
        and arc.kind in (ArcKind.INPUT, ArcKind.BOTH)
        and arc.inscription is not None
        for term in arc.inscription.terms
        if _takes_some(term)
        for symbol in (*pattern_variables(term.pattern), *_alone(term.value))
    }
    equations = [step for step in t.plan if isinstance(step, BindEquation)]
    bound |= {symbol for e in equations for symbol in pattern_variables(e.pattern)}
    return set(t.variables) <= bound


def _takes_some(term: Term) -> bool:
    """Whether a token is surely taken of what the term says: of `n`c` it may be none, and c anything."""
    n = term.coefficient
    return not term.whole and isinstance(n, core.Lit) and isinstance(n.value, int) and n.value > 0


def _alone(value: core.Exp) -> tuple[core.Symbol, ...]:
    """The variable that an expression is."""
    return (value.symbol,) if isinstance(value, core.Var) else ()


def _uses(t: FlatTransition, known: Relations) -> dict[int, Use]:
    found: dict[int, Use] = {}
    for arc in t.arcs:
        found.setdefault(arc.place, Use()).add(arc)
    for p in known.kept[t.index]:
        found[p].keep()
    return found


def _clash(
    net: FlatNet,
    t: FlatTransition,
    u: FlatTransition,
    place: int,
    uses: Mapping[int, Mapping[int, Use]],
    known: Relations,
) -> bool:
    """Whether the one may hinder the other at a place, or lead to another marking of it."""
    one, other = uses[t.index][place], uses[u.index][place]
    if (one.changes or other.changes) and may_hold_reals(
        net.places[place].colset.type, net.program.datatypes
    ):
        return True
    if any(_disturbs(a, b) for a, b in ((one, other), (other, one))):
        return True
    if not ((one.takes and other.demands) or (other.takes and one.demands)):
        return False
    if place not in known.single:
        return True
    mine, its = accesses(net, t, place), accesses(net, u, place)
    return mine is None or its is None or not commute(mine, its)


def _disturbs(one: Use, other: Use) -> bool:
    """Whether a place has to be empty for the one, or is emptied by it, of which the other one is not independent."""
    return (one.inhibits and other.changes) or (one.clears and (other.changes or other.demands))
