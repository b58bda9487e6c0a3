"""Stops that are drawn: pauses of trajectories, rates, seeds; and the spread of cycle times."""

from __future__ import annotations

import math
import statistics

import numpy as np
import pytest

from pn2code.robot.trajectories import Still
from pn2code.robot.transforms import Array
from pn2code.run.cycles import Cycle, Cycles, Spread, table
from pn2code.run.stops import Paused, Rate, Stops, parse


class Line:
    """One axis that moves a radian a second."""

    duration = 4.0
    length = 2.0

    def fraction(self, t: float) -> float:
        return t / self.duration

    def q(self, t: float) -> Array:
        return np.full(6, t)

    def qd(self, t: float) -> Array:
        return np.ones(6)

    def sample(self, times: Array) -> Array:
        return np.repeat(np.asarray(times)[:, None], 6, axis=1)

    def on_way(self, s: Array) -> Array:
        return self.sample(s * self.duration)


def test_a_pause_stands_and_then_goes_on_where_it_was() -> None:
    paused = Paused(Line(), ((1.0, 2.0), (3.0, 0.5)))
    assert paused.duration == 6.5
    expected = {
        0.0: 0.0,
        0.5: 0.5,
        1.0: 1.0,
        2.0: 1.0,
        3.0: 1.0,
        4.0: 2.0,
        5.0: 3.0,
        5.25: 3.0,
        6.5: 4.0,
    }
    for t, where in expected.items():
        assert paused.q(t)[0] == pytest.approx(where), t
        assert paused.fraction(t) == pytest.approx(where / 4.0), t
    assert paused.length == 2.0
    times = np.array(list(expected))
    assert paused.sample(times)[:, 0] == pytest.approx(list(expected.values()))
    assert [paused.qd(t)[0] for t in (0.5, 2.0, 4.0, 5.2, 6.0)] == [1.0, 0.0, 1.0, 0.0, 1.0]
    assert paused.on_way(np.array([0.5]))[0, 0] == 2.0


def test_stops_come_as_often_and_last_as_long_as_they_are_said_to() -> None:
    stops = Stops({"a": Rate(20.0, 3.0)}, seed=5)
    lasted: list[float] = []
    for _ in range(20_000):
        trajectory, seconds = stops.held_up("a", Still(np.zeros(6), 2.0))
        assert trajectory.duration == pytest.approx(2.0 + sum(seconds))
        lasted += seconds
    assert 40_000 / len(lasted) == pytest.approx(20.0, rel=0.08)
    assert statistics.mean(lasted) == pytest.approx(3.0, rel=0.08)


def test_a_seed_gives_the_same_stops_whatever_others_do() -> None:
    def drawn(seed: int, others: int) -> list[float]:
        stops = Stops({"a": Rate(5.0, 1.0), "b": Rate(5.0, 1.0)}, seed)
        out: list[float] = []
        for _ in range(50):
            for _ in range(others):
                stops.held_up("b", Still(np.zeros(0), 1.0))
            out += stops.held_up("a", Still(np.zeros(0), 1.0))[1]
        return out

    assert drawn(1, 0) == drawn(1, 3) != drawn(2, 0)
    still = Still(np.zeros(0), 1.0)
    assert Stops({}, 1).held_up("a", still) == (still, [])


@pytest.mark.parametrize(
    "text", ["robot1", "robot1:5", "robot1:0/3", "robot1:5/0", ":5/3", "a:-5/3", "a:x/3"]
)
def test_what_is_no_rate(text: str) -> None:
    assert parse(text) is None


def test_a_rate() -> None:
    assert parse("robot1:600/30.5") == ("robot1", Rate(600.0, 30.5))


def test_spread() -> None:
    assert Spread.of([]) is None
    one = Spread.of([3.0])
    assert one is not None and one.mean == 3.0 and one.deviation is None and one.confidence is None
    found = Spread.of([4.0, 1.0, 7.0, 4.0])
    assert found is not None and (found.least, found.median, found.most) == (1.0, 4.0, 7.0)
    assert found.deviation == pytest.approx(math.sqrt(6.0))
    assert found.confidence == pytest.approx(3.182446 * math.sqrt(6.0) / 2.0, rel=1e-5)


def cycle(
    number: int, seconds: float, parts: int, verdict: str = "finished", warm: bool = False
) -> Cycle:
    final = ("Top.Done",) if verdict == "finished" else ()
    return Cycle(number, not warm, verdict, "", final, seconds, {"parts": parts}, 0, 0.0)


def test_throughput_counts_all_time_after_the_warm_up() -> None:
    found = Cycles("cell", "", (
        cycle(1, 500.0, 9, warm=True), cycle(2, 100.0, 3), cycle(3, 50.0, 1, "failed"), cycle(4, 150.0, 2),
    ))  # fmt: skip
    assert found.per_hour() == {"cycles": pytest.approx(24.0), "counts.parts": pytest.approx(72.0)}
    whole = found.finished()
    assert whole is not None and whole.count == 2 and whole.mean == 125.0
    assert set(found.endings()) == {"Top.Done"}
    lines = list(table(found.cycles))
    assert lines[0].split("\t")[-1] == "parts" and lines[1].split("\t")[:3] == [
        "1",
        "yes",
        "finished",
    ]
    assert len(lines) == 5
