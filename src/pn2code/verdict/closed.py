"""The closed net of a cell: all of its markings, or where there are very many what can be said of them otherwise.

    found = explored(opened, limits, options, d, may_count=True)

It is the cell as it runs that counts, so of a closed net with more than `Limits.counts_from` markings it is first tried
to count tokens up to a limit only (`verify.exploring.net_by_counts`), then to exchange equal parts
(`verify.exploring.net_by_parts`). Where that shows nothing, all markings are explored, as without. A picture, a
property of the closed net, or another reduction needs all markings.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.opened import OpenNet
from pn2code.verify.exploring import net_by_counts, net_by_parts
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import COUNTED, Exploration


def explored(
    opened: OpenNet,
    limits: Limits,
    options: ExploreOptions,
    d: Diagnostics,
    *,
    may_count: bool,
    partition: Partition | None,
) -> Exploration | None:
    """The state space; None after an error that was reported.

    Args:
        opened: the net.
        limits, options: as for `explore`.
        d: gets the errors.
        may_count: whether less than all markings is enough.
        partition: the cell; None: the net is none.
    """
    first = limits.counts_from
    plain = not (limits.reductions or limits.approximation or limits.sweeps or options.graph)
    is_enough = limits.max_states is None or (first is not None and limits.max_states > first)
    if first is None or not may_count or not plain or not is_enough or opened.flat.timed:
        return explore(opened.flat, opened.storage, limits, d, options)
    part = replace(limits, max_states=first)
    # To compile better what sees so little takes longer than it saves.
    soon = replace(options, quick=True, first_states=first)
    found = explore(opened.flat, opened.storage, part, d, soon)
    if found is None or found.why != "states":
        return found
    final = () if partition is None else partition.final_places
    known = net_by_counts.look(
        opened.flat, opened.storage, limits, options, final
    ) or net_by_parts.look(opened.flat, opened.storage, limits, options, final)
    if known is not None:
        return replace(found, why=COUNTED, known=known)
    return explore(opened.flat, opened.storage, limits, d, options)
