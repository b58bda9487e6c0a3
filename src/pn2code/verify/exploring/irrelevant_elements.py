"""Binding elements that no shortest way to a dead marking has in it.

found = irrelevant(unfolding)      # for each element; the stubborn sets look at the others only

A shortest way has nothing in it that could be left out with the same end. Three rules find elements of which each
occurrence could be left out, or cannot be on a way to a dead marking:

* it changes nothing;
* it ends a *round*: it takes a token from an inner place, and wherever that token came from, through inner places
  back to where it began, all these occurrences together change nothing, and until then they have only taken tokens
  (a philosopher takes one fork, the other one, and puts both back). Inner places are empty at first and nobody only
  looks at their tokens, so nobody misses the round when it is left out: there are at least as many tokens as before;
* it puts a token where only irrelevant elements take it away, and where one of them needs no other token: the marking
  at the end would not be dead.

Nets with inhibitor or reset arcs, for which more tokens are not always better, have none here.
"""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.unfold.net import UnfoldedTransition, Unfolding

LONGEST_ROUND = 8
WORK = 2_000_000
"""Steps back that are looked at in all; a net that needs more has no irrelevant elements, so that it is the same for
elements that are symmetric."""


class _TooMuchError(Exception):
    pass


def irrelevant(u: Unfolding) -> tuple[bool, ...]:
    """For each element whether it is irrelevant."""
    if any(t.inhibitors or t.resets for t in u.transitions):
        return (False,) * len(u.transitions)
    try:
        rounds = _Rounds(u)
        found = [rounds.is_end(t) for t in u.transitions]
    except _TooMuchError:
        return (False,) * len(u.transitions)
    _dead_ends(u, found)
    return tuple(found)


def _effect(t: UnfoldedTransition, p: int) -> int:
    return t.post.get(p, 0) - t.pre.get(p, 0)


class _Rounds:
    def __init__(self, u: Unfolding) -> None:
        self.producers: list[list[UnfoldedTransition]] = [[] for _ in u.places]
        self.is_inner = [p.initial == 0 for p in u.places]
        self.work = 0
        for t in u.transitions:
            for p in t.post:
                if _effect(t, p) > 0:
                    self.producers[p].append(t)
            for p, n in t.pre.items():
                if n > 1 or p in t.post:
                    self.is_inner[p] = False

    def is_end(self, t: UnfoldedTransition) -> bool:
        """Whether it changes nothing, or ends a round."""
        if t.pre == t.post:
            return True
        return any(self.is_inner[q] and self._comes_round(q, [t], [q]) for q in t.pre)

    def _comes_round(
        self, q: int, after: Sequence[UnfoldedTransition], inner: Sequence[int]
    ) -> bool:
        """Whether every token of q is from a round that `after` ends; `inner`: the places between, the first is q."""
        return all(
            _is_round((x, *after), inner)
            or (
                len(after) < LONGEST_ROUND - 1
                and any(
                    self.is_inner[p]
                    and p not in inner
                    and self._comes_round(p, (x, *after), (p, *inner))
                    for p in self._step(x)
                )
            )
            for x in self.producers[q]
        )

    def _step(self, x: UnfoldedTransition) -> Sequence[int]:
        self.work += 1 + len(x.pre)
        if self.work > WORK:
            raise _TooMuchError
        return tuple(x.pre)


def _is_round(chain: Sequence[UnfoldedTransition], inner: Sequence[int]) -> bool:
    """Whether a chain of elements, each takes what the one before has put into the place between, changes nothing at
    the end and only takes tokens until then, but for the one between.
    """
    sums: dict[int, int] = {}
    for i, t in enumerate(chain):
        for p in t.pre.keys() | t.post.keys():
            sums[p] = sums.get(p, 0) + _effect(t, p)
        between = inner[i] if i < len(inner) else None
        for p, n in sums.items():
            if n > (1 if p == between else 0):
                return False
        if between is not None and sums.get(between) != 1:
            return False
    return not any(sums.values())


def _dead_ends(u: Unfolding, found: list[bool]) -> None:
    """Adds the elements that put a token where it stays, and lets something be enabled."""
    takers: list[list[int]] = [[] for _ in u.places]  # elements that take tokens away
    enough: list[int | None] = [None] * len(u.places)  # tokens with which something is enabled
    for t in u.transitions:
        for p, n in t.pre.items():
            if _effect(t, p) < 0:
                takers[p].append(t.index)
            least = enough[p]
            if len(t.pre) == 1 and (least is None or n < least):
                enough[p] = n
    changed = True
    while changed:
        changed = False
        stays = [
            least is not None and all(found[i] for i in takers[p]) for p, least in enumerate(enough)
        ]
        for t in u.transitions:
            if not found[t.index] and any(
                stays[p] and _effect(t, p) >= (enough[p] or 0) for p in t.post
            ):
                found[t.index] = changed = True
