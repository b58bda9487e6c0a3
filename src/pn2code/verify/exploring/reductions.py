"""Which of the reductions that are asked for a net permits, and what the explorer needs for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin, Span
from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate
from pn2code.verify.codes import REDUCTION_NOT_POSSIBLE
from pn2code.verify.exploring import time_reduction
from pn2code.verify.exploring.dependency import Dependency, dependency
from pn2code.verify.exploring.elements import Elements, NotPossibleError, elements
from pn2code.verify.exploring.limits import Reduction
from pn2code.verify.exploring.progress import Progress
from pn2code.verify.exploring.time_reduction import NotReducible

WHY_NOT_REDUCIBLE: dict[Reduction, Callable[..., NotReducible | None]] = {
    Reduction.TIME: time_reduction.why_not_reducible,
}
"""What looks for the first thing in a net that is in the way of a reduction."""
OF_ELEMENTS = (Reduction.PARTIAL_ORDER, Reduction.SYMMETRY)
"""Reductions that rest on the table of binding elements."""
MOST_WITH_TIMES = 3_000_000
"""Markings that are looked at where the reduction by time is refused, and no limit is set. Each has its time then, so
a net that goes on has no end of them."""
_WITH_TIMES = (
    "the net is explored without it, so each marking has its time, and there may be no end of them: unless "
    f"`--max-states`, `--max-seconds` or `--memory` says otherwise, the exploration ends after {MOST_WITH_TIMES:,}"
)


@frozen
class Chosen:
    """The reductions that are used.

    Args:
        reductions: which.
        elements: the table of binding elements, None: none of them needs it.
        dependency: what partial order rests on instead where there is no such table.
        progress: the measure in the order of which markings are looked at, and forgotten; None: in another one.
    """

    reductions: tuple[Reduction, ...]
    elements: Elements | None
    dependency: Dependency | None = None
    progress: Progress | None = None

    def without_elements(self) -> Chosen:
        """Those that need no table."""
        return Chosen(tuple(r for r in self.reductions if r not in OF_ELEMENTS), None)

    def symmetry_names(self) -> tuple[str, ...]:
        """What is permuted, for people."""
        found = self.elements.symmetries if self.elements else None
        is_used = Reduction.SYMMETRY in self.reductions
        return found.names() if is_used and found is not None else ()


def possible(
    net: FlatNet,
    wanted: Sequence[Reduction],
    d: Diagnostics,
    predicates: Sequence[Predicate] = (),
) -> Chosen:
    """Those that keep the answers for this net; each of the others gives a warning.

    Args:
        net: the net.
        wanted: what was asked for.
        d: gets the warnings.
        predicates: conditions on markings that are asked for besides.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    found: list[Reduction] = []
    for reduction in wanted:
        if reduction not in WHY_NOT_REDUCIBLE:
            continue
        why = WHY_NOT_REDUCIBLE[reduction](net, predicates)
        if why is None:
            found.append(reduction)
        else:
            refuse(reduction, why.message, why.at, d)
    asked = [r for r in wanted if r in OF_ELEMENTS]
    try:
        table = elements(net, wants_symmetry=Reduction.SYMMETRY in asked) if asked else None
    except NotPossibleError as problem:
        return _by_transitions(net, wanted, found, str(problem), d)
    if table is None:
        return Chosen(tuple(r for r in wanted if r in found), None)
    if table.unfolding.has_priorities and asked == [Reduction.PARTIAL_ORDER]:
        return _by_transitions(net, wanted, found, "transitions have different priorities", d)
    found += _of_elements(net, table, wanted, d)
    is_used = any(r in OF_ELEMENTS for r in found)
    return Chosen(tuple(r for r in wanted if r in found), table if is_used else None)


def _by_transitions(
    net: FlatNet, wanted: Sequence[Reduction], found: list[Reduction], why: str, d: Diagnostics
) -> Chosen:
    """Those of a net of which partial order cannot go by binding elements, because of `why`."""
    table = None
    if Reduction.SYMMETRY in wanted:
        refuse(Reduction.SYMMETRY, why, Origin(net.file), d)
    if Reduction.PARTIAL_ORDER in wanted:
        try:
            table = dependency(net)
            found = [*found, Reduction.PARTIAL_ORDER]
        except NotPossibleError as problem:
            refuse(Reduction.PARTIAL_ORDER, str(problem), Origin(net.file), d)
    return Chosen(tuple(r for r in wanted if r in found), None, table)


def refuse(reduction: Reduction, why: str, at: Origin | Span, d: Diagnostics) -> None:
    """Reports that a reduction is not used."""
    d.warning(
        REDUCTION_NOT_POSSIBLE,
        f"the reduction `{reduction.value}` is not possible: {why}",
        at,
        hint=_WITH_TIMES if reduction is Reduction.TIME else "the net is explored without it",
    )


def _of_elements(
    net: FlatNet, table: Elements, wanted: Sequence[Reduction], d: Diagnostics
) -> list[Reduction]:
    found = []
    if Reduction.PARTIAL_ORDER in wanted:
        if table.unfolding.has_priorities:
            why = "transitions have different priorities"
            refuse(Reduction.PARTIAL_ORDER, why, Origin(net.file), d)
        else:
            found.append(Reduction.PARTIAL_ORDER)
    if Reduction.SYMMETRY in wanted:
        if table.symmetries is None or not table.symmetries.names():
            why = "no permutation of the colours of a colour set maps the net to itself"
            refuse(Reduction.SYMMETRY, why, Origin(net.file), d)
        else:
            found.append(Reduction.SYMMETRY)
    return found
