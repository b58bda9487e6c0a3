"""A net that reductions change in place.

    net = Net(tables, visible={3, 7}, goal=Goal.REACHABILITY)

Places and transitions keep their numbers; what is removed is no longer in the mappings. A visible place may go too if
its tokens follow from those of others: `known` says how.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.contest.tables import Tables


class Goal(Enum):
    """What a reduction has to keep."""

    REACHABILITY = "the markings of the visible places that are reachable"
    DEADLOCK = "whether a dead marking is reachable; no place is visible"
    LINEAR = "what maximal paths see of the visible places, however often"
    BRANCHING = "what can be said of the visible places in CTL* without next"
    STEPS = "the graph of all markings, but for what is invisible in them"


@frozen
class Affine:
    """Tokens of a place that was removed: a constant and factors of other places."""

    constant: int
    factors: Mapping[int, int]


class Net:
    """The net, with the arcs at both ends.

    Args:
        tables: the net as it was.
        visible: places that the question looks at.
        goal: what has to be kept.

    Attributes:
        marking: place -> tokens.
        pre: transition -> what it takes.
        post: transition -> what it puts.
        takers: place -> transitions that need tokens there.
        putters: place -> transitions that put tokens there.
        known: places that were removed, whose tokens follow from others.
        transitions_before: how many there were.
    """

    def __init__(self, tables: Tables, visible: Iterable[int], goal: Goal) -> None:
        self.goal = goal
        self.visible = set(visible)
        assert goal is not Goal.DEADLOCK or not self.visible
        self.marking = dict(enumerate(tables.initial))
        self.pre = {t: dict(arcs) for t, arcs in enumerate(tables.pre)}
        self.post = {t: dict(arcs) for t, arcs in enumerate(tables.post)}
        self.takers: dict[int, set[int]] = {p: set() for p in self.marking}
        self.putters: dict[int, set[int]] = {p: set() for p in self.marking}
        for ends, arcs in ((self.takers, self.pre), (self.putters, self.post)):
            for t, of in arcs.items():
                for p in of:
                    ends[p].add(t)
        self.known: dict[int, Affine] = {}
        self.next = self.transitions_before = len(self.pre)

    def effect(self, t: int) -> dict[int, int]:
        """What a transition puts minus what it takes, where that is not 0."""
        found = dict(self.post[t])
        for p, n in self.pre[t].items():
            left = found.pop(p, 0) - n
            if left:
                found[p] = left
        return found

    def row(self, p: int) -> dict[int, int]:
        """How much each transition changes a place, where that is not 0."""
        found = {}
        for t in self.takers[p] | self.putters[p]:
            change = self.post[t].get(p, 0) - self.pre[t].get(p, 0)
            if change:
                found[t] = change
        return found

    def is_invisible(self, t: int) -> bool:
        """Whether a transition changes no visible place."""
        pre, post = self.pre[t], self.post[t]
        return all(
            pre.get(p, 0) == post.get(p, 0)
            for arcs in (pre, post)
            for p in arcs
            if p in self.visible
        )

    def add_transition(self, pre: Mapping[int, int], post: Mapping[int, int]) -> int:
        """A new transition; its number."""
        t = self.next
        self.next += 1
        self.pre[t], self.post[t] = dict(pre), dict(post)
        for p in pre:
            self.takers[p].add(t)
        for p in post:
            self.putters[p].add(t)
        return t

    def remove_transition(self, t: int) -> None:
        """The transition does not occur any more."""
        for p in self.pre.pop(t):
            self.takers[p].discard(t)
        for p in self.post.pop(t):
            self.putters[p].discard(t)

    def remove_place(self, p: int, known: Affine | None = None) -> None:
        """The place with its arcs; `known` says what it would hold, and must be given for a visible one."""
        assert p not in self.visible or known is not None
        for t in self.takers.pop(p):
            del self.pre[t][p]
        for t in self.putters.pop(p):
            del self.post[t][p]
        del self.marking[p]
        if known is not None:
            self.known[p] = known
        if p in self.visible and known is not None:
            self.visible.discard(p)
            self.visible.update(known.factors)

    def value(self, p: int) -> Affine:
        """The tokens of a place in those of places that are still there."""
        if p in self.marking:
            return Affine(0, {p: 1})
        known = self.known[p]
        constant, factors = known.constant, dict[int, int]()
        for q, n in known.factors.items():
            inner = self.value(q)
            constant += n * inner.constant
            for r, m in inner.factors.items():
                factors[r] = factors.get(r, 0) + n * m
        return Affine(constant, factors)
