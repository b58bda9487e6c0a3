"""What a step changes, so that it can be taken back: the tokens that came and went, not a copy of the marking.

changes = Changes(net).between(before, after)
applied(after, changes, back=True)                # before

Places with few colours, and those whose tokens hold reals (equal zeros may differ in the sign), are kept as they were;
of the others the colours that have changed are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.ml.core.reals import may_hold_reals
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import Marking, PlaceMarking
from pn2code.semantics.values.data import Value
from pn2code.semantics.values.multiset import MultiSet, TimedMultiSet

FEW = 24
"""A place with at most so many colours is kept whole: to tell what has changed takes as much."""

_TOKEN_BYTES = 200
_STEP_BYTES = 600


@frozen
class Whole:
    """A place as it was, and as it is."""

    place: int
    before: PlaceMarking
    after: PlaceMarking


@frozen
class Colours:
    """The colours of a place that have changed: (value, what there was of it, what there is); None is nothing."""

    place: int
    rows: tuple[tuple[Value, Any, Any], ...]


Change = Whole | Colours


@frozen
class Changes:
    """Tells what has changed between two markings of a net.

    Args:
        exact: the places that are always kept whole.
    """

    exact: frozenset[int]

    @staticmethod
    def of(net: FlatNet) -> Changes:
        """For the markings of a net."""
        datatypes = net.program.datatypes
        reals = (p.index for p in net.places if may_hold_reals(p.colset.type, datatypes))
        return Changes(frozenset(reals))

    def between(self, before: Marking, after: Marking) -> tuple[Change, ...]:
        """The places that are not the same."""
        found: list[Change] = []
        pairs = zip(before.places, after.places, strict=True)
        for place, (old, new) in enumerate(pairs):
            if old is new:
                continue
            one, other = contents(old), contents(new)
            if place in self.exact or len(one) + len(other) <= FEW:
                found.append(Whole(place, old, new))
            elif rows := _rows(one, other):
                found.append(Colours(place, rows))
        return tuple(found)


def contents(tokens: PlaceMarking) -> Mapping[Value, Any]:
    """What a place holds by value."""
    return tokens.counts if isinstance(tokens, MultiSet) else tokens.stamps


def _rows(
    one: Mapping[Value, Any], other: Mapping[Value, Any]
) -> tuple[tuple[Value, Any, Any], ...]:
    rows = [(value, n, other.get(value)) for value, n in one.items() if other.get(value) != n]
    rows += [(value, None, n) for value, n in other.items() if value not in one]
    return tuple(rows)


def applied(marking: Marking, changes: Sequence[Change], *, back: bool = False) -> Marking:
    """The tokens of a marking with these changes made, or taken back; time and references are as before."""
    places = list(marking.places)
    for change in changes:
        if isinstance(change, Whole):
            places[change.place] = change.before if back else change.after
            continue
        old = places[change.place]
        held = dict(contents(old))
        for value, before, after in change.rows:
            new = before if back else after
            if new is None:
                del held[value]
            else:
                held[value] = new
        places[change.place] = MultiSet(held) if isinstance(old, MultiSet) else TimedMultiSet(held)
    return replace(marking, places=tuple(places))


def weight(changes: Sequence[Change]) -> int:
    """About how many bytes they take."""
    total = _STEP_BYTES
    for change in changes:
        if isinstance(change, Whole):
            total += _TOKEN_BYTES * (len(contents(change.before)) + len(contents(change.after)))
        else:
            total += _TOKEN_BYTES * len(change.rows)
    return total
