"""Whether a cell's supervisor may follow its execution scheme (docs/execution.md), looked up in the cell as it runs.

    control = examine(partition, Plan(), limits, d)
    [(c.name, c.answer) for c in control.checks]     # ("finite-response", "yes"), ...

Two spaces are gone through, both of the net that `verify.controller.running` makes of a cell. In that of the *cell*
the supervisor takes the first of its binding elements: there it is looked what the cell can come to, and there
properties are asked. In that of all *orders* it takes any: there it is looked whether the order matters. Where the
supervisor never has more than one to choose from the two are one, and it is gone through once. Which questions are
asked is in `control_questions`, which states are looked at in `spaces`, in which states the orders are in `all_orders`,
and what the answers mean in `control_answers`; the graphs are gone through by
cnative/src/explore/query/explore_control.c and explore_running.c. That no owner touches what is not its own is seen in
the net itself (`ownership`).
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller import all_orders, spaces
from pn2code.verify.controller.all_orders import Orders
from pn2code.verify.controller.control_answers import (
    STILL,
    Keeper,
    cell_answers,
    drawn,
    hesitating,
    is_short,
    order_answers,
    refusal,
    seen_in_turns,
    settled,
    silent,
)
from pn2code.verify.controller.control_messages import formats, memory
from pn2code.verify.controller.control_swarm import swarmed
from pn2code.verify.controller.control_types import BLOCKING, CellProgram, Check, Control, Plan
from pn2code.verify.controller.crowd import Crowd, crowd
from pn2code.verify.controller.not_looked import not_looked
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.controller.ownership import ownership
from pn2code.verify.controller.poses import Told
from pn2code.verify.controller.reach_check import reach, told_poses
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.setting import Setting, set_up
from pn2code.verify.controller.spaces import Rows, Spaces
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.limits import REACHED, Limits
from pn2code.verify.exploring.result import Exploration

DOUBT = (
    "a condition of a script that waits for a message raises an exception in a state of the cell, and whether the "
    "script comes to it is not known"
)


def examine(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    d: Diagnostics,
    closed: Exploration | None = None,
) -> Control | None:
    """Explores the cell as it runs and answers all checks; None after an error that was reported.

    Args:
        partition: the cell.
        plan: how.
        limits: of each exploration.
        d: gets the errors.
        closed: the state space of the closed net, if it is known.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    poses = plan.poses(partition)
    try:
        running = Running.of(partition, plan.properties.predicates)
    except NotModelledError as problem:
        why = f"the cell as it runs cannot be modelled: {problem}"
        nothing = not_looked(why, partition, plan.capacities, closed, poses, plan.bounds)
        return replace(nothing, why=why)
    if limits.swarm is not None:
        return swarmed(partition, running, plan, limits, d, closed)
    with set_up(partition, plan, limits, d, closed, running, poses) as setting:
        seen = spaces.look(setting)
        if seen is None:
            return None
        told = told_poses(poses, seen.found, setting.limits.deadline)
        orders = all_orders.look(setting, seen, told)
        return None if orders is None else _control(setting, seen, orders, told)


def _control(setting: Setting, seen: Spaces, orders: Orders, told: Told | None) -> Control:
    """What all of it says."""
    plan, found, running = seen.plan, seen.found, seen.running
    said, doubt = orders.said, ""
    if running.unsure is not None and said:
        said, last = said[:-1], said[-1]
        doubt = DOUBT if last["answer"] == "no" else ""
    program = CellProgram(
        setting.running, plan.properties.predicates, setting.made, graph=seen.graph
    )
    control = Control(
        setting.partition,
        _checks(setting, seen, orders, told, said),
        found,
        running,
        answers=tuple(seen.answers),
        closed=setting.closed,
        reduced=seen.is_reduced,
        quiet=seen.in_counts is not None and seen.in_counts.is_quiet,
        reduced_orders=orders.is_reduced,
        counted_orders=orders.is_reduced and orders.found.is_counted,
        program=program,
        crowd=_crowd(setting, found),
        doubt=doubt,
        late=plan.premises.replies.late or silent(running, said),
        premises=replace(plan.premises, moving=not is_short(said, STILL)),
    )
    return settled(control)


def _checks(
    setting: Setting, seen: Spaces, orders: Orders, told: Told | None, said: Rows
) -> tuple[Check, ...]:
    """The checks.

    Args:
        setting, seen, orders, told: what was looked at.
        said: the answers about the cell that checks follow from.
    """
    partition, plan, found = setting.partition, seen.plan, seen.found
    keep = Keeper(plan, seen.running)
    checks: tuple[Check, ...] = (
        *order_answers(partition, orders.found, orders.asked, plan, Keeper(plan, orders.running)),
        *cell_answers(partition, found, said, plan, keep, setting.closed),
        *formats(partition, found, plan, setting.d),
        memory(found),
        *reach(told, partition, found, setting.with_moves, keep, ruled_out=orders.ruled_out),
        ownership(partition),
    )
    checks = tuple(hesitating(c, said, keep) for c in checks)
    if seen.is_reduced:
        checks = tuple(map(seen_in_turns, checks))
    refused = refusal(partition, found, keep)
    if refused is not None:
        checks = tuple(refused if c.name == BLOCKING else c for c in checks)
    why = nondeterminism.undetermined(partition.net)
    return tuple(drawn(c, why) for c in checks) if why else checks


def _crowd(setting: Setting, found: Exploration) -> Crowd | None:
    """What makes the states so many, where that is why not all were seen."""
    if found.complete or found.why not in REACHED:
        return None
    return crowd(setting.running, setting.plan.storage, setting.limits, setting.unkept)
