"""The most tokens that the marking equation allows on a place, with the sub-invariant that proves it; exact.

    program = MarkingProgram([{0: -1}, {0: 1}], [3, 0])     # one mode moves tokens from place 0 to place 1
    program.most(1)                                          # {0: 1, 1: 1}: their sum never grows

What is maximised is the number of tokens m of a place, for m = initial + changes * x >= 0 and x >= 0, by the simplex
method in integers. At its end the place's own row of the dictionary is the proof: it says that the place has a fixed
number of tokens, less what others have, and less what modes take. The next place starts where the last one has ended,
and so needs few steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import gcd

from pn2code.base.frozen import record

_TOKEN = 1_000_000
"""What a token at first costs in a proof, where each place costs 1: among equally good proofs a small one is chosen."""


class TooMuchWorkError(Exception):
    """The work that was allowed is done, and the answer is not known."""


@record
class _Line:
    """`scale * variable = constant + sum of entry * other variable`, over variables that are zero; scale > 0."""

    scale: int
    constant: int
    entries: dict[int, int]

    def reduce(self) -> None:
        """Divides by what all numbers have in common."""
        common = gcd(self.scale, self.constant, *self.entries.values())
        if common > 1:
            self.scale //= common
            self.constant //= common
            self.entries = {c: n // common for c, n in self.entries.items()}


class MarkingProgram:
    """Linear programs over the marking equation of a net.

    Args:
        changes: place -> {mode: by how many tokens it changes the place, at most}.
        initial: place -> tokens at first.

    Attributes:
        work: how many numbers have been computed so far; the same for the same net.
    """

    def __init__(self, changes: Sequence[Mapping[int, int]], initial: Sequence[int]) -> None:
        # Variables are numbered: places, then modes. Those with a line are not zero, the others are.
        self._places = len(changes)
        self._lines: dict[int, _Line] = {}
        self._users: dict[int, set[int]] = {}
        self._unlimited: set[int] = set()
        self.work = 0
        for place, (row, tokens) in enumerate(zip(changes, initial, strict=True)):
            entries = {self._places + k: n for k, n in row.items() if n}
            self._add(place, _Line(1, tokens * _TOKEN + 1, entries))

    def most(self, place: int, work: int | None = None) -> dict[int, int] | None:
        """Place -> weight of the sum that never grows and bounds this place best; None: there is none.

        Args:
            place: its index.
            work: what `self.work` may come to.

        Raises:
            TooMuchWorkError: it came to more.
        """
        if place not in self._lines and place not in self._unlimited:
            self._enter(place)
        while place not in self._unlimited:
            # Bland's rule: the first variable that may enter, the first that may leave; so no dictionary comes again.
            line = self._lines[place]
            column = min((c for c, n in line.entries.items() if n > 0), default=None)
            if column is None:
                weights = {p: -n for p, n in line.entries.items() if p < self._places}
                return {**weights, place: line.scale}
            if work is not None and self.work > work:
                raise TooMuchWorkError
            self._enter(column)
        return None

    def _add(self, variable: int, line: _Line) -> None:
        self._lines[variable] = line
        for column in line.entries:
            self._users.setdefault(column, set()).add(variable)

    def _remove(self, variable: int) -> _Line:
        line = self._lines.pop(variable)
        for column in line.entries:
            self._users[column].discard(variable)
        return line

    def _enter(self, column: int) -> None:
        """Lets a variable grow until another one is zero, and exchanges the two."""
        leaving: int | None = None
        constant, entry = 0, -1
        for row in self._users.get(column, ()):
            line = self._lines[row]
            own = line.entries[column]
            if own >= 0:
                continue
            # The first is zero when the column has grown to constant / -entry.
            nearer = line.constant * -entry - constant * -own
            if leaving is None or nearer < 0 or (nearer == 0 and row < leaving):
                leaving, constant, entry = row, line.constant, own
        if leaving is None:
            self._forget(column)
        else:
            self._exchange(leaving, column)

    def _forget(self, column: int) -> None:
        """The variable grows without limit, and so do places with it: no proof mentions them."""
        grown = {row for row in self._users.get(column, ()) if row < self._places}
        for row in grown:
            self._remove(row)
        self._unlimited |= grown
        if column < self._places:
            self._unlimited.add(column)

    def _exchange(self, row: int, column: int) -> None:
        line = self._remove(row)
        # scale * row = constant + entry * column + rest, so -entry * column = constant + rest - scale * row
        entry = line.entries.pop(column)
        solved = _Line(-entry, line.constant, {**line.entries, row: -line.scale})
        solved.reduce()
        self._users.setdefault(row, set())
        for other in tuple(self._users.pop(column, ())):
            target = self._lines[other]
            factor = target.entries.pop(column)
            self._substitute(other, target, factor, solved)
        self._add(column, solved)

    def _substitute(self, variable: int, target: _Line, factor: int, solved: _Line) -> None:
        if solved.scale != 1:
            target.scale *= solved.scale
            target.constant *= solved.scale
            target.entries = {c: n * solved.scale for c, n in target.entries.items()}
        target.constant += factor * solved.constant
        entries = target.entries
        for c, n in solved.entries.items():
            before = entries.get(c)
            if before is None:
                entries[c] = factor * n
                self._users[c].add(variable)
                continue
            after = before + factor * n
            if after:
                entries[c] = after
            else:
                del entries[c]
                self._users[c].discard(variable)
        self.work += len(solved.entries)
        if target.scale != 1:
            target.reduce()
