"""Whether the order in which the supervisor fires matters: in which states that is looked at, and what was answered."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from pn2code.verify.controller.control_answers import ORDERS
from pn2code.verify.controller.cut_answers import parted, too_late
from pn2code.verify.controller.equals import NoPatternError
from pn2code.verify.controller.fewer_orders import may_reduce, with_fewer_orders
from pn2code.verify.controller.poses import Told
from pn2code.verify.controller.reach_check import suspects
from pn2code.verify.controller.running import Running
from pn2code.verify.controller.setting import Setting
from pn2code.verify.controller.spaces import Spaces
from pn2code.verify.exploring.result import Exploration

Rows = Sequence[Mapping[str, Any]]


@dataclass(frozen=True)
class Orders:
    """What was seen of them.

    Args:
        said: the answers to the questions about the cell, without properties.
        asked: those to the questions about its orders.
        found: the states in which these were asked.
        running: the net that has these states.
        is_reduced: whether there are fewer orders, which stand for all.
        ruled_out: whether the cell comes to none of the moves that are not possible.
    """

    said: Rows
    asked: Rows
    found: Exploration
    running: Running
    is_reduced: bool = False
    ruled_out: bool = False


def look(setting: Setting, spaces: Spaces, told: Told | None) -> Orders | None:
    """Looks, where what was seen of the cell does not tell; None after an error that was reported.

    Args:
        setting: what is explored.
        spaces: what was seen of the cell.
        told: what arms may be told.
    """
    found, in_turns, in_counts = spaces.found, spaces.in_turns, spaces.in_counts
    if in_counts is not None:
        return _seen(spaces, in_counts.said, in_counts.asked)
    # In turns the answers about properties are apart (`Looked.told`).
    count = 0 if in_turns is not None else len(spaces.plan.properties.properties)
    said, asked = parted(found.answers[count:], ORDERS if setting.at_once else 0)
    if in_turns is not None:
        orders = in_turns.orders
        asked = asked if orders is None else orders.answers[:ORDERS]
        return _seen(spaces, said, asked, found if orders is None else orders)
    # Of a whole graph in which the supervisor never chooses the first question has an answer, and only of that.
    is_choiceless = found.complete and bool(asked) and asked[0]["answer"] != "unknown"
    cell = _seen(spaces, said, asked if is_choiceless else ())
    if not found.complete and found.why != "decided":
        return cell
    moves = suspects(told, found)
    if moves:
        # All orders are more than the cell does: what is not met there is met nowhere.
        with suppress(NoPatternError):
            looked = setting.with_moves(moves, first=False)
            ruled_out = looked is not None and looked.seen.markings
            if is_choiceless:
                return replace(cell, ruled_out=ruled_out)
            if ruled_out and looked is not None:
                return replace(cell, found=looked, asked=looked.answers, ruled_out=True)
    return cell if is_choiceless else _of_all(setting, spaces, cell, may_be_fewer=not moves)


def _seen(spaces: Spaces, said: Rows, asked: Rows, found: Exploration | None = None) -> Orders:
    """What the states of the cell tell, or those of its orders that were seen with them."""
    if spaces.is_late:
        said, asked = too_late(said), too_late(asked)
    return Orders(said, asked, found or spaces.found, spaces.orders_running)


def _of_all(setting: Setting, spaces: Spaces, cell: Orders, *, may_be_fewer: bool) -> Orders | None:
    """Explores all orders, or if they are too many fewer that stand for them.

    Args:
        setting: what is explored.
        spaces: what was seen of the cell.
        cell: what is known without.
        may_be_fewer: whether fewer may do.
    """
    limits, partition = setting.limits, setting.partition
    first = limits.counts_from if may_be_fewer and may_reduce(partition, limits) else None
    some = limits if first is None else replace(limits, max_states=first)
    found = setting.orders_of(some)
    if first is not None and found is not None and found.why == "states":
        fewer = with_fewer_orders(
            partition,
            setting.plan,
            setting.part,
            setting.unkept,
            cell.found,
            found,
            setting.at_once,
        )
        if fewer is not None:
            states, asked, running = fewer
            asked = too_late(asked) if spaces.is_late else asked
            return replace(cell, asked=asked, found=states, running=running, is_reduced=True)
        if limits.max_states != first:
            found = setting.orders_of(limits)
    return None if found is None else replace(cell, asked=found.answers, found=found)
