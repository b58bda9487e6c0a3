"""What a warning of patterns is about: a variable that is there once more, a component that is no pattern."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from pn2code.diagnostics import Span
from pn2code.ml.core.terms import Apply, Builtin, Exp, Pat, PVar, RecordExp, Symbol, Var
from pn2code.net.engine_binding import TakingArc
from pn2code.net.engine_parts import PartReader, inside
from pn2code.net.terms import TermReader
from pn2code.net.uses import walk_pattern


def on_arcs(arcs: Sequence[TakingArc]) -> Iterator[tuple[Symbol, Span]]:
    """Variables that are twice in the pattern of an arc, and their second place."""
    for arc in arcs:
        for term in arc.inscription.terms:
            yield from twice(term.pattern)


def in_guard(guards: Sequence[Exp], terms: TermReader) -> Iterator[tuple[Symbol, Span]]:
    """Those that are twice in a side of an equation that is a pattern."""
    for guard in guards:
        match inside(guard):
            case Apply(Builtin("="), RecordExp((("1", left), ("2", right)))):
                yield from twice(terms.pattern(left))
                yield from twice(terms.pattern(right))
            case _:
                pass


def twice(pattern: Pat | None) -> Iterator[tuple[Symbol, Span]]:
    """Variables that a pattern has twice, once each, and their second place."""
    places = [p for p in walk_pattern(pattern) if isinstance(p, PVar)] if pattern else []
    again = [(b.symbol, b.span) for a, b in combinations(places, 2) if a.symbol == b.symbol]
    yield from dict(reversed(again)).items()


def is_odd(e: Exp, reader: PartReader) -> bool:
    """Whether it is a tuple or record that is no pattern."""
    return isinstance(inside(e), RecordExp) and not reader.is_pattern(e)


def odd_part(arc: TakingArc, reader: PartReader) -> Exp:
    """The component that keeps a tuple or record on the arc from being a pattern; else the tuple, or all.

    A constant that is there once more is one: in the code it is a variable, which a pattern cannot have twice.
    """
    values = (inside(term.value) for term in arc.inscription.terms)
    value = next((v for v in values if is_odd(v, reader)), arc.inscription.value)
    met: set[str] = set()
    for _, part in value.fields if isinstance(value, RecordExp) else ():
        if not reader.is_pattern(part) or (isinstance(part, Var) and part.span.text in met):
            return part
        met.add(part.span.text)
    return value
