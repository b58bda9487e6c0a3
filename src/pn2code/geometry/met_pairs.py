"""What is said of two things that do not surely keep apart."""

from __future__ import annotations

import math

from pn2code.geometry.answers import Pair
from pn2code.geometry.apart import Apart
from pn2code.geometry.part_names import as_in_runs, as_seen, shown
from pn2code.geometry.progress import Meeting
from pn2code.geometry.runs import Run
from pn2code.robot.led_contacts import EARLY
from pn2code.robot.robot_cell import PART_CONTACT


def pair_of(meeting: Meeting, apart: Apart, run: Run | None) -> Pair:
    """Two things that do not surely keep apart; a part has no robot, and no joints."""
    is_touch = apart.outcome == "touch"
    says = touch_in_words(apart) if is_touch else as_in_runs(apart.why)
    apart = as_seen(apart)
    joints = zip(meeting.robots, apart.joints, strict=False)
    return Pair(
        meeting.robots,
        meeting.transitions,
        meeting.doing,
        "no" if is_touch else "unknown",
        says,
        apart.where,
        apart.where.distance if apart.where else 0.0,
        tuple((r, tuple(map(float, q))) for r, q in joints if r),
        run,
        around=meeting.around,
        least=_most_in(apart) if is_touch else None,
        is_held=is_touch and bool(apart.why),
        things=meeting.things,
    )


def certain(apart: Apart) -> float | None:
    """The distance (m) below which nothing comes, negative where it touches; None: that is not known."""
    return None if apart.outcome == "open" or math.isinf(apart.least) else apart.least


def _most_in(apart: Apart) -> float:
    """The least distance (m) that the links which touch can have anywhere on the way."""
    assert apart.where is not None
    # Nearer to where the move leads they may touch, and may be deeper by so much than here.
    permitted = PART_CONTACT if apart.where.is_early else apart.nearest - apart.where.distance
    return min(apart.least - permitted, apart.where.distance)


def touch_in_words(apart: Apart) -> str:
    """Which links overlap, where, by how much, and that it is nowhere much more, if that is known."""
    gap = apart.where
    assert gap is not None
    if apart.why:
        return as_in_runs(apart.why)
    at = ", ".join(f"{1000.0 * v:.0f}" for v in gap.point)
    least = "" if apart.is_whole else "at least "
    text = f"{shown(gap.a)} and {shown(gap.b)} overlap by {least}{-1000.0 * gap.distance:.1f} mm at ({at}) mm"
    if gap.is_early:
        text += EARLY
    if not apart.is_whole:
        return f"{text}; where it is deepest was not searched for"
    if certain(apart) is None:
        return f"{text}; how deep on the rest of the way is not known"
    most = -1000.0 * _most_in(apart)
    return f"{text}, and nowhere on the way by more than {math.ceil(10.0 * most) / 10.0:.1f} mm"
