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
  enough          or of a place of one colour there are as many tokens as the two demand together, in each state in
                  which both are enabled
  never at once   or the two are never enabled together: constants, or an invariant of the net, exclude it
                  (`structure.relations`); or there is no such state among all that the supervisor comes to when it
                  takes any of its firings

Of the last two it is asked in states of which each stands for many markings (`exploring.counts`): what is enabled there
is what is enabled in the markings, and where there is enough there, they have enough. So a "yes" is certain; nothing is
said where one of these is not shown.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import combinations

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.reals import may_hold_reals
from pn2code.net.enumerable import size
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
from pn2code.verify.exploring.counts import demanded_by
from pn2code.verify.exploring.dependency import Use
from pn2code.verify.exploring.updates import accesses, commute

MOST_PAIRS = 2_000
"""That are asked about."""
MOST_DEMANDED = 8
"""Tokens of a place by a pair."""


@frozen
class Pair:
    """Two transitions that commute in each state in which they are not both enabled.

    Args:
        enough: places that hold so many tokens where both are enabled, and then they commute as well; none: nothing
            else is known of them.
    """

    first: int
    second: int
    enough: tuple[tuple[int, int], ...] = ()


Pairs = tuple[Pair, ...]


def undecided(
    net: FlatNet, storage: Mapping[str, str], firings: Collection[int], channels: Collection[int]
) -> Pairs | None:
    """Pairs of transitions that are not known to commute in each state; None: it is not shown.

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
    found: list[Pair] = []
    for t, u in combinations(own, 2):
        both = sorted(uses[t.index].keys() & uses[u.index])
        where = [p for p in both if _clash(net, t, u, p, uses, known)]
        if where and not known.exclude(t.index, u.index):
            needs = [(p, _enough(net, t, u, p, uses)) for p in where]
            enough = tuple((p, n) for p, n in needs if n is not None)
            found.append(Pair(t.index, u.index, enough if len(enough) == len(needs) else ()))
    return tuple(found) if len(found) <= MOST_PAIRS else None


def demanded(pairs: Pairs) -> dict[int, int]:
    """By place, up to which number its tokens have to be known for what is asked."""
    found: dict[int, int] = {}
    for place, n in (x for pair in pairs for x in pair.enough):
        found[place] = max(n, found.get(place, 0))
    return found


def ask(asked: Questions, pairs: Sequence[Pair]) -> None:
    """Adds one question for each pair: whether where both are enabled there is enough, if that helps."""
    for pair in pairs:
        both = m.conjunction(m.Atom("enabled", pair.first), m.Atom("enabled", pair.second))
        found = asked.item(m.negation(both))
        if pair.enough:
            enough = asked.item(m.TRUE)
            for place, n in pair.enough:
                enough = asked.line(f"and {enough} {asked.line(f'within {place} {n} -')}")
            found = asked.line(f"or {found} {enough}")
        asked.asked.append(f"? invariant {found}")


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


def _enough(
    net: FlatNet,
    t: FlatTransition,
    u: FlatTransition,
    place: int,
    uses: Mapping[int, Mapping[int, Use]],
) -> int | None:
    """With how many tokens of a place at which the two clash they commute there; None: that does not depend on it."""
    colset = net.places[place].colset
    one, other = uses[t.index][place], uses[u.index][place]
    if colset.timed or size(colset, 1) != 1 or _disturbs(one, other) or _disturbs(other, one):
        return None
    total = 0
    for arc in (a for x in (t, u) for a in x.arcs if a.place == place):
        if arc.kind in (ArcKind.INPUT, ArcKind.BOTH):
            n = demanded_by(arc)
            if n is None:
                return None
            total += n
    return total if total <= MOST_DEMANDED else None


def _disturbs(one: Use, other: Use) -> bool:
    """Whether a place has to be empty for the one, or is emptied by it, of which the other one is not independent."""
    return (one.inhibits and other.changes) or (one.clears and (other.changes or other.demands))
