"""The check `reach`: no arm is told a pose that it cannot reach.

told = told_poses(poses, found, deadline)                          # what arms may be told
suspects(told, found)                                              # impossible moves that one exploration can rule out
reach(told, partition, found, explore_with_moves, keep)            # the check
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.cell.partition import Partition
from pn2code.semantics.game.report import value_text
from pn2code.verify.answers.reasons import clause
from pn2code.verify.controller.control_answers import Keeper, unknown
from pn2code.verify.controller.control_types import REACH, Check
from pn2code.verify.controller.equals import NoPatternError
from pn2code.verify.controller.poses import Bad, Poses, Told
from pn2code.verify.exploring.result import Exploration

MOST_AT_ONCE = 100
"""Moves that one exploration looks for."""
MOST_TIMES = 5
"""Explorations of one check."""

ExploreWithMoves = Callable[[Sequence[Bad]], Exploration | None]
"""Explores the cell once more, with exceptions where it comes to one of the moves."""


def told_poses(poses: Poses | None, found: Exploration | None, deadline: Deadline) -> Told | None:
    """What arms may be told; None: no arm is told a pose, or nothing is known of arms.

    Args:
        poses: what arms are told; None: nothing is known of arms.
        found: a space that has at least all that the cell can reach, as far as it is complete; None: there is none.
        deadline: when it is over the answer is not known.
    """
    if poses is None or not poses.moving:
        return None
    try:
        with deadline.enforced():
            return poses.told(found)
    except TimeIsOverError:
        return Told(open=clause("seconds"))


def suspects(told: Told | None, found: Exploration) -> Sequence[Bad]:
    """Moves that another exploration of the whole cell can rule out all at once."""
    fits = told is not None and not told.open and len(told.bad) <= MOST_AT_ONCE
    return told.bad if told is not None and fits and found.seen.markings else ()


def reach(
    told: Told | None,
    partition: Partition,
    found: Exploration | None,
    explore_with_moves: ExploreWithMoves | None,
    keep: Keeper,
    why: str = "",
    *,
    ruled_out: bool = False,
) -> list[Check]:
    """The check; nothing where no arm is told a pose.

    Args:
        told: what arms may be told.
        partition: the cell.
        found: where that was seen, as for `tell`.
        explore_with_moves: looks whether the cell comes to a move; None: nobody can look.
        keep: keeps runs.
        why: there is no space.
        ruled_out: the cell comes to none of the moves that are not possible.
    """
    if told is None:
        return []
    shown = None
    if found is not None and told.bad and not ruled_out:
        shown = _shown(told, partition, found, explore_with_moves, keep)
    if shown is not None:
        return [shown]
    if found is None or not found.seen.markings:
        return [unknown(REACH, {"why": why if found is None else found.why})]
    if told.open:
        return [Check(REACH, "unknown", f"not known: {told.open}", why="poses")]
    return [Check(REACH, "yes", _fine(told), told.poses)]


def _fine(told: Told) -> str:
    says = "no arm is told a pose"
    if told.poses:
        some = f"each of the {told.poses:,} poses that arms are told"
        says = f"{some if told.poses > 1 else 'the only pose that an arm is told'} can be reached"
    if told.far == 0:
        return says
    other = f"{told.far:,} more that are on their way as something else are never moved to"
    if told.far == 1:
        other = "one more that is on its way as something else is never moved to"
    return f"{says}; {other}, which was looked up in another exploration"


def _shown(
    told: Told,
    partition: Partition,
    found: Exploration,
    explore_with_moves: ExploreWithMoves | None,
    keep: Keeper,
) -> Check | None:
    """Whether the cell comes to a move that an arm cannot make; None: it never does."""
    first = told.bad[0]
    where = f"`{partition.net.transitions[first.transition].name}`"
    open_ = Check(
        REACH,
        "unknown",
        f"not known: whether {where} commands a move of which this is so: {first.why}",
        why="poses",
    )
    if explore_with_moves is None or found.error is not None:
        return open_
    for begin in range(0, len(told.bad), MOST_AT_ONCE):
        if begin == MOST_TIMES * MOST_AT_ONCE:
            return open_
        moves = told.bad[begin : begin + MOST_AT_ONCE]
        try:
            looked = explore_with_moves(moves)
        except NoPatternError:
            return open_
        if looked is None:
            return open_
        bad = _met(looked.error, moves)
        if bad is not None:
            return _no(bad, partition, looked, keep)
        if not looked.seen.markings:
            return open_
    return None


def _met(error: Mapping[str, Any] | None, moves: Sequence[Bad]) -> Bad | None:
    """The move that an exploration has come to."""
    if error is None or error.get("binding") is None:
        return None
    for bad in moves:
        texts = {s.name: value_text(s, v) for s, v in bad.values}
        if bad.transition == error["transition"] and texts.items() <= error["binding"].items():
            return bad
    return None


def _no(bad: Bad, partition: Partition, looked: Exploration, keep: Keeper) -> Check:
    trace = looked.error_trace
    evidence = keep.all({"trace": trace and str(trace.file), "loop": None}, REACH)
    steps = evidence[0].steps if evidence else 0
    t = partition.net.transitions[bad.transition]
    after = f"{steps} step{'s' * (steps != 1)} after the start" if steps else "at the start"
    says = f"{after} `{t.name}` commands a move that is not possible: {bad.why}"
    return Check(REACH, "no", says, evidence=evidence, transitions=(t.name,))
