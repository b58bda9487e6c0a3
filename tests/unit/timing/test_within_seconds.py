"""Whether each run ends within so many seconds."""

from __future__ import annotations

import pytest

from pn2code.timing.answers import ENDLESS, NO_END, Cycle, Ending

S = 1_000_000_000


def cycle(most: int | None, why: str = "", *others: str) -> Cycle:
    return Cycle((Ending(("Done",), S, most),), why, (), S, 9 * S, others, 100)


@pytest.mark.parametrize(
    ("found", "answer"),
    [
        (cycle(8 * S), "yes"),
        (cycle(11 * S), "no"),
        (cycle(10 * S), "unknown"),
        (cycle(8 * S, "", "a run may go on for ever"), "unknown"),
        (cycle(None, "the cell can come to more situations than were looked at"), "unknown"),
        (cycle(None), "unknown"),
        (Cycle((), "", (), None, None, ("no run comes to its end",), 100), "no"),
        (Cycle((), "a limit", (), None, None, (), 100), "unknown"),
    ],
)
def test_within_ten_seconds(found: Cycle, answer: str) -> None:
    """Where not all runs were looked at one of them may stop on its way, however short all those are that end."""
    assert found.within(10.0)[0] == answer


def test_what_is_named_as_a_run_that_goes_on_is_none() -> None:
    """Where an event comes in time, a run may go on for ever after it, but not stop before it."""
    stops = "a run may stop: nothing is at `go on for ever`"
    assert cycle(None, "", stops, ENDLESS, NO_END).ends == [stops]


def test_a_run_that_is_stopped_is_no_cycle() -> None:
    """The longest one is stopped by a late answer; each that is not takes 6 s at most, and 3 s at least."""
    late = "an answer of robot `a` may come after 5.000 s, later than reply_timeout_s (4 s) allows"
    found = Cycle((Ending(("Done",), 3 * S, 9 * S, held_up=3 * S),), "", (), S, 9 * S, (late,), 9)
    assert found.within(5.0)[0] == "no"
    for seconds in (7.0, 9.5):
        answer, why = found.within(seconds)
        assert answer == "unknown" and late in why
    none = Cycle((Ending(("Done",), 3 * S, 9 * S, held_up=9 * S),), "", (), S, 9 * S, (late,), 9)
    assert none.within(4.0)[0] == "unknown"
    assert none.within(2.0) == ("no", "no cycle takes less than 2.999 s")


def test_what_can_be_repeated_may_be_stopped() -> None:
    """There is no longest cycle then, but no run that takes longer, either, as far as is known."""
    stops = "a run may stop: it is out of reach"
    assert cycle(None, "", stops).within(10.0) == (
        "unknown",
        f"there is no longest cycle, but {stops}",
    )
