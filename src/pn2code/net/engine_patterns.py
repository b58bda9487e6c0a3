"""What a warning of patterns is about: a variable that is there once more, a component that is no pattern."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from pn2code.diagnostics import Span
from pn2code.ml.core.terms import Apply, Builtin, Exp, Pat, PVar, RecordExp, Symbol
from pn2code.net.engine_binding import TakingArc
from pn2code.net.engine_parts import inside
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


def is_odd(e: Exp, terms: TermReader) -> bool:
    """Whether it is a tuple or record that is no pattern."""
    return isinstance(inside(e), RecordExp) and terms.pattern(e) is None


def odd_part(e: Exp, terms: TermReader) -> Exp:
    """The component of such a tuple or record that keeps it from being one; else the whole."""
    value = inside(e)
    parts = [part for _, part in value.fields] if isinstance(value, RecordExp) else []
    return next((part for part in parts if terms.pattern(part) is None), e)
