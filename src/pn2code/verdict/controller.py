"""The checks of a cell's supervisor."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from pn2code.arms import Arms
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.properties import meaning as m
from pn2code.verdict.opened import OpenNet
from pn2code.verify.answers.properties import Verdict
from pn2code.verify.codes import TIME_OVER, TRACE_UNWRITABLE
from pn2code.verify.controller import control
from pn2code.verify.controller.control_types import Control, Plan
from pn2code.verify.controller.not_looked import not_looked
from pn2code.verify.controller.poses import Poses
from pn2code.verify.controller.premises import Premises
from pn2code.verify.controller.proofs import declared
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import COUNTED, Exploration

LEAST_STATES = 1_000
"""Of the cell that are looked at where its closed net was not seen to the end."""
QUICK_STATES = 5_000
"""Of the net: beyond that it pays to have the compiler work longer."""


def look(
    opened: OpenNet,
    partition: Partition,
    found: Exploration,
    limits: Limits,
    options: ExploreOptions,
    folder: Path,
    d: Diagnostics,
    asked: m.Properties = m.Properties(),  # noqa: B008 - frozen
    graph: Path | None = None,
    *,
    checks: bool = True,
) -> Control | None:
    """All checks, and what the explorer says of properties; None after an error.

    Args:
        opened: the cell.
        partition: who runs what in it.
        found: its state space. Where that is too large, the one that the checks need is as well, and a part is seen.
        limits, options: of the exploration.
        folder: where traces go.
        d: gets the errors.
        asked: the properties.
        graph: where the graph of the cell is written, if it is small enough; None: nowhere.
        checks: whether the checks are asked for, and not only properties.
    """
    config = opened.config
    assert config is not None, "it has been divided"
    # An approximate exploration came to its end; the checks make an exact one of their own.
    arms = Arms.of(config, d)
    bounds = (options.sizes.bounds if options.sizes is not None else None) or {}
    is_partial = not found.complete and found.why not in ("decided", "approximation", COUNTED)
    if is_partial and (found.why == "interrupted" or limits.deadline.is_over()):
        poses = None if arms is None else Poses(partition, config.primitives, arms, opened.storage)
        capacities = declared(partition, config, d)
        return not_looked(found.why, partition, capacities, found, poses, bounds)
    cut = ""
    # Where all markings were seen, and only the graph between them had no room, those of the cell may be seen as well.
    is_cut = is_partial and found.why != "error" and not found.seen.markings
    if is_cut and not opened.flat.timed and limits.swarm is None:
        # All of it will not be seen either, but what is wrong in a part is wrong.
        most = max(found.nodes, LEAST_STATES)
        if limits.max_states is None or most < limits.max_states:
            limits, cut = replace(limits, max_states=most), found.why
    capacities = declared(partition, config, d)
    if capacities is None:
        return None
    plan = Plan(
        storage=opened.storage,
        order_decides=config.supervisor.order_decides,
        folder=folder,
        stem=options.stem,
        capacities=capacities,
        properties=asked,
        evidence=options.evidence,
        options=replace(options, quick=found.nodes <= QUICK_STATES, covering=False),
        premises=Premises.of(partition, config, {g.place: g.says for g in opened.given}),
        cut=cut,
        bounds=bounds,
        primitives=config.primitives,
        arms=arms,
        graph=graph,
        checks=checks,
    )
    own = Diagnostics()
    looked = control.examine(partition, plan, replace(limits, traces=0), own, found)
    # Each answer says itself that the time was over.
    d.items += [i for i in own.items if i.code != TIME_OVER]
    if looked is not None:
        _check_written(looked, folder, d)
    return looked


def _check_written(looked: Control, folder: Path, d: Diagnostics) -> None:
    if any(run.file is None for check in looked.checks for run in check.evidence):
        d.warning(
            TRACE_UNWRITABLE,
            f"a run that shows what is wrong with the supervisor cannot be written into `{folder}`",
            Origin(str(folder)),
            hint="give another folder with `--traces DIR`",
        )


def verdict(looked: Control | None) -> Verdict:
    """Of all checks together; "yes" where there are none."""
    if looked is None:
        return "yes"
    return "no" if looked.failed else "inconclusive" if looked.open else "yes"
