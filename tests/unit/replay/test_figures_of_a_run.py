"""The figures in the tab *Run*."""

from __future__ import annotations

from pn2code.replay.description import facts


def test_of_a_singularity_only_that_it_is_one() -> None:
    summary = {
        "layout": "",
        "backend": "fake",
        "cycle_seconds": 7.0,
        "counts": {},
        "clearances": {},
        "conditioning": {"a": {"worst": 17.06, "t": 2.0}, "b": {"worst": 8.6e18, "t": 2.0}},
        "robots": {},
    }
    assert facts(summary)[-2:] == [
        ["worst condition number, a", "17.1"],
        ["worst condition number, b", "above 1,000,000"],
    ]


def test_of_a_least_clearance_what_is_nearest() -> None:
    summary = {
        "layout": "",
        "backend": "bullet",
        "cycle_seconds": 7.0,
        "counts": {},
        "clearances": {"robots": {"m": 0.0123, "t": 1.5, "between": ["a/link_4", "b/tool_tip"]}},
        "conditioning": {},
        "robots": {},
    }
    assert facts(summary)[-1] == ["least clearance, robots", "12.3 mm, `a/link_4` and `b/tool_tip`"]
