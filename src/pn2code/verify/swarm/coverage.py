"""How much a swarm has seen, as far as that can be told from how often its searches have seen the same.

Each search tells the least hashes of the markings that it has looked at. The least ones of all searches together are a
sample of all that was looked at, as good as one by chance, and of each marking in it it is known which searches have
looked at it: a hash that is among the least ones of all is among the least ones of each search that had it. From the
k least ones follows how many markings there are (Bar-Yossef et al. 2002), and from those that one search alone has
seen, and two, how many nobody has seen (Chao 1987).

That would be right if each search took its markings by chance. They all begin at the initial marking and see what is
near more often than what is far: there may be many more markings than estimated, hardly ever fewer.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Sequence

from pn2code.base.frozen import frozen

_ALL = 1 << 64
"""Hashes that there are."""


@frozen
class Coverage:
    """What is estimated.

    Args:
        searches: those that were compared.
        markings: different ones that were looked at, all searches together.
        is_exact: whether that is counted and not estimated (apart from hashes that are the same by chance).
        alone: the part of them that one search alone has looked at.
        total: markings that can be reached, or there are more; None: one search alone tells nothing of that.
    """

    searches: int
    markings: float
    is_exact: bool
    alone: float
    total: float | None

    @property
    def part(self) -> float | None:
        """The part of all markings that was looked at, or it is less; None: not known."""
        return None if not self.total else self.markings / self.total


def coverage(sketches: Sequence[Sequence[int]], most: int) -> Coverage:
    """From the least hashes of each search, in ascending order, `most` at most."""
    sample: list[int] = []
    for sketch in sketches:
        enough = bisect_right(sketch, sample[-1]) if len(sample) == most else len(sketch)
        sample = sorted({*sample, *sketch[:enough]})[:most]
    chosen = frozenset(sample)
    seen = Counter(h for sketch in sketches for h in chosen.intersection(sketch))
    # Where a search has told as many as it may, nothing is known of greater ones.
    is_exact = len(sample) < most and all(len(sketch) < most for sketch in sketches)
    markings = float(len(sample)) if is_exact else estimated(sample)
    times = Counter(seen[h] for h in sample)
    alone = times[1] / len(sample) if sample else 0.0
    scale = markings / len(sample) if sample else 0.0
    total = None
    if len(sketches) > 1:
        total = markings + unseen(times[1] * scale, times[2] * scale, len(sketches))
    return Coverage(len(sketches), markings, is_exact, alone, total)


def estimated(sample: Sequence[int]) -> float:
    """How many different hashes there are, of which these are the least ones."""
    if len(sample) < 2:
        return float(len(sample))
    return (len(sample) - 1) / ((sample[-1] + 1) / _ALL)


def unseen(once: float, twice: float, searches: int) -> float:
    """Markings that nobody has seen, or more, if so many were seen by one search and by two."""
    return (searches - 1) / searches * once * max(once - 1.0, 0.0) / (2.0 * (twice + 1.0))
