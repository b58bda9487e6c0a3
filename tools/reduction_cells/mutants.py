"""Wrong versions of turns: each forgets one of the conditions of `pn2code.verify.exploring.turns`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from pn2code.verify.exploring.turns import Member, Turns

NO_GROUPS = "places are not seen together"
RASH = "a cycle does not matter"
Mutant = Callable[[Turns], Turns]


def _each(change: Callable[[Member], Member]) -> Mutant:
    return lambda table: replace(table, members=tuple(map(change, table.members)))


def _without_reasons(m: Member) -> Member:
    """A disabled transition stays so by itself."""
    return replace(m, helpers=(), reasons=tuple(replace(r, helpers=()) for r in m.reasons))


def _half(numbers: tuple[int, ...]) -> tuple[int, ...]:
    return numbers[: len(numbers) // 2]


MUTANTS: dict[str, Mutant] = {
    "no rivals": _each(lambda m: replace(m, rivals=())),
    "half of the rivals": _each(lambda m: replace(m, rivals=_half(m.rivals))),
    "what is disabled stays so": _each(_without_reasons),
    "half of what ends a reason": _each(
        lambda m: replace(m, reasons=tuple(replace(r, helpers=_half(r.helpers)) for r in m.reasons))
    ),
    "nothing holds others back": _each(lambda m: replace(m, enables=())),
    "all is taken": _each(
        lambda m: replace(m, taken=tuple((p, 1_000_000) for r in m.reasons for p in [r.place]))
    ),
    "every place lacks tokens": _each(
        lambda m: replace(
            m, reasons=tuple(replace(r, least=1_000_000) for r in m.reasons if r.least)
        )
    ),
}
