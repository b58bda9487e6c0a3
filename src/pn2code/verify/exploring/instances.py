"""Equal parts of a net that can be exchanged, as `find_instances` has found and proved them.

found.families        # (Family(Top.Robot1, Top.Robot2, Top.Robot3),)
found.text()          # for the explorer
found.expanded(said)  # what it says of representatives, for each place and transition
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.result import Exploration

MAGIC = "pn2code-instances 1"


@frozen
class Part:
    """One of equal parts: its places and transitions (indices), each at the position of those it is exchanged with."""

    places: tuple[int, ...]
    transitions: tuple[int, ...]


@frozen
class Family:
    """Parts of which any two can be exchanged.

    Args:
        parts: two at least.
        names: for people, of each part.
    """

    parts: tuple[Part, ...]
    names: tuple[str, ...]


@frozen
class Instances:
    """The families of a net, inner ones before those that have them in their parts."""

    net: FlatNet
    families: tuple[Family, ...]

    def names(self) -> tuple[str, ...]:
        """For people."""
        return tuple(f"exchanges of {', '.join(f.names)}" for f in self.families)

    @property
    def order(self) -> int:
        """Of the group: how many permutations there are."""
        return math.prod(math.factorial(len(f.parts)) for f in self.families)

    def expanded(self, found: Exploration) -> Exploration:
        """What has been seen of representatives, for each place and transition.

        The parts hold the same at first, so what can be reached is the same after each exchange: what a place may hold,
        all may that it can be exchanged with, and what occurs of a transition occurs of all of them.
        """
        bounds = found.bounds
        if bounds is not None:
            low: dict[int, int] = {}
            high: dict[int, int] = {}
            orbits = self.orbits_of_places()
            for orbit, b in zip(orbits, bounds, strict=True):
                low[orbit] = min(b.lower, low.get(orbit, b.lower))
                high[orbit] = max(b.upper, high.get(orbit, b.upper))
            bounds = tuple(
                replace(b, lower=low[orbit], upper=high[orbit])
                for orbit, b in zip(orbits, bounds, strict=True)
            )
        fired: Counter[int] = Counter()
        of = self.orbits_of_transitions()
        for orbit, count in zip(of, found.fired, strict=True):
            fired[orbit] += count
        return replace(found, bounds=bounds, fired=tuple(fired[orbit] for orbit in of))

    def text(self) -> str:
        """In the form that the explorer reads: numbers, in lines for people."""
        rows: list[Sequence[object]] = [[len(self.net.places), len(self.net.transitions)]]
        rows.append([len(self.families)])
        for f in self.families:
            first = f.parts[0]
            rows.append([len(f.parts), len(first.places), len(first.transitions)])
            rows += [[*part.places, *part.transitions] for part in f.parts]
        lines = [MAGIC, *(" ".join(map(str, row)) for row in rows), "end"]
        return "\n".join(lines) + "\n"

    def orbits_of_places(self) -> list[int]:
        """For each place the least one that it can be exchanged with."""
        return self._orbits(len(self.net.places), [p.places for p in self._parts()])

    def orbits_of_transitions(self) -> list[int]:
        """The same for transitions."""
        return self._orbits(len(self.net.transitions), [p.transitions for p in self._parts()])

    def _parts(self) -> Iterator[Part]:
        for f in self.families:
            for part in f.parts[1:]:
                yield f.parts[0]
                yield part

    @staticmethod
    def _orbits(count: int, pairs: Sequence[Sequence[int]]) -> list[int]:
        least = list(range(count))

        def of(i: int) -> int:
            while least[i] != i:
                i = least[i]
            return i

        for first, other in zip(pairs[::2], pairs[1::2], strict=True):
            for a, b in zip(first, other, strict=True):
                low, high = sorted((of(a), of(b)))
                least[high] = low
        return [of(i) for i in range(count)]
