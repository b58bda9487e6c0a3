"""Which untimed places are packed, a counter of a few bits for each colour instead of a sorted array, and where.

    packing = choose(net, initial)      # widths from what the places hold at first
    ir = lower(partition, storage, d, packing=packing)
    ...
    packing = packing.wider("Top.P")    # a counter of that place has overflowed

A place can be packed when its colour set is finite and small: see `colours`. Subsets have counters for all colours of
their base.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Protocol

from pn2code.base.frozen import frozen, replace
from pn2code.ir import nodes as ir
from pn2code.ir.types import Descriptor, Rep
from pn2code.ml.core.colsets import Kind
from pn2code.ml.core.types import UNIT
from pn2code.net.flat import FlatNet


class Sum(Protocol):
    """What never changes: a sum of weight * marking of places (`structure.Sum`)."""

    @property
    def weights(self) -> Mapping[int, int]:
        """Place -> weight, all positive."""
        ...

    @property
    def most(self) -> int:
        """Most tokens of one colour in it."""
        ...

    @property
    def by_colour(self) -> bool:
        """Whether it holds for each colour; else for the numbers of tokens."""
        ...


MOST_COLOURS = 4096
MOST_BITS = 8192
"""Of one place."""
MOST_WIDTH = 32
LEAST_UNIT_WIDTH = 4
"""Tokens of one colour gather: the counter of such a place has at least so many bits."""
_NEAR, _NEAR_UNIT = 3, 2**16 - 1
"""Proven numbers of tokens that counters are made for."""
_WORD = 64
KEY_BITS = _WORD - 1
"""States with no more bits than that have the shortest keys."""
_MOST_SHARES = 12
_COLOUR_BYTES = 256
"""What `pn_colour_t` of pn_multiset.h has room for."""


@frozen
class Packing:
    """Widths of counters.

    Args:
        width: by place name, bits per counter, 1 to 32; 0: the place is not packed.
        default: of all other places; 0: only the named ones are packed.
        most_colours: places with more colours are not packed.
        successors: whether the net has functions that make all markings after a marking (pn_transition_t.successors).
        sums: of places, which never change.
    """

    width: Mapping[str, int]
    default: int = 1
    most_colours: int = MOST_COLOURS
    successors: bool = True
    sums: tuple[Sum, ...] = ()

    def of(self, place: str) -> int:
        """The width for a place, by its full name."""
        return self.width.get(place, self.default)

    def wider(self, place: str) -> Packing:
        """With twice the width for a place of which a counter has overflowed; beyond 32 bits it is not packed."""
        width = self.of(place) * 2
        return replace(self, width={**self.width, place: width if width <= MOST_WIDTH else 0})


def choose(
    net: FlatNet,
    initial: Sequence[Iterable[int]],
    proven: Mapping[int, int] | None = None,
    sums: tuple[Sum, ...] = (),
) -> Packing:
    """The widths to begin with.

    Args:
        net: the net.
        initial: for each place the counts of the different tokens that it holds at first.
        proven: by index, most tokens of one colour that a place can ever hold, where that is known.
        sums: as for `Packing`.
    """
    widths: dict[str, int] = {}
    for place, counts in zip(net.places, initial, strict=True):
        if place.colset.timed:
            continue
        most = max(counts, default=0)
        own = place.colset.resolved
        is_unit = own.type == UNIT or (own.kind is Kind.ENUM and len(own.names) == 1)
        width = 1 if most <= 1 else bits(2 * most)
        if is_unit:
            width = max(LEAST_UNIT_WIDTH, width)
        known = (proven or {}).get(place.index)
        if known is not None:
            # Of a large number it is seldom known that they are all of the same colour.
            is_near = known <= (_NEAR_UNIT if is_unit else _NEAR)
            width = bits(known) if is_near else min(width, bits(known))
        widths[place.name] = width
    return Packing(widths, sums=sums)


def bits(count: int) -> int:
    """The bits of a counter that goes up to `count`, at most 32."""
    return min(max(count.bit_length(), 1), MOST_WIDTH)


# --- colours --------------------------------------------------------------------------------------


def colours(descriptors: Mapping[str, Descriptor], key: str) -> int:
    """The number of colours of a colour set that can be packed; 0 if it cannot."""
    found = _count(descriptors, key, ())
    return found if 0 < found <= MOST_COLOURS and _size(descriptors, key) <= _COLOUR_BYTES else 0


def _count(descriptors: Mapping[str, Descriptor], key: str, outer: tuple[str, ...]) -> int:
    """0: more than can be packed, or unbounded."""
    d = descriptors[key]
    total = 0
    match d.type.rep:
        case Rep.UNIT:
            return 1
        case Rep.BOOL:
            return 2
        case Rep.CHAR:
            return 256
        case Rep.ENUM:
            return len(d.names)
        case Rep.INT:
            if d.low is None or d.high is None:
                return 0
            total = max(int(d.high) - int(d.low) + 1, 0)
        case Rep.STRUCT | Rep.UNION if key not in outer:
            total = 1 if d.type.rep is Rep.STRUCT else 0
            for _, part in d.fields:
                n = _count(descriptors, part, (*outer, key)) if part else 1
                if n == 0:
                    return 0
                total = total * n if d.type.rep is Rep.STRUCT else total + n
                if total > MOST_COLOURS:
                    return 0
        case _:
            return 0
    return total if total <= MOST_COLOURS else 0


def _size(descriptors: Mapping[str, Descriptor], key: str) -> int:
    """At least the bytes of a value in C."""
    d = descriptors[key]
    parts = [_size(descriptors, part) for _, part in d.fields if part]
    match d.type.rep:
        case Rep.STRUCT:
            return sum(parts) + 8
        case Rep.UNION:
            return max(parts, default=0) + 8
    return 8


# --- layout ---------------------------------------------------------------------------------------


def packed(
    places: Sequence[ir.Place], descriptors: Mapping[str, Descriptor], packing: Packing
) -> tuple[ir.Place, ...]:
    """The places, those that can be packed with the position of their counters."""
    sizes: dict[int, tuple[int, int]] = {}
    for p in places:
        n, width = colours(descriptors, p.table), packing.of(p.name)
        if p.timed or not 0 < n <= packing.most_colours or width <= 0:
            continue
        if n * width > _WORD:  # no counter lies across two words
            width = 1 << (width - 1).bit_length()
        if width <= MOST_WIDTH and n * width <= MOST_BITS:
            sizes[p.index] = (n, width)
    bits_of = {i: n * w for i, (n, w) in sizes.items()}
    shares: dict[int, tuple[tuple[int, int], ...]] = {}
    if sum(bits_of.values()) > KEY_BITS:
        shares = _shares(
            {p.index: (p.table, *sizes[p.index]) for p in places if p.index in sizes}, packing.sums
        )
    first = _positions(bits_of, shares)
    return tuple(
        replace(
            p,
            packed=ir.Packed(*sizes[p.index], first[p.index], shares.get(p.index, ())),
            capacity=sizes[p.index][0],
        )
        if p.index in sizes
        else p
        for p in places
    )


def _shares(
    shapes: Mapping[int, tuple[str, int, int]], sums: Iterable[Sum]
) -> dict[int, tuple[tuple[int, int], ...]]:
    """Places that follow from others, none of which follows from others itself: place -> (place, weight).

    Args:
        shapes: of the packed places: colour set, number of counters, bits of a counter.
        sums: that never change.
    """
    found: dict[int, tuple[tuple[int, int], ...]] = {}
    needed: set[int] = set()
    for s in sums:
        if len(s.weights) > _MOST_SHARES or not all(p in shapes for p in s.weights):
            continue
        own = {shapes[p] for p in s.weights}
        is_aligned = len(own) == 1 if s.by_colour else all(n == 1 for _, n, _ in own)
        if not is_aligned or any(p in found for p in s.weights):
            continue
        for place, weight in s.weights.items():
            if weight == 1 and place not in needed and s.most < 1 << shapes[place][2]:
                others = tuple((p, w) for p, w in s.weights.items() if p != place)
                found[place] = others
                needed.update(p for p, _ in others)
                break
    return found


def key_bits(places: Iterable[ir.Place]) -> int:
    """The bits of the packed part up to the last that does not follow from others."""
    return packed_bits(p for p in places if p.packed and not p.packed.shares)


def _positions(sizes: Mapping[int, int], last: Collection[int] = ()) -> dict[int, int]:
    """The first bit of each: large ones begin with a word, others lie in one, in the first that has room.

    Args:
        sizes: in bits.
        last: these come behind all others.
    """
    first: dict[int, int] = {}
    used: list[int] = []
    for is_last in (False, True):
        _position({p: n for p, n in sizes.items() if (p in last) == is_last}, first, used)
    return first


def _position(sizes: Mapping[int, int], first: dict[int, int], used: list[int]) -> None:
    """Adds to `first`; `used`: bits of each word."""
    for place, size in sizes.items():
        if size > _WORD:
            first[place] = len(used) * _WORD
            used += [_WORD] * (size // _WORD) + ([size % _WORD] if size % _WORD else [])
    for place, size in sizes.items():
        if size <= _WORD:
            word = next((k for k, n in enumerate(used) if n + size <= _WORD), len(used))
            if word == len(used):
                used.append(0)
            first[place] = word * _WORD + used[word]
            used[word] += size


def packed_bits(places: Iterable[ir.Place]) -> int:
    """The bits of the packed part up to the last that is used."""
    return max(
        (p.packed.bit + p.packed.colours * p.packed.width for p in places if p.packed), default=0
    )
