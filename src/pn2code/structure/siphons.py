"""Siphons and traps of the skeleton.

A *siphon* is a set of places that, once empty, stays empty: whatever may put tokens into it must take some from it.
A *trap* is a set that, once marked, stays marked: whatever may take tokens from it must put some into it. With arcs
whose number of tokens varies, "may" is the most and "must" the least of an arc.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from pn2code.structure.skeleton import Mode, Size, Skeleton

NONE = Size(0, 0)


@dataclass(frozen=True, slots=True)
class Rule:
    """`some place of target` needs `some place of source`: what holds for a set that contains a place of `target`."""

    target: frozenset[int]
    source: frozenset[int]


@dataclass(frozen=True, slots=True)
class Sets:
    """Minimal siphons or traps; not all if `complete` is false."""

    found: tuple[frozenset[int], ...]
    complete: bool


def siphon_rules(skeleton: Skeleton) -> list[Rule]:
    """A mode that may put into a siphon must take from it."""
    return _rules(_rule(_may(m.put), _must(m.take)) for m in skeleton.modes)


def trap_rules(skeleton: Skeleton) -> list[Rule]:
    """A mode that may take from a trap must put into it; what a reset empties counts as taken, and is not put."""
    resets: dict[int, set[int]] = {}
    for place, ts in skeleton.resets.items():
        for t in ts:
            resets.setdefault(t, set()).add(place)

    def of(m: Mode) -> Rule:
        emptied = frozenset(resets.get(m.transition, ()))
        return _rule(_may(m.take) | emptied, _must(m.put) - emptied)

    return _rules(map(of, skeleton.modes))


def _may(side: object) -> frozenset[int]:
    assert isinstance(side, dict)
    return frozenset(side)


def _must(side: object) -> frozenset[int]:
    assert isinstance(side, dict)
    return frozenset(p for p, size in side.items() if size.low > 0)


def _rule(target: frozenset[int], source: frozenset[int]) -> Rule:
    return Rule(target - source, source)


def _rules(rules: Iterable[Rule]) -> list[Rule]:
    return list(dict.fromkeys(r for r in rules if r.target))


def largest(rules: Sequence[Rule], within: Iterable[int]) -> frozenset[int]:
    """The largest set within the places that obeys the rules (it may be empty)."""
    inside = set(within)
    # How many sources of each rule are still inside; at none its targets must go.
    counts = [len(r.source & inside) for r in rules]
    uses: dict[int, list[int]] = {}
    for k, r in enumerate(rules):
        for p in r.source:
            uses.setdefault(p, []).append(k)
    todo = [k for k, n in enumerate(counts) if not n]
    while todo:
        for p in rules[todo.pop()].target & inside:
            inside.discard(p)
            for k in uses.get(p, ()):
                counts[k] -= 1
                if not counts[k]:
                    todo.append(k)
    return frozenset(inside)


def minimal(
    rules: Sequence[Rule],
    places: Iterable[int],
    *,
    most: int,
    work: int,
    skip: Callable[[int], bool] = lambda p: False,
) -> Sets:
    """The minimal non-empty sets that obey the rules.

    A set found splits what is left: others lack one of its places (and have the ones before that).

    Args:
        rules: of siphons or of traps.
        places: all of them.
        most: how many sets at most.
        work: how many times a largest set is computed at most, for nets of 100 rules (fewer for larger ones).
        skip: places that are left out.
    """
    everything = frozenset(p for p in places if not skip(p))
    left = max(50, work * 100 // max(100, len(rules)))
    found: dict[frozenset[int], None] = {}
    stack: list[tuple[frozenset[int], frozenset[int]]] = [(everything, frozenset())]
    while stack:
        allowed, required = stack.pop()
        if left <= 0 or len(found) >= most:
            return Sets(_sorted(found), False)
        left -= 1
        whole = largest(rules, allowed)
        if not whole or not required <= whole:
            continue
        candidate = whole
        for p in sorted(whole - required):
            if p in candidate:
                left -= 1
                smaller = largest(rules, candidate - {p})
                if smaller and required <= smaller:
                    candidate = smaller
        left -= len(required)
        if not any(largest(rules, candidate - {p}) for p in required):
            found[candidate] = None
        fixed = required
        pieces = []
        for p in sorted(candidate - required):
            pieces.append((whole - {p}, fixed))
            fixed |= {p}
        stack.extend(reversed(pieces))
    return Sets(_sorted(found), True)


def _sorted(found: Iterable[frozenset[int]]) -> tuple[frozenset[int], ...]:
    return tuple(sorted(found, key=lambda s: (len(s), sorted(s))))
