"""A net whose markings stand for several each, and the text of it that diagrams are made from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.contest.reduction.net import Affine
from pn2code.contest.tables import Tables


@frozen
class Counted:
    """A net with the same numbers, if they are counted as it says.

    Args:
        tables: the net; transitions that change nothing are there to be counted.
        leaves: place -> places of the net before for which it stands.
        kept: place -> its number in the net before.
        total: the tokens in a marking; of places with several leaves, the most that they can be.
        sums: the tokens of the places that are gone, likewise.
        units: sets of places of which one at most is marked, with one token.
        level: place -> the place that diagrams have for it, and its value there; 0: a place of its own.
        drawn: the net that diagrams have: a unit is one place, from which an arc takes a value.
    """

    tables: Tables
    leaves: tuple[int, ...]
    kept: tuple[int, ...]
    total: Affine
    sums: tuple[Affine, ...]
    units: tuple[tuple[int, ...], ...]
    level: Mapping[int, tuple[int, int]]
    drawn: Tables

    @staticmethod
    def of(
        tables: Tables,
        leaves: tuple[int, ...],
        kept: tuple[int, ...],
        total: Affine,
        sums: tuple[Affine, ...],
        units: tuple[tuple[int, ...], ...] = (),
    ) -> Counted:
        """As above."""
        level = {p: (i, v) for i, unit in enumerate(units) for v, p in enumerate(unit, 1)}
        alone = [p for p in range(len(leaves)) if p not in level]
        level |= {p: (i, 0) for i, p in enumerate(alone, len(units))}
        drawn = _drawn(tables, level, len(units) + len(alone))
        return Counted(tables, leaves, kept, total, sums, units, level, drawn)

    def without_units(self) -> Counted:
        """The same with a place of its own for each place."""
        return Counted.of(self.tables, self.leaves, self.kept, self.total, self.sums)

    def text(self, order: Sequence[int]) -> str:
        """The net of diagrams with the sums as questions: first that of the marking, then those of places.

        Args:
            order: of the places of `drawn`.
        """
        asked = [
            f"{i} bound {self._terms(s)} {-s.constant}"
            for i, s in enumerate((self.total, *self.sums))
        ]
        text = self.drawn.text(asked, order)
        leaves = [1] * len(self.drawn.initial)
        for p, (at, value) in self.level.items():
            leaves[at] = 1 if value else self.leaves[p]
        text += f"leaves {' '.join(map(str, leaves))}\nexact {len(self.units)}\n"
        for i, unit in enumerate(self.units):
            text += f"{i} {len(unit)} {' '.join(str(self.leaves[p]) for p in unit)}\n"
        return text

    def _terms(self, sum_: Affine) -> str:
        """A term for each place, of a unit for each of its values in turn, if any of them counts."""
        used = {self.level[p][0] for p in sum_.factors}
        terms = []
        for i, unit in enumerate(self.units):
            if i in used:
                terms += [f"{i} {sum_.factors.get(p, 0)}" for p in unit]
        for p, n in sum_.factors.items():
            at, value = self.level[p]
            terms += [] if value else [f"{at} {n}"]
        return " ".join(["sum", str(len(terms)), *terms])


def _drawn(tables: Tables, level: Mapping[int, tuple[int, int]], places: int) -> Tables:
    initial = [0] * places
    for p, tokens in enumerate(tables.initial):
        at, value = level[p]
        initial[at] += value * tokens if value else tokens
    found = []
    for pre, post in zip(tables.pre, tables.post, strict=True):
        taken, put = _valued(pre, level), _valued(post, level)
        if taken is not None and put is not None:
            found.append((taken, put))
    return Tables(tuple(initial), tuple(a for a, _ in found), tuple(b for _, b in found), {}, {})


def _valued(arcs: Mapping[int, int], level: Mapping[int, tuple[int, int]]) -> dict[int, int] | None:
    """Arcs in values; None: the transition is dead, since it needs, or makes, two tokens in a unit."""
    found: dict[int, int] = {}
    for p, n in arcs.items():
        at, value = level[p]
        if value and (n > 1 or at in found):
            return None
        found[at] = value or n
    return found
