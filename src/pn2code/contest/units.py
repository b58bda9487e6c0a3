"""Sets of places of which invariants say that one at most is marked, with one token."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pn2code.base.late import Late
from pn2code.contest.sums import MOST_ARCS
from pn2code.contest.tables import Tables

if TYPE_CHECKING:
    import numpy as np
    from scipy import optimize, sparse
else:
    np = Late("numpy")
    optimize = Late("scipy.optimize")
    sparse = Late("scipy.sparse")


def units_of(tables: Tables, until: float) -> tuple[tuple[int, ...], ...]:
    """Disjoint sets of places of which invariants say that one at most is marked, with one token; large ones first."""
    places = len(tables.initial)
    arcs = sum(map(len, tables.pre)) + sum(map(len, tables.post))
    found: list[set[int]] = []
    open_ = {p for p in range(places) if tables.initial[p] <= 1}
    if places and arcs <= MOST_ARCS:
        rows = {
            frozenset((p, post.get(p, 0) - pre.get(p, 0)) for p in {*pre, *post})
            for pre, post in zip(tables.pre, tables.post, strict=True)
        }
        changes = [{p: n for p, n in row if n} for row in rows]
        programs = _Invariants(tables.initial, [row for row in changes if row], until)
        is_common = True  # a program for all places that are open; then for one after the other
        while open_ and time.monotonic() < until:
            wanted = open_ if is_common else {min(open_)}
            unit = programs.with_most(wanted)
            if unit is not None and unit & wanted:
                found.append(unit)
                open_ -= unit
            elif is_common:
                is_common = False
            else:
                open_ -= wanted
    units: list[tuple[int, ...]] = []
    while found:
        largest = max(found, key=len)
        if len(largest) > 1:
            units.append(tuple(sorted(largest)))
        found = [rest for unit in found if (rest := unit - largest)]
    return tuple(units)


class _Invariants:
    """Sets of places that hold one token together, by linear programs.

    Args:
        initial: the initial marking.
        changes: what transitions change.
        until: when to stop, on the monotonic clock.
    """

    def __init__(
        self, initial: Sequence[int], changes: Sequence[dict[int, int]], until: float
    ) -> None:
        self.until = until
        self.changes = changes
        self.initial = np.array(initial, dtype=float)
        at = np.array([(i, p) for i, row in enumerate(changes) for p in row]).reshape(-1, 2)
        numbers = np.array([n for row in changes for n in row.values()], dtype=float)
        shape = (len(changes) + 1, len(initial))
        marked = sparse.csr_array(self.initial.reshape(1, -1))
        self.equal = sparse.vstack(
            [sparse.csr_array((numbers, tuple(at.T)), shape=(shape[0] - 1, shape[1])), marked]
        ).tocsc()

    def with_most(self, wanted: set[int]) -> set[int] | None:
        """One with as many of some places as possible; None: there is none, or the time is over."""
        left = self.until - time.monotonic()
        if left <= 0:
            return None
        cost = np.array([-1.0 if p in wanted else 0.0 for p in range(len(self.initial))])
        right = np.zeros(self.equal.shape[0])
        right[-1] = 1.0
        found = optimize.linprog(
            cost,
            A_eq=self.equal,
            b_eq=right,
            bounds=(0, None),  # the corners are invariants that contain no other one
            method="highs",
            options={"time_limit": left},
        )
        if found.x is None or found.status:
            return None
        unit = set(np.flatnonzero(np.rint(found.x)).tolist())
        return unit if self._is_one(unit) else None

    def _is_one(self, unit: set[int]) -> bool:
        """In integers: they hold one token at first, and no transition changes how many they hold."""
        return sum(int(self.initial[p]) for p in unit) == 1 and not any(
            sum(n for p, n in row.items() if p in unit) for row in self.changes
        )
