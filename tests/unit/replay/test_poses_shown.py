"""The paths of arms: rests take two samples, and between samples the motion is met."""

from __future__ import annotations

import numpy as np
import pytest

from pn2code.replay.arrays import unpacked
from pn2code.replay.motion import Motion, interpolated, slopes


def sampled(times: list[float], angle: object) -> Motion:
    motion = Motion()
    for t in times:
        motion.sampled(None, t, {"r": np.full(6, angle(t))})  # type: ignore[arg-type, operator]
    return motion


def smooth(t: float) -> float:
    """From 0 to 1 in a second, at rest before and after, with limited jerk."""
    x = min(max(t - 1.0, 0.0), 1.0)
    return x**3 * (10 - 15 * x + 6 * x * x)


def test_a_rest_takes_two_samples() -> None:
    motion = sampled(np.arange(0, 4, 0.02).tolist(), smooth)
    t = unpacked(motion.described()["r"]["t"])
    assert len(t) < 60
    assert t[0] == 0.0 and t[-1] == pytest.approx(3.98)


def test_between_samples_the_motion_is_met() -> None:
    motion = sampled(np.arange(0, 4, 0.02).tolist(), smooth)
    worst = max(abs(motion.at("r", t)[0] - smooth(t)) for t in np.linspace(0, 3.9, 1777).tolist())
    assert worst < 2e-5


def test_nothing_moves_in_a_rest_however_fast_it_is_before_and_after() -> None:
    t = np.array([0.0, 0.02, 5.0, 5.02])
    q = np.array([[0.0], [0.3], [0.3], [0.9]])
    assert slopes(t, q)[1:3].tolist() == [[0.0], [0.0]]
    assert all(interpolated(t, q, x)[0] == pytest.approx(0.3, abs=1e-12) for x in (0.02, 1.0, 4.99))


def test_outside_the_samples_the_arm_stands() -> None:
    t, q = np.array([1.0, 2.0]), np.array([[0.0], [1.0]])
    assert [interpolated(t, q, x)[0] for x in (0.0, 1.0, 2.0, 9.0)] == [0.0, 0.0, 1.0, 1.0]
