"""Multi-sets and timed multi-sets: what places hold. Immutable and hashable.

MultiSet.of([1, 1, 5]) + MultiSet.of([5])        # 2`1 ++ 2`5
TimedMultiSet.of([Timed(1, 3), Timed(1, 7)])     # 1`1@3 +++ 1`1@7
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from pn2code.semantics.values.data import Timed, Value, zero_signs


class NotContained(ValueError):
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

    Values that differ only in the sign of a zero are equal. Tokens of one stamp are one value then, the first that was
    put; those of other stamps keep theirs.

    Args:
        stamps: value (that of the earliest token) -> the stamps of its tokens, ascending, at least one. Not to be
            changed.
        zeros: of values with zeros: the value of each token, in the order of the stamps.
    """

    stamps: Mapping[Value, tuple[int | float, ...]] = field(default_factory=dict)
    zeros: Mapping[Value, tuple[Value, ...]] = field(default_factory=dict, compare=False)

    @staticmethod
    def of(tokens: Iterable[Timed]) -> TimedMultiSet:
        """The timed multi-set of the tokens."""
        return TimedMultiSet() + tokens

    def __len__(self) -> int:
        """Return the number of tokens."""
        return sum(len(stamps) for stamps in self.stamps.values())

    def __iter__(self) -> Iterator[Timed]:
        """Iterate over the tokens."""
        return (token for value in self.stamps for token in self.tokens(value))

    def tokens(self, value: Value) -> tuple[Timed, ...]:
        """The tokens of a value, the earliest first."""
        stamps = self.stamps.get(value, ())
        values = self.zeros.get(value) or (value,) * len(stamps)
        return tuple(Timed(v, stamp) for v, stamp in zip(values, stamps, strict=True))

    def __hash__(self) -> int:
        return hash(frozenset(self.stamps.items()))

    def __add__(self, tokens: Iterable[Timed]) -> TimedMultiSet:
        found, zeros = dict(self.stamps), dict(self.zeros)
        for token in tokens:
            value, stamp = token.value, token.stamp
            stamps = found.get(value, ())
            if not any(True for _ in zero_signs(value)):
                found[value] = tuple(sorted((*stamps, stamp)))
                continue
            values = zeros.pop(value, ())
            found.pop(value, None)
            at = bisect_right(stamps, stamp)
            own = values[at - 1] if at > 0 and stamps[at - 1] == stamp else value
            values = (*values[:at], own, *values[at:])
            found[values[0]] = (*stamps[:at], stamp, *stamps[at:])
            zeros[values[0]] = values
        return TimedMultiSet(found, zeros)

    def __sub__(self, tokens: Iterable[Timed]) -> TimedMultiSet:
        """Without exactly these tokens; raises NotContained when one of them is not there."""
        found, zeros = dict(self.stamps), dict(self.zeros)
        for token in tokens:
            value = token.value
            stamps = found.pop(value, ())
            if token.stamp not in stamps:
                raise NotContained
            at = stamps.index(token.stamp)
            left = (*stamps[:at], *stamps[at + 1 :])
            values = zeros.pop(value, ())
            if values and left:
                values = (*values[:at], *values[at + 1 :])
                value = values[0]
                zeros[value] = values
            if left:
                found[value] = left
        return TimedMultiSet(found, zeros)

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
