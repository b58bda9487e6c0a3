"""Places whose tokens are sums of those of others, found by linear programs."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from pn2code.base.late import Late

if TYPE_CHECKING:
    import numpy as np
    from scipy import optimize, sparse
else:
    np = Late("numpy")
    optimize = Late("scipy.optimize")
    sparse = Late("scipy.sparse")


MOST_ARCS = 200_000
"""No linear programs about larger nets."""


class Sums:
    """Linear programs: is a place a sum of others, with factors that are not negative?

    Args:
        places: columns.
        rows: what transitions change.
        until: when to stop, on the monotonic clock.
    """

    def __init__(self, places: Sequence[int], rows: Sequence[dict[int, int]], until: float) -> None:
        self.until = until
        at = [(i, p) for i, row in enumerate(rows) for p in row]
        changes = np.array([n for row in rows for n in row.values()], dtype=float)
        shape = (len(rows), len(places))
        self.changes = sparse.csc_array((changes, tuple(np.array(at).T)), shape=shape)
        self.is_there = np.full(len(places), True)

    def without(self, column: int) -> None:
        """A place is gone."""
        self.is_there[column] = False

    def of(
        self, column: int, rests: Sequence[tuple[dict[int, int], int]], marking: np.ndarray
    ) -> dict[int, int] | None:
        """Factors by column, rounded; None: there are none, or the time is over.

        Args:
            column: of the place.
            rests: of the transitions that need it: what else they need, and how much of the place.
            marking: the initial one, by column.
        """
        left = self.until - time.monotonic()
        if left <= 0:
            return None
        upper = np.where(self.is_there, np.inf, 0.0)
        lower = np.zeros(len(upper)) if rests else -upper
        upper[column] = lower[column] = 0.0
        wanted = self.changes[:, [column]].toarray().ravel()
        needs, least = None, None
        if rests:
            needs = np.tile(marking, (len(rests), 1))
            for i, (rest, _) in enumerate(rests):
                for q, n in rest.items():
                    needs[i, q] -= n
            least = marking[column] - np.array([n for _, n in rests], dtype=float)
        cost = np.ones(len(upper)) if rests else np.zeros(len(upper))
        found = optimize.linprog(
            cost,
            A_ub=needs,
            b_ub=least,
            A_eq=self.changes,
            b_eq=wanted,
            bounds=np.column_stack((lower, upper)),
            method="highs",
            options={"time_limit": left},
        )
        if found.x is None or found.status:
            return None
        rounded = np.rint(found.x).astype(int)
        return {i: int(rounded[i]) for i in np.flatnonzero(rounded).tolist()}
