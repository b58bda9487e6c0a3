"""Whether the initial marking can be reached from every reachable marking: it is a home marking.

    is_home(tables, until)      # True: proved; False: not known

Some transitions drain the net: a weight of the places, none negative, becomes smaller with each of them. So from each
marking a run of these alone comes to its end, in a marking in which none of them is enabled. If the state equation
(equation.py) excludes all such markings but the initial one, that end is the initial marking.

Then each reachable marking leads to every other one. What EF p and AG p say is the same in all of them, whatever p is;
and a transition that can occur at all can always occur again.

    drained(tables)             # a formula about one marking; None: nothing is known

Whether it is a home marking or not: each reachable marking leads to one in which none of the draining transitions is
enabled. If q holds in all reachable ones of these, EF q is true everywhere.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING

from pn2code.base.late import Late
from pn2code.contest import certificates, conditions
from pn2code.contest.conditions import Condition, junction
from pn2code.contest.engine import Answer, Said
from pn2code.contest.equation import StateEquation
from pn2code.contest.formulas import Fireable, Formula, Op
from pn2code.contest.structural import EQUATION, Question
from pn2code.contest.tables import Tables

if TYPE_CHECKING:
    import numpy as np
    from scipy import optimize, sparse
else:
    np = Late("numpy")
    optimize = Late("scipy.optimize")
    sparse = Late("scipy.sparse")

TECHNIQUE = "HOME_MARKING"
DRAINED = "HOME_SPACE"
MOST_TRANSITIONS = 10_000
"""Of a net with more nothing is said."""
LONGEST_S = 20.0
_LARGEST_PART = 0.4
"""Of the time that is left; and so many seconds at most."""
_WEIGHTS_S = 2.0
_EACH_S = 2.0
"""For a question about drained markings."""
_POLL_S = 0.1
_LONGEST_STEM = 200
_MARKED = 1e-3
"""The weights are to be small, as far as all transitions drain."""

Effects = Sequence[Mapping[int, int]]


class Home(threading.Thread):
    """The question whether the initial marking is a home marking, beside others.

    Args:
        tables: the net.
        number: of the question, for the answer; there is none if it is not known.
        drained_number: of the answer that `drained` is known.
        said: where it goes.
        ends: when all ends, on the monotonic clock.

    Attributes:
        drained: a formula about one marking; each reachable marking leads to one in which it holds.
    """

    def __init__(
        self, tables: Tables, number: int, drained_number: int, said: Said, ends: float
    ) -> None:
        super().__init__(daemon=True)
        self.tables = tables
        self.number = number
        self.drained_number = drained_number
        self.drained: Formula | None = None
        self.said = said
        now = time.monotonic()
        self.asked: SimpleQueue[Question] = SimpleQueue()
        self.until = now + min(LONGEST_S, _LARGEST_PART * (ends - now))
        self.is_over = threading.Event()

    def run(self) -> None:
        """Ask the question."""
        try:
            self.drained = drained(self.tables)
            if self.drained is not None and not self.is_over.is_set():
                self.said.put(Answer(self.drained_number, True, True, DRAINED))
            if is_home(self.tables, self.until, self.is_over):
                self.said.put(Answer(self.number, True, True, TECHNIQUE))
            elif self.drained is not None:
                self._exclude()
        except Exception as error:  # it belongs to the one who waits
            self.said.put(error)

    def add(self, q: Question) -> None:
        """A question about drained markings: whether the state equation excludes it."""
        self.asked.put(q)

    def _exclude(self) -> None:
        equation = StateEquation(self.tables, self.is_over)
        while not self.is_over.is_set():
            left = self.until - time.monotonic()
            try:
                q = self.asked.get(timeout=max(0.0, min(_POLL_S, left)))
            except Empty:
                if left <= 0:
                    return
                continue
            until = min(self.until, time.monotonic() + _EACH_S)
            if not q.is_done and left > 0 and equation.excludes(q.condition, until):
                self.said.put(Answer(q.number, False, True, f"{DRAINED} {EQUATION}"))

    def end(self) -> None:
        """Stop at the next step; a linear program may still be solved (`wait_for_solver`)."""
        self.is_over.set()


def is_home(tables: Tables, until: float, is_over: threading.Event | None = None) -> bool:
    """Whether it is proved that every reachable marking leads to the initial one; False: it is not known."""
    if not tables.pre or len(tables.pre) > MOST_TRANSITIONS or tables.at_first is not None:
        return False
    draining = drain(tables)
    if not draining:
        return False
    equation = StateEquation(tables, is_over)
    initial = enumerate(tables.initial)
    filled = [p for p, n in initial if n]
    empty = {p: 1 for p, n in enumerate(tables.initial) if not n}
    ended = [_is_disabled(tables.pre[t]) for t in _least(tables.pre, draining)]
    if equation.excludes(junction(True, [*ended, conditions.at_most(_turned(empty), -1)]), until):
        others = [_differs(p, tables.initial[p]) for p in filled]
        as_empty = conditions.at_most(empty, 0)
        return equation.excludes(junction(True, [as_empty, junction(False, others)]), until)
    return False


def drained(tables: Tables) -> Formula | None:
    """That none of some transitions is enabled, which cannot occur for ever by themselves; None: there are none.

    Of coloured transitions all bindings have to drain. What drains is looked for from the first marking on in which
    there is a choice; any such set will do.
    """
    if not tables.pre or len(tables.pre) > MOST_TRANSITIONS or tables.at_first is not None:
        return None
    draining = set(drain(replace(tables, initial=_after_stem(tables))))
    names = tuple(name for name, own in tables.transitions.items() if own and draining >= set(own))
    return Op("not", (Fireable(names),)) if names else None


def _after_stem(tables: Tables) -> tuple[int, ...]:
    """The first marking in which there is a choice, or none after many steps."""
    marking = list(tables.initial)
    for _ in range(_LONGEST_STEM):
        able = (t for t, a in enumerate(tables.pre) if all(marking[p] >= n for p, n in a.items()))
        first = next(able, None)
        if first is None or next(able, None) is not None:
            break
        for p, n in tables.pre[first].items():
            marking[p] -= n
        for p, n in tables.post[first].items():
            marking[p] += n
    return tuple(marking)


def drain(tables: Tables) -> list[int]:
    """Transitions with each of which one weight of the places, none negative, becomes smaller."""
    effects = [
        {p: n for p in a.keys() | b.keys() if (n := b.get(p, 0) - a.get(p, 0))}
        for a, b in zip(tables.pre, tables.post, strict=True)
    ]
    wanted = _homewards(tables, effects)
    if not wanted:
        return []
    found: list[int] = []
    for weights, _ in certificates.integers(_weights(len(tables.initial), effects, wanted)):
        if min(weights) < 0:
            continue
        smaller = [
            t for t, e in enumerate(effects) if sum(weights[p] * n for p, n in e.items()) < 0
        ]
        found = max(found, smaller, key=len)
    return found


def _homewards(tables: Tables, effects: Effects) -> list[int]:
    """For each place that is empty at first a transition from which its tokens get into filled ones the soonest."""
    far = [0.0 if n else inf for n in tables.initial]
    best: dict[int, int] = {}
    is_changed = True
    for _ in range(len(far) + 1):
        if not is_changed:
            break
        is_changed = False
        for t, effect in enumerate(effects):
            way = 1.0 + sum(n * far[p] for p, n in tables.post[t].items())
            for p, change in effect.items():
                if change < 0 and way < far[p]:
                    far[p], best[p], is_changed = way, t, True
    return sorted(set(best.values()))


def _weights(places: int, effects: Effects, wanted: Sequence[int]) -> list[float]:
    """A weight that becomes smaller with as many of the transitions as can be, nearly."""
    entries = [(i, p, n) for i, t in enumerate(wanted) for p, n in effects[t].items()]
    i, p, n = zip(*entries, strict=True)
    shape = (len(wanted), places)
    left = sparse.hstack(
        [
            sparse.csr_array((np.array(n, dtype=float), (i, p)), shape=shape),
            -sparse.eye_array(shape[0]),
        ]
    )
    cost = np.concatenate([np.full(places, _MARKED), np.ones(len(wanted))])
    limits = {"time_limit": _WEIGHTS_S}
    found = optimize.linprog(cost, left, -np.ones(len(wanted)), method="highs", options=limits)
    return [] if found.status != 0 else [max(0.0, w) for w in found.x[:places].tolist()]


def _least(pre: Sequence[Mapping[int, int]], transitions: Sequence[int]) -> list[int]:
    """Those that do not need more than another one with the same places does."""
    needs: dict[frozenset[int], list[int]] = {}
    for t in transitions:
        same = needs.setdefault(frozenset(pre[t]), [])
        if not any(all(pre[o][p] <= n for p, n in pre[t].items()) for o in same):
            same.append(t)
    return [t for same in needs.values() for t in same]


def _is_disabled(pre: Mapping[int, int]) -> Condition:
    return junction(False, [conditions.at_most({p: 1}, n - 1) for p, n in pre.items()])


def _differs(place: int, tokens: int) -> Condition:
    more = conditions.at_most({place: -1}, -tokens - 1)
    return junction(False, [conditions.at_most({place: 1}, tokens - 1), more])


def _turned(factors: Mapping[int, int]) -> dict[int, int]:
    return {p: -n for p, n in factors.items()}
