"""Whether the order of firings matters, where all orders are too many: a part of them, or fewer that stand for all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.properties import meaning as m
from pn2code.verify.controller import by_counts
from pn2code.verify.controller.by_turns import OutOfReachError
from pn2code.verify.controller.control_answers import ORDERS
from pn2code.verify.controller.control_in_turns import looked_in_turns
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration

ORDERS_FROM = 20_000
"""States among which it is looked first whether the order of firings matters, where not all states are looked at."""


def may_reduce(partition: Partition, limits: Limits) -> bool:
    """Whether all orders of firing of a cell need not be looked at, where they are too many."""
    first, most = limits.counts_from, limits.max_states
    is_enough = first is not None and (most is None or most >= first)
    return is_enough and limits.turns_from is not None and not partition.net.timed


def with_fewer_orders(
    partition: Partition,
    plan: Plan,
    limits: Limits,
    options: ExploreOptions,
    found: Exploration,
    orders: Exploration,
    at_once: str,
) -> tuple[Exploration, Sequence[Mapping[str, Any]], Running] | None:
    """What is said of the orders of firing with limits, or in turns, with the net of its evidence; None: nothing.

    Args:
        partition, plan, limits, options: as for `examine`.
        found: all states of the cell.
        orders: a part of those of all orders.
        at_once: questions about orders.
    """
    plan = replace(plan, properties=m.Properties(), cut="")
    options = replace(options, predicates=(), bindings=())
    whole = replace(found, answers=())
    counted = by_counts.look(
        partition, plan, limits, options, part=whole, order=orders.answers, in_order=at_once
    )
    if counted is not None:
        return counted.looked.found, counted.asked, Running.of(partition)
    with suppress(OutOfReachError):
        turned = looked_in_turns(partition, plan, limits, options, at_once, None)
        if turned is not None and turned.orders is not None:
            return turned.orders, turned.orders.answers[:ORDERS], turned.running
    return None


def part_of_orders(
    running: Running, plan: Plan, limits: Limits, options: ExploreOptions, d: Diagnostics
) -> Exploration | None:
    """A part of the space of all orders: a small one, where that shows that the order of firings matters."""
    few = min(limits.max_states or ORDERS_FROM, ORDERS_FROM)
    found = explore(running.net, plan.storage, replace(limits, max_states=few), d, options)
    if found is None or found.why != "states" or by_counts.is_decided(found.answers):
        return found
    if few == limits.max_states:
        return found  # that is all that may be looked at
    return explore(running.net, plan.storage, limits, d, options)
