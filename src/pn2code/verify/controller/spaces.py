"""Which states of a cell as it runs are looked at, and what is known from them.

All of them, where these are not too many. Else tokens are counted up to a limit (`by_counts`), or programs go in turns
(`by_turns`), and what these leave open is looked for in as much of the whole as there is time for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.verify.controller import by_counts
from pn2code.verify.controller.by_turns import Looked, OutOfReachError
from pn2code.verify.controller.control_in_turns import (
    has_runs,
    has_suspects,
    is_open,
    looked_in_turns,
    may_go_in_turns,
    told_in_turns,
    with_part,
)
from pn2code.verify.controller.control_questions import of_orders
from pn2code.verify.controller.control_types import Plan, WrittenGraph
from pn2code.verify.controller.cut_answers import is_full, too_late, with_reason
from pn2code.verify.controller.fewer_orders import part_of_orders
from pn2code.verify.controller.hunted_properties import with_hunted_runs
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.setting import Setting
from pn2code.verify.exploring.limits import REACHED, Limits
from pn2code.verify.exploring.result import Exploration

FEW = 60_000
"""States before tokens are counted up to a limit where they are in the closed net."""
HUNT_PART = 0.8
"""Of what is left then, what the search for runs may take; the rest is for what makes the states so many (`crowd`)."""

Rows = Sequence[Mapping[str, Any]]


@dataclass(frozen=True)
class Spaces:
    """What was seen.

    Args:
        plan: as for `control.examine`; its `cut` may have become known.
        found, running: the states that answers come from, and the net that has them.
        orders_running: the net in which the order of firings is looked at.
        answers: what is said of properties.
        in_turns: what was seen in turns, if `found` is that.
        in_counts: the same of tokens that are counted up to a limit.
        graph: the graph of the whole, if it was written.
        is_late: whether the time was over before.
    """

    plan: Plan
    found: Exploration
    running: Running
    orders_running: Running
    answers: Rows
    in_turns: Looked | None
    in_counts: by_counts.Seen | None
    graph: WrittenGraph | None
    is_late: bool

    @property
    def is_reduced(self) -> bool:
        """Whether these are not the states of the whole."""
        return self.in_turns is not None or self.in_counts is not None


@dataclass(frozen=True)
class _Explored:
    """The states before anything is made of them: `found` is of the whole, and may be a part of it."""

    plan: Plan
    found: Exploration
    in_turns: Looked | None
    turned: Rows
    in_counts: by_counts.Seen | None


def look(setting: Setting) -> Spaces | None:
    """Explores; None after an error that was reported."""
    explored = _explored(setting)
    if explored is None:
        return None
    plan, found, in_turns, in_counts = (
        explored.plan,
        explored.found,
        explored.in_turns,
        explored.in_counts,
    )
    graph = None
    if plan.graph is not None and found.complete and plan.graph.exists():
        graph = WrittenGraph(plan.graph, found.nodes, found.arcs)
    running = orders_running = setting.running
    if in_turns is not None:
        found, running = in_turns.found, in_turns.running
        orders_running = running
    if in_counts is not None:
        found, running = in_counts.looked.found, in_counts.looked.running
    if plan.cut and found.why == "states":
        answers = tuple(with_reason(a, plan.cut) for a in found.answers)
        found = replace(found, why=plan.cut, answers=answers)
    # Fewer states than are permitted were to show whether all are needed; then the time was over.
    is_late = setting.part.deadline.is_over() and not is_full(found, setting.limits)
    if is_late and found.why == "states":
        found = replace(found, why="seconds", answers=too_late(found.answers))
    return Spaces(
        plan,
        found,
        running,
        orders_running,
        _answers(setting, explored, found, running, is_late=is_late),
        in_turns,
        in_counts,
        graph,
        is_late,
    )


def _answers(
    setting: Setting, explored: _Explored, found: Exploration, running: Running, *, is_late: bool
) -> Rows:
    """What is said of properties."""
    plan, in_counts = explored.plan, explored.in_counts
    count = len(plan.properties.properties)
    answers: Rows = found.answers[:count] if in_counts is None else in_counts.answers
    if explored.in_turns is not None:
        answers = explored.turned
    if is_late:
        answers = too_late(answers)
    if in_counts is not None or found.why not in REACHED:
        return answers
    # What was seen may be too much to tell how it comes to what is wrong; a run to it need not be.
    limits = setting.limits
    hunted = replace(limits, deadline=limits.deadline.share(HUNT_PART))
    open_row = {"answer": "unknown", "why": found.why, "trace": None}
    return with_hunted_runs(running, plan, hunted, setting.options, answers or [open_row] * count)


def _explored(setting: Setting) -> _Explored | None:
    """All states, or fewer that stand for them; None after an error that was reported."""
    partition, plan, part = setting.partition, setting.plan, setting.part
    may_turn = may_go_in_turns(partition, plan, part)
    first_part = replace(part, max_states=part.turns_from) if may_turn else part
    in_counts = None
    if _may_count(partition, part):
        counted = _in_counts(setting, first_part)
        if counted is None:
            return None
        found, in_counts = counted
    else:
        first = setting.whole(first_part, setting.options)
        if first is None:
            return None
        found = first
    if in_counts is None and may_turn and found.why == "states":
        return _in_turns(setting, found)
    return _Explored(plan, found, None, (), in_counts)


def _may_count(partition: Partition, limits: Limits) -> bool:
    """Whether tokens are counted up to a limit only before more is looked at."""
    first, most = limits.counts_from, limits.max_states
    if first is None or limits.turns_from is None or first > limits.turns_from:
        return False
    is_enough = most is None or most >= first
    return is_enough and not partition.net.timed


def _in_counts(
    setting: Setting, first_part: Limits
) -> tuple[Exploration, by_counts.Seen | None] | None:
    """A small part of all states, and where that is not all of them what is seen by counting tokens up to a limit.

    Args:
        setting: what is explored.
        first_part: the limits of all states, where counting says nothing.

    Returns:
        None after an error that was reported.
    """
    partition, plan, part = setting.partition, setting.plan, setting.part
    running, closed = setting.running, setting.closed
    # A cell whose closed net is so large is hardly small enough for all of its states.
    is_large = closed is not None and closed.known is not None
    few = min(part.counts_from or FEW, FEW) if is_large else part.counts_from
    counts_part = replace(part, max_states=few)
    # To compile better what sees so little takes longer than it saves.
    soon = replace(setting.options, first_states=counts_part.max_states)
    found = setting.whole(counts_part, soon)
    if found is None:
        return None
    if found.why != "states":
        return found, None
    own = replace(soon, questions=of_orders(running, plan.firings), stem="orders")
    orders_part = part_of_orders(running, plan, counts_part, own, setting.d)
    if orders_part is None:
        return None
    in_counts = by_counts.look(
        partition,
        plan,
        part,
        setting.options,
        part=found,
        order=orders_part.answers,
        in_order=setting.at_once,
    )
    if in_counts is not None and has_suspects(
        setting.poses, in_counts.looked.found, setting.limits
    ):
        in_counts = None
    if in_counts is not None and in_counts.has_open:
        rows = with_hunted_runs(running, plan, part, soon, in_counts.answers)
        in_counts = replace(in_counts, answers=rows)
    if in_counts is not None and not in_counts.has_open:
        return found, in_counts
    more = setting.whole(first_part if in_counts is None else part, setting.options)
    if more is None:
        return None
    return more, None if in_counts is None else in_counts.with_more(more)


def _in_turns(setting: Setting, part_seen: Exploration) -> _Explored | None:
    """What is seen in turns, where a part of all states is not enough; None after an error that was reported."""
    partition, plan, part, options = setting.partition, setting.plan, setting.part, setting.options
    found: Exploration | None = part_seen
    in_turns: Looked | None = None
    turned: Rows = ()
    try:
        in_turns = looked_in_turns(partition, plan, part, options, setting.at_once, setting.poses)
        if in_turns is not None:
            turned = told_in_turns(setting.running, plan, part, options, part_seen, in_turns)
        if in_turns is None or is_open(plan, turned):
            found = setting.whole(part, options)
            if found is not None and in_turns is not None:
                turned = with_part(turned, found)
                in_turns = in_turns if turned else None
        if in_turns is not None and in_turns.running.meek and has_runs(turned):
            in_turns = None  # whether scripts can do so is looked for in the whole net
            found = setting.whole(part, options)
    except OutOfReachError as problem:  # what was seen of the whole is what is known
        plan = replace(plan, cut=str(problem))
    return None if found is None else _Explored(plan, found, in_turns, turned, None)
