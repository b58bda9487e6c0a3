"""Curves of a description: what is left out lies between what is left, as far as anybody can see."""

from __future__ import annotations

import math

import numpy as np

from pn2code.replay.happenings import LEAST_M, thinned


def test_a_peak_does_not_blur_what_is_small() -> None:
    """An arm that has begun at a singularity: its conditioning afterwards is written beside its picture."""
    t = np.arange(500) * 0.02
    condition = np.array([1e17, 6e5, *(6.0 + 3.0 * np.sin(t[2:]))])
    at, values = thinned(t, condition, 0.0)
    assert len(at) < len(t) / 3
    assert np.all(np.abs(np.interp(t, at, values) / condition - 1.0) < 0.005)


def test_a_small_clearance_is_exact_beside_a_large_one() -> None:
    t = np.arange(500) * 0.02
    clearance = np.where(t < 5.0, 5.0, 0.002 + 0.001 * np.cos(t))
    at, values = thinned(t, clearance, LEAST_M)
    assert np.all(
        np.abs(np.interp(t, at, values) - clearance)
        <= np.maximum(0.002 * clearance, LEAST_M) + 1e-12
    )


def test_what_was_not_measured_is_left_open() -> None:
    t = np.arange(9.0)
    values = np.array([1.0, 1.0, 1.0, math.nan, math.nan, math.nan, 2.0, 2.0, 2.0])
    at, left = thinned(t, values, LEAST_M)
    assert [x for x, v in zip(at, left, strict=True) if math.isfinite(v)] == [0.0, 2.0, 6.0, 8.0]
