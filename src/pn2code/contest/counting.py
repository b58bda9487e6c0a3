"""Nets made smaller so that markings and arcs can still be counted: one stands for several, known by number.

    counted = smaller(tables, until=time.monotonic() + 2.0)
    counted.tables, counted.leaves   # the net; how many places of the one before each place stands for

A place that stands for several, its leaves, holds the tokens of all of them, divided among them in each possible way
(Berthomieu, Le Botlan, Dal Zilio 2018: counting markings from reduction equations). So it is

* where tokens go round among the leaves by themselves;
* where a place that is empty at first is filled only from another one, by a step that needs nothing else: what empties
  it can wait for the tokens in the other one, and what is in the other one can move on, one token after the other.

A marking with k tokens on n leaves stands for C(k + n - 1, n - 1), of which C(k - w + n - 1, n - 1) have the w tokens
that a transition needs on some of them. A place whose tokens follow from those of others (Colom, Silva 1991) goes, if
it never is an obstacle; how many it holds is a sum. Transitions that change nothing (any more) are kept, to be counted.

Places of which invariants say that one at most is marked, with one token, are one place with a value (`Counted.exact`):
diagrams have fewer levels then.
"""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Iterable, Sequence
from math import gcd
from typing import TYPE_CHECKING

from pn2code.base.late import Late
from pn2code.contest.counted import Counted
from pn2code.contest.reduction.net import Affine, Goal, Net
from pn2code.contest.reduction.transitions import dead_transitions
from pn2code.contest.sums import MOST_ARCS, Sums
from pn2code.contest.tables import Tables
from pn2code.contest.units import units_of

if TYPE_CHECKING:
    import numpy as np
    from scipy import sparse
    from scipy.sparse import csgraph
else:
    np = Late("numpy")
    sparse = Late("scipy.sparse")
    csgraph = Late("scipy.sparse.csgraph")


_MOST_FACTOR = 1_000_000_000
"""What the engine reads."""
_CANDIDATES = 8
_REDUCING = 0.6
"""Of the time; what is left is for units."""


def smaller(tables: Tables, until: float) -> Counted | None:
    """The smallest net that is found until then; None: none that can be counted.

    Args:
        tables: the net.
        until: on the monotonic clock.
    """
    made = _Counting(tables, until)
    made.reduce()
    return made.counted()


class _Counting:
    """A net that becomes smaller.

    Attributes:
        leaves: place -> the places of the net as it was for which it stands.
        gone: place that follows from others -> its tokens, in those that were there then, each a leaf.
        tests: transitions that change nothing -> what they need.
        tested: place -> those that need it.
    """

    def __init__(self, tables: Tables, until: float) -> None:
        self.tables = tables
        self.until = until
        now = time.monotonic()
        self.until_reduced = now + _REDUCING * (until - now)
        self.net = Net(tables, (), Goal.STEPS)
        self.leaves = {p: [p] for p in self.net.marking}
        self.gone: dict[int, Affine] = {}
        self.tests: dict[int, dict[int, int]] = {}
        self.tested: dict[int, set[int]] = {p: set() for p in self.net.marking}

    def reduce(self) -> None:
        """Until nothing changes, or the time is over."""
        dead_transitions(self.net)
        self._put_idle_aside(list(self.net.pre))
        changed = True
        while changed and time.monotonic() < self.until_reduced:
            changed = any([self._constant(), self._proportional(), self._loops(), self._chains()])
            if not changed:
                changed = self._implied()

    # --- places that follow from others ----------------------------------------------------------

    def _needing(self, p: int) -> list[tuple[int, dict[int, int]]]:
        """Transitions that need a place, with all that they need."""
        found = [(t, self.net.pre[t]) for t in self.net.takers[p]]
        return found + [(t, self.tests[t]) for t in self.tested[p]]

    def _can_disable(self, p: int, sum_: Affine) -> bool:
        """Whether a transition may lack tokens in `p` alone; no factor is negative, or nothing needs the place."""
        return any(
            sum_.constant + sum(n * needs.get(q, 0) for q, n in sum_.factors.items()) < needs[p]
            for _, needs in self._needing(p)
        )

    def _remove(self, p: int, sum_: Affine) -> None:
        """The tokens of a place with one leaf are that sum, and it is no obstacle."""
        assert len(self.leaves[p]) == 1
        factors = {leaf: n for q, n in sum_.factors.items() for leaf in self.leaves[q]}
        self.gone[p] = Affine(sum_.constant, factors)
        touched = self.net.takers[p] | self.net.putters[p]
        for t in self.tested.pop(p):
            del self.tests[t][p]
        self.net.remove_place(p)
        del self.leaves[p]
        self._put_idle_aside(touched)

    def _put_idle_aside(self, transitions: Iterable[int]) -> None:
        for t in transitions:
            if t in self.net.pre and self.net.pre[t] == self.net.post[t]:
                self.tests[t] = dict(self.net.pre[t])
                for p in self.tests[t]:
                    self.tested[p].add(t)
                self.net.remove_transition(t)

    def _constant(self) -> bool:
        """What needs more than a constant place holds is dead."""
        found = [p for p, own in self.leaves.items() if len(own) == 1 and not self.net.row(p)]
        for p in found:
            tokens = self.net.marking[p]
            for t in [t for t in self.net.takers[p] if self.net.pre[t][p] > tokens]:
                self.net.remove_transition(t)
            for t in [t for t in self.tested[p] if self.tests[t][p] > tokens]:
                for q in self.tests.pop(t):
                    self.tested[q].discard(t)
            self._remove(p, Affine(tokens, {}))
        return bool(found)

    def _proportional(self) -> bool:
        groups: dict[tuple[tuple[int, int], ...], list[tuple[int, int]]] = defaultdict(list)
        for p in self.net.marking:
            row = sorted(self.net.row(p).items())
            if row:
                scale = gcd(*(n for _, n in row))
                groups[tuple((t, n // scale) for t, n in row)].append((p, scale))
        removed = False
        for group in groups.values():
            for p, a in [(p, a) for p, a in group if len(self.leaves[p]) == 1]:
                others = [(q, b) for q, b in group if q != p and a % b == 0][:_CANDIDATES]
                for q, b in others:
                    sum_ = Affine(self.net.marking[p] - (a // b) * self.net.marking[q], {q: a // b})
                    if not self._can_disable(p, sum_):
                        self._remove(p, sum_)
                        group.remove((p, a))
                        removed = True
                        break
        return removed

    def _implied(self) -> bool:
        """Sums of several places, by linear programs; what these say is checked in integers."""
        net = self.net
        if sum(map(len, net.pre.values())) + sum(map(len, net.post.values())) > MOST_ARCS:
            return False
        places = list(net.marking)
        column = {p: i for i, p in enumerate(places)}
        rows = {frozenset(net.effect(t).items()) for t in net.pre}
        if not rows:
            return False
        programs = Sums(
            places, [{column[p]: n for p, n in row} for row in rows], self.until_reduced
        )
        removed = False
        for p in places:
            if len(self.leaves[p]) > 1:
                continue
            needing = self._needing(p)
            if any(len(needs) == 1 and needs[p] > net.marking[p] for _, needs in needing):
                continue
            rests = [
                ({column[q]: n for q, n in needs.items() if q != p}, needs[p])
                for _, needs in needing
            ]
            marking = np.array([net.marking.get(q, 0) for q in places], dtype=float)
            found = programs.of(column[p], rests, marking)
            if found is None:
                continue
            factors = {places[i]: n for i, n in found.items()}
            constant = net.marking[p] - sum(n * net.marking[q] for q, n in factors.items())
            sum_ = Affine(constant, factors)
            if self._is_sum(p, factors) and not self._can_disable(p, sum_):
                self._remove(p, sum_)
                programs.without(column[p])
                removed = True
        return removed

    def _is_sum(self, p: int, factors: dict[int, int]) -> bool:
        """Whether all transitions change a place as they change the sum."""
        if self._needing(p) and any(n < 0 for n in factors.values()):
            return False
        left = defaultdict(int, self.net.row(p))
        for q, n in factors.items():
            for t, change in self.net.row(q).items():
                left[t] -= n * change
        return not any(left.values())

    # --- places that become leaves of one --------------------------------------------------------

    def _moves(self) -> list[tuple[int, int]]:
        """Transitions that take one token, and put one: from where, and where."""
        found = []
        for t, pre in self.net.pre.items():
            post = self.net.post[t]
            if len(pre) == len(post) == 1:
                ((p, taken),), ((q, put),) = pre.items(), post.items()
                if taken == put == 1:
                    found.append((p, q))
        return found

    def _loops(self) -> bool:
        """Places among which tokens go round by themselves."""
        moves = self._moves()
        if not moves:
            return False
        places = list(self.net.marking)
        number = {p: i for i, p in enumerate(places)}
        a, b = ([number[m[k]] for m in moves] for k in range(2))
        ones, shape = np.ones(len(moves)), (len(places), len(places))
        _, part = csgraph.connected_components(
            sparse.csr_array((ones, (a, b)), shape=shape), connection="strong"
        )
        first: dict[int, int] = {}
        merged = False
        for p, k in zip(places, part.tolist(), strict=True):
            if first.setdefault(k, p) != p:
                self._merge(first[k], p)
                merged = True
        return merged

    def _chains(self) -> bool:
        """A place that is empty at first, and filled only by moves from one other place."""
        merged = False
        sources: dict[int, set[int]] = defaultdict(set)
        count: dict[int, int] = defaultdict(int)
        for p, q in self._moves():
            sources[q].add(p)
            count[q] += 1
        for q, before in sources.items():
            if len(before) > 1 or count[q] != len(self.net.putters[q]) or self.net.marking[q]:
                continue
            (p,) = before
            if p in self.net.marking and self._fills_alone(p, q):
                self._merge(p, q)
                merged = True
        return merged

    def _fills_alone(self, p: int, q: int) -> bool:
        """As above, looked at afresh, since other places have been put together meanwhile."""
        return all(
            self.net.pre[t] == {p: 1} and self.net.post[t] == {q: 1} for t in self.net.putters[q]
        )

    def _merge(self, p: int, q: int) -> None:
        """The second place becomes part of the first one."""
        net = self.net
        touched = net.takers[q] | net.putters[q]
        for ends, arcs in ((net.takers, net.pre), (net.putters, net.post)):
            for t in ends.pop(q):
                arcs[t][p] = arcs[t].get(p, 0) + arcs[t].pop(q)
                ends[p].add(t)
        for t in self.tested.pop(q):
            self.tests[t][p] = self.tests[t].get(p, 0) + self.tests[t].pop(q)
            self.tested[p].add(t)
        net.marking[p] += net.marking.pop(q)
        self.leaves[p] += self.leaves.pop(q)
        self._put_idle_aside(touched)

    # --- what is left ----------------------------------------------------------------------------

    def counted(self) -> Counted | None:
        """The net as it is now; None: its numbers are too large."""
        number = {p: i for i, p in enumerate(self.net.marking)}
        arcs = [(self.net.pre[t], self.net.post[t]) for t in self.net.pre]
        arcs += [(needs, needs) for needs in self.tests.values()]
        tables = Tables(
            tuple(self.net.marking.values()),
            tuple({number[p]: n for p, n in pre.items()} for pre, _ in arcs),
            tuple({number[p]: n for p, n in post.items()} for _, post in arcs),
            {},
            {},
        )
        values = self._values()
        total, sums = self._most(values), dict[tuple[tuple[int, int], ...], int]()
        for p in self.gone:
            sum_ = self._most([values[p]])
            key = tuple(sorted(sum_.factors.items()))
            sums[key] = max(sum_.constant, sums.get(key, sum_.constant))
        made = [Affine(constant, dict(key)) for key, constant in sums.items()]
        if not tables.fits() or any(
            abs(n) > _MOST_FACTOR for s in (total, *made) for n in s.factors.values()
        ):
            return None
        leaves = tuple(len(self.leaves[p]) for p in self.net.marking)
        units = units_of(tables, self.until)
        kept = tuple(self.net.marking)
        return Counted.of(tables, leaves, kept, total, tuple(made), units)

    def _values(self) -> list[Affine]:
        """The tokens of each place, in those of leaves that are still there; the last ones to go come first."""
        values = [Affine(0, {p: 1}) for p in range(len(self.tables.initial))]
        for p, sum_ in reversed(self.gone.items()):
            values[p] = _sum([(values[q], n) for q, n in sum_.factors.items()], sum_.constant)
        return values

    def _most(self, values: Sequence[Affine]) -> Affine:
        """The largest sum, by places: all tokens are on the leaf that counts most."""
        sum_ = _sum([(v, 1) for v in values], 0)
        factors = {
            i: max(sum_.factors.get(leaf, 0) for leaf in own)
            for i, own in enumerate(self.leaves[p] for p in self.net.marking)
        }
        return Affine(sum_.constant, {i: n for i, n in factors.items() if n})


def _sum(parts: Iterable[tuple[Affine, int]], constant: int) -> Affine:
    factors: dict[int, int] = defaultdict(int)
    for part, n in parts:
        constant += n * part.constant
        for p, m in part.factors.items():
            factors[p] += n * m
    return Affine(constant, {p: n for p, n in factors.items() if n})
