"""How far a loop is."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.how_far import HowFar, beginning, listening


def counted(times: list[float], total: int) -> list[str]:
    """What is said where each one is done at one of the times; the first is that of the beginning."""
    clock: Iterator[float] = iter(times)
    said: list[str] = []
    more = HowFar(said.append, "sweeping", noun="states", total=total, clock=lambda: next(clock))
    for _ in times[1:]:
        more()
    return said


def test_where_all_are_known_it_says_what_is_left() -> None:
    times = [0.0, *(n / 100 for n in range(1, 101))]
    assert counted(times, 400) == [
        "sweeping: 50 of 400, 100 a second, about 4 s left",
        "sweeping: 100 of 400, 100 a second, about 3 s left",
    ]


def test_where_nobody_knows_them_it_says_the_rate() -> None:
    assert counted([0.0, 0.1, 1.0, 1.2, 2.0], 0) == [
        "sweeping: 2 states, 2.0 a second",
        "sweeping: 4 states, 2.0 a second",
    ]


def test_more_than_were_announced_leave_nothing() -> None:
    assert counted([0.0, 1.0, 2.0], 1) == ["sweeping: 2 of 1, 1.0 a second, about 0 s left"]


def test_what_lets_nobody_count_is_told_before_it_begins() -> None:
    said: list[str] = []
    with listening(said.append):
        beginning("solving 2,000 equations")
    beginning("nobody listens")
    assert said == ["solving 2,000 equations ..."]
