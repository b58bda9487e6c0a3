"""How `verify` can go about it: combinations of reductions, limits and options.

WHOLE                          # everything is looked at
ways(Random(1), is_cell=True, is_timed=False, number=12)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import combinations
from random import Random

from pn2code.verdict.whole import Checks
from pn2code.verify.exploring.limits import Approximation, Limits, Order, Reduction

MOST_STATES = 2_000
"""Of an exploration; where there are more it is not known, as where `--max-states` says so."""
LIMITS = (2, 7, 40, 200)
FROM = (1, 7, 40)
"""States from which on a cell is looked at in turns, or its tokens are counted up to a limit. Large cells only are so
by themselves; here all are."""


@dataclass(frozen=True)
class Way:
    """A combination.

    Args:
        name: in the words of the command line, where it has them.
        limits: of each exploration.
        checks: what is looked at besides the net.
        covering: whether runs are looked for that show that a place grows without bound.
        durations: whether commands are measured, and answers in seconds are given.
    """

    name: str
    limits: Limits
    checks: Checks = field(default_factory=Checks)
    covering: bool = True
    durations: bool = False


_ALL = Limits(max_states=MOST_STATES, memory=256, traces=0, turns_from=None, counts_from=None)
WHOLE = Way("--no-reduction", _ALL)


def ways(r: Random, *, is_cell: bool, is_timed: bool, number: int) -> list[Way]:
    """So many, drawn at random."""
    known = list(_known(is_timed=is_timed))
    if is_cell:
        known = [*known, *_of_cells(known)]
    return r.sample(known, min(number, len(known)))


def _known(*, is_timed: bool) -> Iterator[Way]:
    """All that make sense for any net."""
    for names in _reductions(is_timed=is_timed):
        one = replace(_ALL, reductions=names)
        said = " ".join(f"--reduce {x}" for x in names)
        if names:
            yield Way(said, one)
        for kind in Approximation:
            yield _way(f"{said} --approximate {kind}", one, approximation=kind)
        for n in LIMITS:
            yield _way(f"{said} --max-states {n}", one, max_states=n)
            yield _way(f"{said} --max-states {n} --order dfs", one, max_states=n, order=Order.DEPTH)
        yield _way(f"{said} --order dfs", one, order=Order.DEPTH)
        yield _way(f"{said} --threads 3", one, threads=3)
    yield replace(WHOLE, name="--unbounded-ok", covering=False)
    for n in LIMITS:
        limits = replace(_ALL, max_states=n)
        yield Way(f"--unbounded-ok --max-states {n}", limits, covering=False)


def _of_cells(known: list[Way]) -> Iterator[Way]:
    """Of cells there are more. Those of all nets are asked without the medium mostly, which takes long."""
    for first in FROM:
        for counted in (None, *FROM):
            name = f"turns from {first}, counts from {counted}"
            limits = replace(_ALL, turns_from=first, counts_from=counted)
            yield Way(name, limits)
            yield Way(f"{name} --no-medium", limits, Checks(channel_model=False))
            for n in LIMITS:
                part = replace(limits, max_states=n)
                yield Way(f"{name} --max-states {n}", part, Checks(channel_model=n < 10))
            for reduction in (Reduction.PARTIAL_ORDER, Reduction.SYMMETRY, Reduction.TIME):
                other = replace(limits, reductions=(reduction,))
                yield Way(f"{name} --reduce {reduction}", other, Checks(channel_model=False))
            both = Checks(channel_model=False)
            yield Way(f"{name} --no-medium --durations", limits, both, durations=True)
    yield Way("--no-controller", _ALL, Checks(controller=False))
    yield Way("--no-controller --no-medium", _ALL, Checks(controller=False, channel_model=False))
    yield Way("--durations", _ALL, durations=True)
    for n in LIMITS:
        yield Way(f"--durations --max-states {n}", replace(_ALL, max_states=n), durations=True)
    for way in known:
        if way.limits.reductions:
            yield replace(way, name=f"{way.name} --durations", durations=True)
    for way in known:
        yield replace(way, name=f"{way.name} --no-medium", checks=Checks(channel_model=False))


def _way(name: str, limits: Limits, **changed: object) -> Way:
    return Way(name.strip(), replace(limits, **changed))  # type: ignore[arg-type]


def _reductions(*, is_timed: bool) -> Iterator[tuple[Reduction, ...]]:
    kinds = [x for x in Reduction if is_timed == (x is Reduction.TIME)]  # not possible otherwise
    for number in range(len(kinds) + 1):
        yield from combinations(kinds, number)
