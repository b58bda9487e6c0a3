"""Siphons and traps of the skeleton.

A *siphon* is a set of places that, once empty, stays empty: whatever may put tokens into it must take some from it.
A *trap* is a set that, once marked, stays marked: whatever may take tokens from it must put some into it. With arcs
whose number of tokens varies, "may" is the most and "must" the least of an arc.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from pn2code.base.frozen import frozen
from pn2code.base.how_far import counting
from pn2code.structure.skeleton import Mode, Size, Skeleton


class Rules:
    """What holds of a set: if it contains a place of a rule's target it contains one of the rule's source.

    Sets of places are bit masks here. Unions of sets that obey obey too, so there is a largest one inside any set.

    Attributes:
        work: how many rules have been looked at.
    """

    def __init__(self, rules: Iterable[tuple[frozenset[int], frozenset[int]]]) -> None:
        unique = dict.fromkeys((t - s, s) for t, s in rules if t - s)
        self._targets = [mask_of(t) for t, _ in unique]
        self._sources = [mask_of(s) for _, s in unique]
        self._uses: dict[int, list[int]] = {}
        for k, (_, source) in enumerate(unique):
            for p in source:
                self._uses.setdefault(p, []).append(k)
        self.work = 0

    def largest(self, within: int) -> int:
        """The largest set within these places that obeys."""
        gone = 0
        for target, source in zip(self._targets, self._sources, strict=True):
            if not source & within:
                gone |= target & within
        self.work += len(self._targets)
        return self._without(within & ~gone, gone)

    def without(self, obeying: int, place: int) -> int:
        """The largest one within a set that obeys, and without a place of it."""
        return self._without(obeying & ~(1 << place), 1 << place)

    def _without(self, inside: int, gone: int) -> int:
        targets, sources, uses = self._targets, self._sources, self._uses
        todo = list(places_of(gone))
        while todo:
            found = uses.get(todo.pop(), ())
            self.work += len(found) + 1
            for k in found:
                lost = targets[k] & inside
                if lost and not sources[k] & inside:
                    inside &= ~lost
                    todo.extend(places_of(lost))
        return inside


def mask_of(places: Iterable[int]) -> int:
    """A set of places as bits."""
    mask = 0
    for p in places:
        mask |= 1 << p
    return mask


def places_of(mask: int) -> Iterator[int]:
    """The places, ascending."""
    while mask:
        lowest = mask & -mask
        yield lowest.bit_length() - 1
        mask ^= lowest


@frozen
class Sets:
    """Minimal siphons or traps; not all if `complete` is false."""

    found: tuple[frozenset[int], ...]
    complete: bool


def siphon_rules(skeleton: Skeleton) -> Rules:
    """A mode that may put into a siphon must take from it."""
    return Rules((frozenset(m.put), _must(m.take)) for m in skeleton.modes)


def trap_rules(skeleton: Skeleton) -> Rules:
    """A mode that may take from a trap must put into it; what a reset empties counts as taken, and is not put."""
    resets: dict[int, set[int]] = {}
    for place, ts in skeleton.resets.items():
        for t in ts:
            resets.setdefault(t, set()).add(place)

    def of(m: Mode) -> tuple[frozenset[int], frozenset[int]]:
        emptied = frozenset(resets.get(m.transition, ()))
        # A place that is emptied does not keep what the same transition puts there.
        return frozenset(m.take) | emptied, _must(m.put) - emptied

    return Rules(map(of, skeleton.modes))


def _must(side: Mapping[int, Size]) -> frozenset[int]:
    return frozenset(p for p, size in side.items() if size.low > 0)


def minimal(rules: Rules, places: Iterable[int], *, most: int, work: int) -> Sets:
    """The minimal non-empty sets that obey the rules.

    A set found splits what is left: others lack one of its places (and have the ones before that).

    Args:
        rules: of siphons or of traps.
        places: those to choose from.
        most: how many sets at most.
        work: how many rules are looked at, at most.
    """
    limit = rules.work + work
    found: dict[int, None] = {}
    stack: list[tuple[int, int]] = [
        (rules.largest(mask_of(places)), 0)
    ]  # obeying set, places it must keep
    more = counting("siphons or traps", noun="sets of places")
    while stack:
        more()
        whole, required = stack.pop()
        if not whole or required & ~whole:
            continue
        if rules.work > limit or len(found) >= most:
            return Sets(_sorted(found), False)
        candidate = whole
        for p in places_of(whole & ~required):
            if candidate >> p & 1:
                smaller = rules.without(candidate, p)
                if smaller and not required & ~smaller:
                    candidate = smaller
        if not any(rules.without(candidate, p) for p in places_of(required)):
            found[candidate] = None
        pieces = []
        for p in places_of(candidate & ~required):
            pieces.append((rules.without(whole, p), required))
            required |= 1 << p
        stack.extend(reversed(pieces))
    return Sets(_sorted(found), True)


def _sorted(found: Iterable[int]) -> tuple[frozenset[int], ...]:
    sets = [frozenset(places_of(mask)) for mask in found]
    return tuple(sorted(sets, key=lambda s: (len(s), sorted(s))))
