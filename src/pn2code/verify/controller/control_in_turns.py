"""A cell that is too large to be seen whole, looked at in turns: what that says of its checks and properties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller import by_counts, by_turns
from pn2code.verify.controller.by_turns import Looked
from pn2code.verify.controller.control_answers import ORDERS
from pn2code.verify.controller.control_questions import of_cell, of_orders
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.controller.cut_answers import parted
from pn2code.verify.controller.hunted_properties import with_hunted_runs
from pn2code.verify.controller.poses import Poses
from pn2code.verify.controller.reach_check import suspects, told_poses
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.stated import Stated, ways
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration


def may_go_in_turns(partition: Partition, plan: Plan, limits: Limits) -> bool:
    """Whether the programs of a cell that is too large for the whole of it are looked at in turns."""
    most, least = limits.max_states, limits.turns_from
    if least is None or (most is not None and most <= least):
        return False
    return not plan.cut and not partition.net.timed


def has_suspects(poses: Poses | None, found: Exploration, limits: Limits) -> bool:
    """Whether arms may come to poses that they cannot take: then the cell is not looked at in turns."""
    return bool(suspects(told_poses(poses, found, limits.deadline), found))


def looked_in_turns(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    at_once: str,
    poses: Poses | None,
) -> Looked | None:
    """What is seen in turns; None: it is not said."""
    over = Running.of(partition, loose=True).over
    properties = [x for _, x in _told_by_states(partition, plan, over)]
    loose = by_turns.loosened(partition, [x.places for x in properties])
    if loose is None:
        return None
    running, _ = loose

    def is_choiceless(found: Exploration) -> bool:
        _, asked = parted(found.answers, ORDERS)
        return bool(at_once) and asked[0]["answer"] != "unknown"

    looked = by_turns.look(
        loose,
        plan,
        replace(limits, max_states=limits.most_in_turns or limits.max_states),
        options,
        Diagnostics(),  # what is wrong with this net the whole space tells
        cell=of_cell(running, plan, in_turns=True, conditions=properties) + at_once,
        orders=of_orders(running, plan.firings, in_turns=True),
        is_choiceless=is_choiceless,
        properties=len(properties),
    )
    if looked is None or has_suspects(poses, looked.found, limits):
        return None
    return looked


def told_in_turns(
    running: Running,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    part: Exploration,
    looked: Looked,
) -> tuple[Mapping[str, Any], ...]:
    """What is known of properties: what holds in turns, what a part of the cell's states says, and runs."""
    properties = plan.properties.properties
    rows: list[Mapping[str, Any]] = [
        {**row, "part": True} for row in part.answers[: len(properties)]
    ]
    told = _told_by_states(running.partition, plan, looked.running.over)
    for (i, x), mine in zip(told, looked.told, strict=True):
        if x.holds(mine):
            rows[i] = Stated.row(properties[i])
    return with_hunted_runs(running, plan, limits, options, rows)


def _told_by_states(partition: Partition, plan: Plan, over: int) -> list[tuple[int, Stated]]:
    """What is asked of states instead of the properties, by their numbers."""
    asked = plan.properties
    return [(i, x) for i, p in enumerate(asked.properties) for x in ways(p, over, asked, partition)]


def is_open(plan: Plan, rows: Sequence[Mapping[str, Any]]) -> bool:
    """Whether something is asked of the cell that is not known."""
    told = zip(plan.properties.properties, rows, strict=False)
    return any(row["answer"] == "unknown" and not p.of_net for p, row in told)


def has_runs(rows: Sequence[Mapping[str, Any]]) -> bool:
    """Whether an answer comes with a run."""
    return any(row.get("trace") for row in rows)


def with_part(
    rows: Sequence[Mapping[str, Any]], whole: Exploration
) -> tuple[Mapping[str, Any], ...]:
    """With what more of the cell's states say; nothing: they say all."""
    if whole.why not in by_counts.CUT_SHORT:
        return ()
    # What a part said is said again, and its run has been written again.
    told = zip(rows, whole.answers, strict=False)
    return tuple(a if b["answer"] == "unknown" else {**b, "part": True} for a, b in told)
