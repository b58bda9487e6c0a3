"""Multi-sets and timed multi-sets: what places hold. Immutable and hashable.

MultiSet.of([1, 1, 5]) + MultiSet.of([5])        # 2`1 ++ 2`5
TimedMultiSet.of([Timed(1, 3), Timed(1, 7)])     # 1`1@3 +++ 1`1@7
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from pn2code.semantics.values.data import Timed, Value


class NotContained(ValueError):  # noqa: N818
    """A multi-set was to be taken from one that does not contain it."""


@dataclass(frozen=True, slots=True)
class MultiSet:
    """A multi-set of values.

    Args:
        counts: value -> how many there are, all positive. Not to be changed.
    """

    counts: Mapping[Value, int] = field(default_factory=dict)

    @staticmethod
    def of(items: Iterable[Value]) -> MultiSet:
        """The multi-set of the items."""
        counts: dict[Value, int] = {}
        for item in items:
            counts[item] = counts.get(item, 0) + 1
        return MultiSet(counts)

    def coefficient(self, value: Value) -> int:
        """How many there are of a value."""
        return self.counts.get(value, 0)

    def __len__(self) -> int:
        """Return the number of tokens."""
        return sum(self.counts.values())

    def __iter__(self) -> Iterator[Value]:
        """Iterate over the tokens, each as often as it is there."""
        return (value for value, count in self.counts.items() for _ in range(count))

    def __hash__(self) -> int:
        return hash(frozenset(self.counts.items()))

    def __le__(self, other: MultiSet) -> bool:
        """Whether the other contains this one."""
        return all(count <= other.coefficient(value) for value, count in self.counts.items())

    def __add__(self, other: MultiSet) -> MultiSet:
        counts = dict(self.counts)
        for value, count in other.counts.items():
            counts[value] = counts.get(value, 0) + count
        return MultiSet(counts)

    def __sub__(self, other: MultiSet) -> MultiSet:
        """Without the other; raises NotContained when that is not contained."""
        if not other <= self:
            raise NotContained
        left = {value: n - other.coefficient(value) for value, n in self.counts.items()}
        return MultiSet({value: n for value, n in left.items() if n > 0})

    def __rmul__(self, factor: int) -> MultiSet:
        """`factor` times the multi-set; empty when it is not positive."""
        if factor <= 0:
            return MultiSet()
        return MultiSet({value: factor * n for value, n in self.counts.items()})


@dataclass(frozen=True, slots=True)
class TimedMultiSet:
    """A multi-set of tokens with time stamps.

    Args:
        stamps: value -> the stamps of its tokens, ascending, at least one. Not to be changed.
    """

    stamps: Mapping[Value, tuple[int | float, ...]] = field(default_factory=dict)

    @staticmethod
    def of(tokens: Iterable[Timed]) -> TimedMultiSet:
        """The timed multi-set of the tokens."""
        return TimedMultiSet() + tokens

    def __len__(self) -> int:
        """Return the number of tokens."""
        return sum(len(stamps) for stamps in self.stamps.values())

    def __iter__(self) -> Iterator[Timed]:
        """Iterate over the tokens."""
        return (Timed(value, stamp) for value, stamps in self.stamps.items() for stamp in stamps)

    def __hash__(self) -> int:
        return hash(frozenset(self.stamps.items()))

    def __add__(self, tokens: Iterable[Timed]) -> TimedMultiSet:
        found = dict(self.stamps)
        for token in tokens:
            found[token.value] = tuple(sorted((*found.get(token.value, ()), token.stamp)))
        return TimedMultiSet(found)

    def __sub__(self, tokens: Iterable[Timed]) -> TimedMultiSet:
        """Without exactly these tokens; raises NotContained when one of them is not there."""
        found = dict(self.stamps)
        for token in tokens:
            stamps = list(found.pop(token.value, ()))
            if token.stamp not in stamps:
                raise NotContained
            stamps.remove(token.stamp)
            if stamps:
                found[token.value] = tuple(stamps)
        return TimedMultiSet(found)

    def untimed(self) -> MultiSet:
        """Without the stamps."""
        return MultiSet({value: len(stamps) for value, stamps in self.stamps.items()})

    def latest(self, value: Value, early: float, now: float) -> Timed | None:
        """Of the available tokens of a value the one with the latest stamp (Jensen's rule).

        Available is what is stamped `now`, before, or later by no more than `early`.
        """
        admissible = [stamp for stamp in self.stamps.get(value, ()) if stamp - early <= now]
        return Timed(value, admissible[-1]) if admissible else None

    def available(self, now: float) -> list[Timed]:
        """The tokens with a stamp not after `now`."""
        return [token for token in self if token.stamp <= now]
