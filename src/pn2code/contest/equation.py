"""The state equation: each reachable marking is m0 + C x with x >= 0 (Murata 1989), so that what this cannot satisfy is
not reachable.

    equation = StateEquation(tables)
    equation.excludes(condition, until)      # True: proved; False: not known
    equation.bound(sum, until)               # an upper bound that is proved, or None

A condition with `or` is split where the solution found so far does not satisfy it; tokens and steps are integers, so
that a fraction is split as well. A marked trap stays marked (Esparza, Melzer 2000): traps that a solution empties are
added. Steps of a solution that can never begin, since no step of it fills what they need, either do not occur, or
another one does that fills it (Fraca, Haddad 2015). Every part must be refuted by a certificate in integers
(certificates.py).

Rows may speak of steps, too: the number of steps of a transition is a place of its own, which only it fills. These
places have the numbers after those of the net.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from functools import cached_property
from math import gcd
from typing import TYPE_CHECKING, Any

from pn2code.base.frozen import frozen
from pn2code.base.late import Late
from pn2code.contest import certificates
from pn2code.contest.conditions import AtMost, Condition, Dead, Junction
from pn2code.contest.proofs import Choice, Leaf, Proof, Split, dead, spread
from pn2code.contest.tables import Tables

if TYPE_CHECKING:
    import numpy as np
    from scipy import optimize, sparse
else:
    np = Late("numpy")
    optimize = Late("scipy.optimize")
    sparse = Late("scipy.sparse")

_ZERO = 1e-6
_SMALL = 1e-9
LONGEST_S = 5.0
"""For one linear program, so that the one who ends the search need not wait longer."""
_solving = threading.Lock()
"""Held while HiGHS runs: an interpreter must not end meanwhile (its threads would end it with an error)."""
LONGEST_WAIT_S = 0.5
"""For the end of a linear program; HiGHS may go on for seconds after its time limit."""
MOST_STEPS = 1_000_000
"""Of a transition in a solution that is followed."""
MOST_LEAVES = 200
"""Of a proof: a longer one tells nobody anything."""
MOST_SPLITS = 40
"""Fractions that are split one inside the other."""


def wait_for_solver(patience: float = LONGEST_WAIT_S) -> None:
    """Until no linear program is being solved, but not for long: a command leaves without the end of the interpreter.

    Those who search must have been told before that it is over.
    """
    if _solving.acquire(timeout=patience):
        _solving.release()


class _UnknownError(Exception):
    """There is no proof: a solution satisfies everything, or the time is over."""


@frozen
class _Solution:
    """What the linear program says.

    Args:
        distance: by how much the rows cannot be satisfied.
        marking: the tokens by place.
        steps: how often each transition occurs.
        duals: of the places, then of the rows.
    """

    distance: float
    marking: Any
    steps: Any
    duals: Any


@frozen
class _Node:
    """A part of the search: rows that hold, choices of which one part must, and how many fractions were split."""

    rows: tuple[AtMost, ...]
    choices: tuple[Junction, ...]
    splits: int = 0


class StateEquation:
    """The state equation of a net.

    Args:
        tables: the net.
        is_over: set when nobody waits for an answer any more.

    Attributes:
        is_exhausted: of the last question: more time would not help.
        guide: of the last question that was not excluded: how often transitions occur in a solution.
        most: place -> tokens that it never exceeds, where that was proved.
    """

    def __init__(self, tables: Tables, is_over: threading.Event | None = None) -> None:
        self.tables = tables
        self.is_over = threading.Event() if is_over is None else is_over
        self.effects = [_effect(a, b) for a, b in zip(tables.pre, tables.post, strict=True)]
        self.places = len(tables.initial)
        self._counted = [{**e, self.places + t: 1} for t, e in enumerate(self.effects)]
        self._all_initial = [*tables.initial, *([0] * len(self.effects))]
        self.traps: list[AtMost] = []
        self._contradictions: list[frozenset[AtMost]] = []
        self.is_exhausted = True
        self.guide: dict[int, int] = {}
        self.most: dict[int, int] = {}
        self._certain: tuple[Sequence[int], Mapping[int, int]] | None = None
        self._leaves_left = 0

    @cached_property
    def _matrix(self) -> Any:
        """C: places by transitions."""
        entries = [(p, t, n) for t, e in enumerate(self.effects) for p, n in e.items()]
        p, t, n = zip(*entries, strict=True) if entries else ((), (), ())
        shape = (len(self.tables.initial), len(self.effects))
        return sparse.csr_array((np.array(n, dtype=float), (p, t)), shape=shape)

    @cached_property
    def _initial(self) -> Any:
        return np.array(self.tables.initial, dtype=float)

    def excludes(self, condition: Condition, until: float) -> bool:
        """Whether no reachable marking satisfies a condition; False: it is not known.

        `is_exhausted` says afterwards whether more time would not help.
        """
        self.is_exhausted = True
        self.guide = {}
        if isinstance(condition, Dead):
            condition = dead(self.tables)
        waiting = [_with(_Node((), ()), condition)]
        try:
            while waiting:
                node = waiting.pop()
                if node is not None and not self._is_impossible(node, until):
                    waiting += self._split(node, until)
        except _UnknownError:
            return False
        return True

    def _is_impossible(self, node: _Node, until: float) -> bool:
        """Whether what was proved before shows it: rows that contradict each other, bounds of single places."""
        rows = frozenset(node.rows)
        if any(c <= rows for c in self._contradictions):
            return True
        if any(self._is_too_much(row) for row in node.rows):
            return True
        if len(node.rows) == 1 and not node.choices:
            (row,) = node.rows
            if any(p >= self.places for p, _ in row.factors):
                return False
            most = self.bound({p: -n for p, n in row.factors}, until)
            return most is not None and most < -row.limit
        return False

    def _is_too_much(self, row: AtMost) -> bool:
        least = 0
        for p, n in row.factors:
            if n < 0:
                if p not in self.most:
                    return False
                least += n * self.most[p]
        return least > row.limit

    def _split(self, node: _Node, until: float) -> list[_Node | None]:
        """The parts into which a node falls; none if it is refuted."""
        while True:
            rows = [*node.rows, *self.traps]
            found = self._solved(rows, until)
            if found.distance > _ZERO:
                if not self._is_refuted(rows, found):
                    raise _UnknownError
                return []
            open_ = [c for c in node.choices if not _nearly(c, found.marking)]
            if open_:
                chosen = min(open_, key=lambda c: len(c.parts))
                rest = _Node(
                    node.rows, tuple(c for c in node.choices if c is not chosen), node.splits
                )
                return [_with(rest, part) for part in chosen.parts]
            if self._add_trap(found.marking):
                continue
            self._note_guide(found.steps)
            parts = self._without_a_beginning(found.steps) or self._at_a_fraction(found)
            if not parts or node.splits >= MOST_SPLITS:
                self._guess(rows, until)
                raise _UnknownError
            return [_Node((*node.rows, row), node.choices, node.splits + 1) for row in parts]

    def _without_a_beginning(self, steps: Any) -> list[AtMost]:
        """Either steps that no other step of the solution makes possible do not occur, or one that fills more does.

        The first step that fills one of the places that are still empty needs only places that can be filled before.
        """
        tables = self.tables
        occurring = {t for t, n in enumerate(steps.tolist()) if n > _ZERO}
        filled = {p for p, n in enumerate(tables.initial) if n}
        todo = list(occurring)
        while todo:
            begun = [t for t in todo if tables.pre[t].keys() <= filled]
            if not begun:
                break
            for t in begun:
                filled |= tables.post[t].keys()
            todo = [t for t in todo if not tables.pre[t].keys() <= filled]
        if not todo:
            return []
        fillers = [
            t
            for t, pre in enumerate(tables.pre)
            if pre.keys() <= filled and not tables.post[t].keys() <= filled
        ]
        parts = [AtMost(tuple((self.places + t, 1) for t in sorted(todo)), 0)]
        if fillers:
            parts.append(AtMost(tuple((self.places + t, -1) for t in fillers), -1))
        return parts

    def _at_a_fraction(self, found: _Solution) -> list[AtMost]:
        for first, values in ((0, found.marking), (self.places, found.steps)):
            away = np.abs(values - np.round(values))
            i = int(np.argmax(away)) if len(away) else 0
            if len(away) and away[i] > 1e-4:
                below = AtMost(((first + i, 1),), int(np.floor(values[i])))
                return [below, below.opposite()]
        return []

    def _guess(self, rows: Sequence[AtMost], until: float) -> None:
        """Note a solution with as few steps as there can be."""
        left, right = self._inequalities(rows)
        left = left[:, :-1]
        result = self._solve(np.ones(left.shape[1]), left, right, until)
        self._note_guide(result.x)

    def _note_guide(self, solution: Any) -> None:
        steps = np.ceil(solution - _ZERO).astype(int)
        self.guide = {t: int(n) for t, n in enumerate(steps.tolist()) if 0 < n < MOST_STEPS}

    def _solved(self, rows: Sequence[AtMost], until: float) -> _Solution:
        """The marking that is nearest to satisfying the rows: the largest distance from one of them is minimal."""
        left, right = self._inequalities(rows)
        cost = np.zeros(left.shape[1])
        cost[-1] = 1.0
        result = self._solve(cost, left, right, until)
        steps = result.x[:-1]
        marking = self._initial + self._matrix @ steps
        return _Solution(float(result.fun), marking, steps, -result.ineqlin.marginals)

    def _inequalities(self, rows: Sequence[AtMost]) -> tuple[Any, Any]:
        """Of the number of steps of each transition, and of the distance from the rows: tokens are not negative."""
        transitions = len(self.effects)
        entries = [(i, p, n) for i, row in enumerate(rows) for p, n in row.factors]
        i, p, n = zip(*entries, strict=True) if entries else ((), (), ())
        shape = (len(rows), self.places + transitions)
        a = sparse.csr_array((np.array(n, dtype=float), (i, p)), shape=shape)
        limits = np.array([row.limit for row in rows], dtype=float) - a @ self._all_initial
        extra = np.concatenate([np.zeros(self.places), -np.ones(len(rows))]).reshape(-1, 1)
        counted = sparse.vstack([self._matrix, sparse.eye_array(transitions)])
        left = sparse.hstack([sparse.vstack([-self._matrix, a @ counted]), sparse.csr_array(extra)])
        return sparse.csc_array(left), np.concatenate([self._initial, limits])

    def _solve(self, cost: Any, left: Any, right: Any, until: float) -> Any:
        linprog = optimize.linprog  # loaded before anybody may have to wait for it
        with _solving:
            seconds = min(LONGEST_S, until - time.monotonic())
            if seconds <= 0.0 or self.is_over.is_set():
                self.is_exhausted = False
                raise _UnknownError
            limits = {"time_limit": seconds}
            result = linprog(cost, A_ub=left, b_ub=right, method="highs", options=limits)
        if result.status != 0:
            self.is_exhausted = result.status != 1
            raise _UnknownError
        return result

    def proof(self, condition: Condition, until: float, most: int = MOST_LEAVES) -> Proof | None:
        """A proof that no reachable marking satisfies a condition, to be checked by `proofs.is_proof`.

        It splits fractions only, not steps that can never begin. None: it has found none, or one of too many leaves.
        """
        rows, choices = spread(condition, self.tables)
        self._leaves_left = most
        try:
            return self._proved_by_cases(tuple(rows), tuple(choices), 0, until)
        except (_UnknownError, RecursionError):
            return None

    def _proved_by_cases(
        self, rows: tuple[AtMost, ...], choices: tuple[Junction, ...], splits: int, until: float
    ) -> Proof:
        while True:
            all_rows = [*rows, *self.traps]
            found = self._solved(all_rows, until)
            if found.distance <= _ZERO:
                open_ = [c for c in choices if not _nearly(c, found.marking)]
                if open_:
                    return self._by_parts(
                        rows, choices, min(open_, key=lambda c: len(c.parts)), splits, until
                    )
                if self._add_trap(found.marking):
                    continue
                parts = self._at_a_fraction(found)
                if not parts or splits >= MOST_SPLITS:
                    raise _UnknownError
                below, above = (
                    self._proved_by_cases((*rows, row), choices, splits + 1, until) for row in parts
                )
                return Split(parts[0], below, above)
            self._leaves_left -= 1
            self._certain = None
            if self._leaves_left < 0 or not self._is_refuted(all_rows, found):
                raise _UnknownError
            assert self._certain is not None
            return self._leaf(all_rows, *self._certain)

    def _by_parts(
        self,
        rows: tuple[AtMost, ...],
        choices: tuple[Junction, ...],
        chosen: Junction,
        splits: int,
        until: float,
    ) -> Proof:
        rest = tuple(c for c in choices if c != chosen)
        parts = []
        for part in chosen.parts:
            more, further = spread(part, self.tables)
            parts.append(self._proved_by_cases((*rows, *more), (*rest, *further), splits, until))
        return Choice(chosen, tuple(parts))

    def _leaf(
        self, rows: Sequence[AtMost], factors: Sequence[int], weight: Mapping[int, int]
    ) -> Leaf:
        """The certificate, with the least numbers, and with the rows that it uses."""
        by = gcd(*factors, *weight.values()) or 1
        used = [(row, f // by) for row, f in zip(rows, factors, strict=True) if f]
        own = [(row, f) for row, f in used if row not in self.traps]
        traps = [(row, f) for row, f in used if row in self.traps]
        return Leaf(
            tuple(row for row, _ in own),
            tuple(tuple(p for p, _ in row.factors) for row, _ in traps),
            tuple(f for _, f in (*own, *traps)),
            {p: w // by for p, w in sorted(weight.items()) if w},
        )

    def _is_refuted(self, rows: Sequence[AtMost], found: _Solution) -> bool:
        places = self.places
        for numbers, _ in certificates.integers(found.duals.tolist()):
            of_places, factors = numbers[:places], numbers[places:]
            weight = {p: -y for p, y in enumerate(of_places) if y}
            for row, f in zip(rows, factors, strict=True):
                for p, n in row.factors if f else ():
                    weight[p] = weight.get(p, 0) + f * n
            if self._is_certain(rows, factors, weight):
                return True
        return self._is_refuted_exactly(rows, found.duals)

    def _is_certain(
        self, rows: Sequence[AtMost], factors: Sequence[int], weight: Mapping[int, int]
    ) -> bool:
        """Check a certificate; the rows that it needs contradict each other wherever they meet again."""
        if not certificates.is_refuted(rows, factors, weight, self._all_initial, self._counted):
            return False
        self._certain = factors, weight
        used = {row for row, f in zip(rows, factors, strict=True) if f}
        self._contradictions.append(frozenset(used.difference(self.traps)))
        return True

    def _is_refuted_exactly(self, rows: Sequence[AtMost], duals: Any) -> bool:
        """The same with the exact solution: transitions that keep the weight in floating point must keep it."""
        places = self.places
        near = {i: float(v) for i, v in enumerate(duals.tolist()) if v > _SMALL}
        columns = {i: {i: -1} if i < places else dict(rows[i - places].factors) for i in near}
        equations = [(dict.fromkeys((i for i in near if i >= places), 1), 1)]
        equations += self._kept(columns, near, {})
        values = certificates.solution(equations, near)
        if values is None:
            return False
        numbers, _ = certificates.whole(values)
        weight: dict[int, int] = {}
        for i, f in numbers.items():
            for p, n in columns[i].items():
                weight[p] = weight.get(p, 0) + f * n
        factors = [numbers.get(places + j, 0) for j in range(len(rows))]
        return self._is_certain(rows, factors, weight)

    def _kept(
        self,
        columns: Mapping[int, Mapping[int, int]],
        near: Mapping[int, float],
        fixed: Mapping[int, int],
    ) -> list[tuple[dict[int, int], int]]:
        """That the transitions change nothing that, in floating point, do not change it.

        Args:
            columns: unknown -> the weight of places in it.
            near: the unknowns, nearly.
            fixed: the weight of places that is known.
        """
        of_place: dict[int, list[tuple[int, int]]] = {}
        for i, column in columns.items():
            for p, n in column.items():
                of_place.setdefault(p, []).append((i, n))
        found = []
        for effect in self._counted:
            factors: dict[int, int] = {}
            constant = 0
            for p, change in effect.items():
                constant += fixed.get(p, 0) * change
                for i, n in of_place.get(p, ()):
                    factors[i] = factors.get(i, 0) + n * change
            if abs(constant + sum(n * near[i] for i, n in factors.items())) < _SMALL:
                found.append(({i: n for i, n in factors.items() if n}, -constant))
        return found

    def bound(self, factors: Mapping[int, int], until: float) -> int | None:
        """An upper bound of a sum of tokens; None: none was found."""
        c = np.zeros(len(self.tables.initial))
        for p, n in factors.items():
            c[p] = n
        try:
            result = self._solve(-(c @ self._matrix), -self._matrix, self._initial, until)
        except _UnknownError:
            return None
        weight = (c - result.ineqlin.marginals).tolist()
        best: int | None = None
        for numbers, scale in certificates.integers(weight):
            if scale:
                of = {p: n for p, n in enumerate(numbers) if n}
                found = self._proved(factors, of, scale)
                if found is not None and (best is None or found < best):
                    best = found
        return self._bound_exactly(factors, weight) if best is None else best

    def _bound_exactly(self, factors: Mapping[int, int], weight: Sequence[float]) -> int | None:
        near = {p: w for p, w in enumerate(weight) if abs(w - factors.get(p, 0)) > _SMALL}
        fixed = {p: n for p, n in factors.items() if p not in near}
        values = certificates.solution(self._kept({p: {p: 1} for p in near}, near, fixed), near)
        if values is None:
            return None
        numbers, scale = certificates.whole(values)
        numbers |= {p: n * scale for p, n in fixed.items()}
        return self._proved(factors, numbers, scale)

    def _proved(
        self, factors: Mapping[int, int], weight: Mapping[int, int], scale: int
    ) -> int | None:
        """The bound that a weight proves; the same weight bounds each of its places."""
        initial = self.tables.initial
        found = certificates.bound(factors, weight, scale, initial, self.effects)
        if found is not None:
            total = sum(w * initial[p] for p, w in weight.items())
            for p, w in weight.items():
                if w > 0:
                    self.most[p] = min(total // w, self.most.get(p, total // w))
        return found

    def _add_trap(self, marking: Any) -> bool:
        """Add the largest trap that is marked in the beginning and empty here; False: there is none."""
        trap = {p for p, n in enumerate(marking.tolist()) if n < _ZERO}
        todo = list(trap)
        while todo:
            p = todo.pop()
            if p in trap and not all(
                any(q in trap for q in self.tables.post[t]) for t in self._takers[p]
            ):
                trap.discard(p)
                todo += (q for t in self._putters[p] for q in self.tables.pre[t] if q in trap)
        if not any(self.tables.initial[p] for p in trap):
            return False
        self.traps.append(AtMost(tuple((p, -1) for p in sorted(trap)), -1))
        return True

    @cached_property
    def _takers(self) -> list[list[int]]:
        return _ends(self.tables.pre, len(self.tables.initial))

    @cached_property
    def _putters(self) -> list[list[int]]:
        return _ends(self.tables.post, len(self.tables.initial))


def _ends(arcs: Sequence[Mapping[int, int]], places: int) -> list[list[int]]:
    found: list[list[int]] = [[] for _ in range(places)]
    for t, of in enumerate(arcs):
        for p in of:
            found[p].append(t)
    return found


def _effect(pre: Mapping[int, int], post: Mapping[int, int]) -> dict[int, int]:
    found = {p: post.get(p, 0) - pre.get(p, 0) for p in pre.keys() | post.keys()}
    return {p: n for p, n in found.items() if n}


def _with(node: _Node, condition: Condition) -> _Node | None:
    """The node with a condition more; None: it is false."""
    match condition:
        case AtMost():
            return _Node((*node.rows, condition), node.choices, node.splits)
        case Junction(True, parts):
            found: _Node | None = node
            for part in parts:
                found = None if found is None else _with(found, part)
            return found
        case Junction(False, parts):
            return _Node(node.rows, (*node.choices, condition), node.splits) if parts else None
    raise AssertionError(condition)


def _nearly(c: Condition, marking: Any) -> bool:
    """Whether a marking with fractions satisfies a condition."""
    if isinstance(c, AtMost):
        return bool(sum(n * marking[p] for p, n in c.factors) <= c.limit + _ZERO)
    assert isinstance(c, Junction)
    return (all if c.is_all else any)(_nearly(p, marking) for p in c.parts)
