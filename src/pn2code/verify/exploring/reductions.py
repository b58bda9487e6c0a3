"""Which of the reductions that are asked for a net permits, and what the explorer needs for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin, Span
from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate
from pn2code.verify.codes import REDUCTION_NOT_POSSIBLE
from pn2code.verify.exploring import time_reduction
from pn2code.verify.exploring.dependency import Dependency, dependency
from pn2code.verify.exploring.elements import Elements, NotPossibleError, elements
from pn2code.verify.exploring.find_instances import instances, why_none
from pn2code.verify.exploring.instances import Instances
from pn2code.verify.exploring.invariant_questions import AskedOf
from pn2code.verify.exploring.limits import Reduction
from pn2code.verify.exploring.progress import Progress
from pn2code.verify.exploring.result import Exploration
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
        instances: the parts that symmetry exchanges; None: it is of colours, and rests on the table.
        progress: the measure in the order of which markings are looked at, and forgotten; None: in another one.
    """

    reductions: tuple[Reduction, ...]
    elements: Elements | None
    dependency: Dependency | None = None
    instances: Instances | None = None
    progress: Progress | None = None

    def without_elements(self) -> Chosen:
        """Those that need no table."""
        return Chosen(tuple(r for r in self.reductions if r not in OF_ELEMENTS), None)

    def told(self, found: Exploration, net: FlatNet) -> Exploration:
        """What was found, in terms of the whole net."""
        if self.instances is not None and found.told:
            found = self.instances.expanded(found)
        measure = self.progress.names(net) if self.progress is not None else ""
        return replace(found, symmetries=self.symmetry_names(), measure=measure)

    def symmetry_names(self) -> tuple[str, ...]:
        """What is permuted, for people."""
        found = self.elements.symmetries if self.elements else None
        is_used = Reduction.SYMMETRY in self.reductions
        if is_used and self.instances is not None:
            return self.instances.names()
        return found.names() if is_used and found is not None else ()


def possible(
    net: FlatNet,
    wanted: Sequence[Reduction],
    d: Diagnostics,
    predicates: Sequence[Predicate] = (),
    storage: Mapping[str, str] | None = None,
    questions: str = "",
) -> Chosen:
    """Those that keep the answers for this net; each of the others gives a warning.

    Args:
        net: the net.
        wanted: what was asked for.
        d: gets the warnings.
        predicates: conditions on markings that are asked for besides.
        storage: as for `Game`.
        questions: what is asked (`properties.questions`).

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
    parts = None
    if Reduction.SYMMETRY in asked:
        parts = instances(net, storage or {}, AskedOf(questions, predicates))
    try:
        table = elements(net, wants_symmetry=Reduction.SYMMETRY in asked) if asked else None
    except NotPossibleError as problem:
        return _by_transitions(net, wanted, found, str(problem), d, parts, questions)
    if table is None:
        return Chosen(tuple(r for r in wanted if r in found), None)
    if table.unfolding.has_priorities and asked == [Reduction.PARTIAL_ORDER]:
        return _by_transitions(net, wanted, found, "transitions have different priorities", d, None)
    others = table.symmetries.order if table.symmetries is not None else 1
    if asked == [Reduction.SYMMETRY] and parts is not None and parts.order > others:
        return _of_parts(wanted, found, parts)
    has_parts = parts is not None and bool(parts.families)
    found += _of_elements(net, table, wanted, d, has_parts=has_parts)
    is_used = any(r in OF_ELEMENTS for r in found)
    return Chosen(tuple(r for r in wanted if r in found), table if is_used else None)


def _of_parts(wanted: Sequence[Reduction], found: list[Reduction], parts: Instances) -> Chosen:
    """With the exchange of parts as the symmetry."""
    used = (*found, Reduction.SYMMETRY)
    return Chosen(tuple(r for r in wanted if r in used), None, None, parts)


def _by_transitions(
    net: FlatNet,
    wanted: Sequence[Reduction],
    found: list[Reduction],
    why: str,
    d: Diagnostics,
    parts: Instances | None,
    questions: str = "",
) -> Chosen:
    """Those of a net of which partial order and colours cannot go by binding elements, because of `why`."""
    table = None
    has_parts = parts is not None and bool(parts.families)
    if parts is not None and has_parts and Reduction.PARTIAL_ORDER not in wanted:
        return _of_parts(wanted, found, parts)
    if Reduction.SYMMETRY in wanted and has_parts:
        why_not = (
            f"{why}, so partial order goes by transitions, and equal parts are not exchanged then"
        )
        refuse(Reduction.SYMMETRY, why_not, Origin(net.file), d)
    elif Reduction.SYMMETRY in wanted:
        more = why_none(net)
        same = " without another answer to what is asked" if questions else ""
        also = f", and {more}" if more else f", and no two parts of the net can be exchanged{same}"
        refuse(Reduction.SYMMETRY, why + also, Origin(net.file), d)
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
    net: FlatNet,
    table: Elements,
    wanted: Sequence[Reduction],
    d: Diagnostics,
    *,
    has_parts: bool,
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
            why = "equal parts are not exchanged together with partial order"
            if not has_parts:
                why = "no permutation of the colours of a colour set, nor of parts, maps the net to itself"
            refuse(Reduction.SYMMETRY, why, Origin(net.file), d)
        else:
            found.append(Reduction.SYMMETRY)
    return found
