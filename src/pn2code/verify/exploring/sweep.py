"""Exploring in the order of a measure of progress, forgetting what lies behind: when, and what comes of it.

The measure is that of `progress`; the search is cnative/src/explore/sweep. It sees all markings and all arcs, but knows
only some of them at a time, so it answers what single markings tell, and nothing about the graph.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatNet
from pn2code.verify.codes import SWEEP_NOT_POSSIBLE
from pn2code.verify.exploring.limits import Reduction
from pn2code.verify.exploring.progress import Progress
from pn2code.verify.exploring.reductions import Chosen
from pn2code.verify.exploring.result import Exploration

_KNOWN_ENDS = ("decided", "error")
"""Ends after which what was found counts, although not all markings were seen."""


def measure(
    net: FlatNet, storage: Mapping[str, str], reductions: Sequence[Reduction], d: Diagnostics
) -> Progress | None:
    """The measure of a net; None: there is none, and a warning says so.

    Args:
        net: the net.
        storage: as for `Game`.
        reductions: those that are used.
        d: gets the warning.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    found = Progress.of(net, storage, timed=Reduction.TIME not in reductions)
    if found is None:
        d.warning(
            SWEEP_NOT_POSSIBLE,
            "no weighted number of tokens was found that never becomes smaller and sometimes greater, so no marking "
            "can be forgotten",
            Origin(net.file),
            hint="the net is explored without `--sweep`",
        )
    return found


def chosen(net: FlatNet, storage: Mapping[str, str], given: Chosen, d: Diagnostics) -> Chosen:
    """The reductions that are used, with the measure; other reductions than that of time have orders of their own."""
    if any(r is not Reduction.TIME for r in given.reductions):
        return given
    return replace(given, progress=measure(net, storage, given.reductions, d))


def may_help(found: Exploration) -> bool:
    """Whether an exploration has ended for want of memory alone."""
    is_plain = found.approximation is None and not found.is_reduced and not found.is_counted
    return found.why == "memory" and not found.seen.markings and is_plain


def joined(first: Exploration, again: Exploration, *, needs_graph: bool = False) -> Exploration:
    """What an exploration within the limit of memory has found, and one that has forgotten markings after it.

    The second one counts where it has come to an end; what a part of the graph has decided stays.

    Args:
        first: what ended for want of memory.
        again: what came after it.
        needs_graph: whether there still was no memory for all that was wanted, then.
    """
    if len(again.answers) != len(first.answers):  # it was ended before it said anything
        return first
    answers = tuple(
        a if a["answer"] != "unknown" else b
        for a, b in zip(first.answers, again.answers, strict=True)
    )
    if again.complete and needs_graph:
        again = replace(again, complete=False, why=first.why)
    is_known = again.seen.markings or again.why in _KNOWN_ENDS
    return replace(again if is_known else first, answers=answers)
