"""Arcs whose records CPN Tools does not find, because their fields are written in another order.

    colset R = record a : INT * b : INT    in A : {b = j, a = i}    guard [i = 1]

It keeps the tokens of a place sorted by the components that transitions know before they look for a token, and goes by
the position of a component on the arc where it means its position in the colour set: here it sorts by `b`, and searches
for `a`. So it misses tokens, or cannot compile the code where the two have different types. (Found by experiment.)
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Exp, RecordExp, Symbol
from pn2code.net.engine_binding import TakingArc
from pn2code.net.engine_parts import PartReader, inside
from pn2code.net.uses import NetVariables


def fields(colset: Colset) -> tuple[str, ...]:
    """The names of a colour set's components, in the order in which it declares them."""
    resolved = colset.resolved
    if resolved.kind is Kind.RECORD:
        return resolved.labels
    if resolved.kind is Kind.PRODUCT:
        return tuple(str(i) for i in range(1, len(resolved.components) + 1))
    return ()


def misplaced(
    arcs: Sequence[TakingArc], guards: Iterable[Exp], reader: PartReader, variables: NetVariables
) -> Iterator[tuple[int, list[str]]]:
    """Arcs of which CPN Tools may miss tokens: which, and the fields that may be known before."""
    records = [
        (i, value)
        for i, arc in enumerate(arcs)
        for term in arc.inscription.terms
        if isinstance(value := inside(term.value), RecordExp) and _moved(value, arc.node.fields)
    ]
    if not records:
        return
    terms = [term for arc in arcs for term in arc.inscription.terms]
    counts = Counter(s for term in terms for s in variables.seen(term.value))
    equated = _equated(guards, reader)
    known = {s for s, n in counts.items() if n > 1} | equated
    for i, value in records:
        parts = {name: variables.seen(part).keys() for name, part in value.fields}
        named = [x for x in _moved(value, arcs[i].node.fields) if known >= parts[x]]
        if named and not all(equated >= part for part in parts.values()):  # not a whole token
            yield i, named


def _moved(value: RecordExp, declared: tuple[str, ...]) -> list[str]:
    """The fields that stand elsewhere than in the colour set."""
    names = [name for name, _ in value.fields]
    if len(names) != len(declared):
        return []
    return [name for name, there in zip(names, declared, strict=True) if name != there]


def _equated(guards: Iterable[Exp], reader: PartReader) -> set[Symbol]:
    """Variables that an equation of the guard may give a value."""
    items = (reader.item(guard) for guard in guards)
    sides = (side for item in items for side in item.sides or ())
    return {symbol for side in sides if side.is_pattern for symbol in side.seen}
