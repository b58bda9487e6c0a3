"""Stubborn sets of transitions, closed as the explorer does it; is what they promise true in the token game?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.net.flat import FlatNet
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
                _compare(net, game, here, mine, chosen)
    return smaller


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
    net: FlatNet, game: Game, here: Marking, mine: list[BindingElement], chosen: set[int]
) -> None:
    elements = game.enabled_in(here)
    own = [e for e in elements if e.transition in chosen]
    if own != mine:
        names = {
            net.transitions[e.transition].name
            for e in (*own, *mine)
            if e not in own or e not in mine
        }
        raise BrokenError(f"{sorted(names)} are not enabled as before")
    for a in own:
        after_a, _ = game.occur(here, a)
        for u in elements:
            if u.transition in chosen:
                continue
            after_u, _ = game.occur(here, u)
            names = f"{net.transitions[a.transition].name} and {net.transitions[u.transition].name}"
            if u not in game.enabled_in(after_a):
                raise BrokenError(f"{names}: the second is not enabled after the first")
            if (
                a in game.enabled_in(after_u)
                and game.occur(after_a, u)[0] != game.occur(after_u, a)[0]
            ):
                raise BrokenError(f"{names} do not commute")
