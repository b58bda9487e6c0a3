"""Each matter is an alarm once, when it begins, and again after it was over."""

from __future__ import annotations

from typing import Any

from pn2code.live.alarms import Alarms
from pn2code.robot.backend import Clearance


def picture(condition: float | None = None, *gaps: float) -> dict[str, Any]:
    rows = [(1.0, Clearance("scene", "robot1", "robot1/tool", "panel", gap)) for gap in gaps]
    return {"series": {"condition.robot1": condition}, "gaps": rows, "warnings": []}


def test_a_bad_condition_is_told_once_until_it_is_over() -> None:
    alarms = Alarms(50.0, 0.01)
    for value in (10.0, 60.0, 70.0, 49.0, 55.0, 40.0, None, 51.0):
        alarms.look(1.0, picture(value))
    assert [e["kind"] for e in alarms.news()] == ["warning", "warning"]
    assert alarms.count == 2 and alarms.news() == []


def test_a_small_clearance_is_named() -> None:
    alarms = Alarms(50.0, 0.01)
    alarms.look(1.0, picture(None, 0.05, 0.004, 0.003, 0.05, 0.002))
    texts = [e["text"] for e in alarms.news()]
    assert len(texts) == 2 and "robot1/tool and panel are 4.0 mm apart" in texts[0]


def test_an_end_that_is_not_wanted_is_told() -> None:
    ends = {
        "": {"word": "finished", "reason": "", "final": ["Over"], "failed": []},
        "the cell has ended in Jammed": {
            "word": "finished",
            "final": ["Jammed"],
            "failed": ["Jammed"],
        },
        "the cell has ended, a failure: {x = 1}": {
            "word": "finished",
            "final": ["Over"],
            "failed": ["{x = 1}"],
        },
        "robot.tdl:3": {"word": "stopped", "reason": "robot.tdl:3", "failed": []},
    }
    for text, verdict in ends.items():
        alarms = Alarms(50.0, 0.01)
        alarms.ended(1.0, verdict)
        assert [e["text"] for e in alarms.news()] == [text][: bool(text)]


def test_a_fault_is_told_once() -> None:
    alarms = Alarms(50.0, 0.01)
    alarms.fault(1.0, "", "stopped")
    alarms.fault(2.0, "", "stopped")
    assert [(e["t"], e["kind"]) for e in alarms.news()] == [(1.0, "fault")]
