"""Stubborn sets of transitions, closed as the explorer does it; is what they promise true in the token game?

Where a place holds one token, a transition may occur with another value of a variable that only stands on the arcs
between the two: elements that differ in such variables count as one, if they come to the same marking in either order.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.ml.core.terms import Symbol, Var
from pn2code.net.flat import FlatNet
from pn2code.net.uses import walk
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.verify.exploring.dependency import Dependency, Member

MOST_OUTSIDE = 25
"""Markings that are looked at without anything of the set having occurred."""


class BrokenError(AssertionError):
    """A set does not keep what it promises."""


def closed(
    net: FlatNet, table: Dependency, marking: Marking, enabled: set[int], first: int
) -> set[int]:
    """The set that begins with an enabled transition; all transitions where there is none that is smaller."""
    urgency = net.transitions[first].priority
    found, todo = {first}, [first]
    while todo:
        t = todo.pop()
        member = table.members[t]
        if t in enabled:
            if member.is_spoiling:
                return set(range(len(net.transitions)))
            more = {*member.rivals, *(u.index for u in net.transitions if u.priority < urgency)}
        elif net.transitions[t].priority <= urgency:
            more = _helpers(member, marking, found)
        else:
            more = set()
        todo += more - found
        found |= more
    return found


def _helpers(member: Member, marking: Marking, found: set[int]) -> set[int]:
    sets = [set(member.helpers)]
    for r in member.reasons:
        total = sum(1 for _ in marking.places[r.place])
        if total < r.least or (r.least == 0 and total > 0):
            sets.append(set(r.helpers))
    reasons = sets[1:] or sets
    return min(reasons, key=lambda s: len(s - found))


def check(net: FlatNet, table: Dependency, markings: Sequence[Marking], game: Game) -> int:
    """Looks at all sets in all these markings; gives how many were less than all that is enabled.

    Raises:
        BrokenError: an element of a set, and what occurs outside of it, do not commute.
    """
    smaller = 0
    hidden = _hidden(net, markings)
    for marking in markings:
        elements = game.enabled_in(marking)
        enabled = {e.transition for e in elements}
        for first in sorted(enabled):
            chosen = closed(net, table, marking, enabled, first)
            if enabled <= chosen:
                continue
            smaller += 1
            mine = [e for e in elements if e.transition in chosen]
            for here in _outside(game, marking, chosen):
                _compare(net, game, here, mine, chosen, hidden)
    return smaller


def _hidden(net: FlatNet, markings: Sequence[Marking]) -> set[tuple[int, Symbol]]:
    """Variables of transitions that stand only on arcs to one place, which never holds two tokens."""
    lone = {
        p.index for p in net.places if all(sum(1 for _ in m.places[p.index]) <= 1 for m in markings)
    }
    found = set()
    for t in net.transitions:
        texts = [(a.place, a.inscription.value) for a in t.arcs if a.inscription]
        texts += [(-1, g) for g in t.guards]
        texts += [(-1, t.code.action)] if t.code else []
        inputs = t.code.inputs if t.code else ()
        for s in t.variables:
            where = {
                p for p, e in texts if any(isinstance(x, Var) and x.symbol == s for x in walk(e))
            }
            if len(where) == 1 and where <= lone and s not in inputs:
                found.add((t.index, s))
    return found


def _shown(
    elements: Sequence[BindingElement], hidden: set[tuple[int, Symbol]]
) -> list[tuple[tuple[int, str], BindingElement]]:
    """The elements, each after what it is without such variables."""
    found = []
    for e in elements:
        values = [(s.name, v) for s, v in e.values if (e.transition, s) not in hidden]
        found.append(((e.transition, repr(values)), e))
    return found


def _outside(game: Game, marking: Marking, chosen: set[int]) -> Iterator[Marking]:
    """Markings that are reached without anything of the set."""
    seen, todo = {marking}, [marking]
    for here in todo:
        yield here
        for e in game.enabled_in(here):
            if e.transition not in chosen and len(seen) < MOST_OUTSIDE:
                after, _ = game.occur(here, e)
                if after not in seen:
                    seen.add(after)
                    todo.append(after)


def _compare(
    net: FlatNet,
    game: Game,
    here: Marking,
    mine: list[BindingElement],
    chosen: set[int],
    hidden: set[tuple[int, Symbol]],
) -> None:
    elements = _shown(game.enabled_in(here), hidden)
    before = sorted(key for key, _ in _shown(mine, hidden))
    own = [(key, e) for key, e in elements if e.transition in chosen]
    if sorted(key for key, _ in own) != before:
        changed = {k for k, _ in own}.symmetric_difference(before)
        raise BrokenError(
            f"{sorted({net.transitions[t].name for t, _ in changed})} are not enabled as before"
        )
    for key_a, a in own:
        after_a, _ = game.occur(here, a)
        for key_u, u in elements:
            if u.transition in chosen:
                continue
            after_u, _ = game.occur(here, u)
            names = f"{net.transitions[a.transition].name} and {net.transitions[u.transition].name}"
            seconds = [e for key, e in _shown(game.enabled_in(after_a), hidden) if key == key_u]
            if not seconds:
                raise BrokenError(f"{names}: the second is not enabled after the first")
            firsts = [e for key, e in _shown(game.enabled_in(after_u), hidden) if key == key_a]
            if firsts and {game.occur(after_a, e)[0] for e in seconds} != {
                game.occur(after_u, e)[0] for e in firsts
            }:
                raise BrokenError(f"{names} do not commute")
