"""The head of net.c: the most tokens of each place, under what proves it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap

from pn2code.ir import nodes as ir

_WIDTH = 115


def proofs(places: Sequence[ir.Place]) -> Iterator[dict[str, list[str]]]:
    """For the template: lines that say what proves it, and lines of places with their bounds, in the order of places.

    Places of which nothing is known that is their array: `room for 64`.
    """
    grouped: dict[str, list[str]] = {}
    for place in places:
        if place.proof:
            most = f"room for {place.capacity}" if place.bound is None else str(place.bound)
            grouped.setdefault(place.proof, []).append(f"{place.name}: {most}")
    for proof, names in grouped.items():
        yield {
            "head": wrap(proof, _WIDTH, break_long_words=False, break_on_hyphens=False),
            "places": wrap(
                ", ".join(names), _WIDTH, break_long_words=False, break_on_hyphens=False
            ),
        }
