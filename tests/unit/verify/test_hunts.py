"""What is known to fail without a run: a search for this comes first, and never says anything else."""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any, cast

from pn2code.base.deadline import Deadline
from pn2code.properties import meaning as m
from pn2code.verify.controller.hunts import hunt
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration

ASKED = [m.Bound(0, None, 1), m.Bound(1, None, 1)]
OPEN = {"answer": "unknown", "why": "seconds", "trace": None}
FAILED = {"answer": "no", "why": None, "trace": None}
SHOWN = {"answer": "no", "why": None, "trace": "run", "steps": 5}


class Explorer:
    """Says the same of whatever is asked, and notes what was."""

    def __init__(self, says: Mapping[str, Any]) -> None:
        self.says = says
        self.asked: list[str] = []

    def __call__(self, limits: Limits, options: ExploreOptions) -> Exploration:
        self.asked.append(options.stem)
        return cast(Any, SimpleNamespace(error=None, answers=(self.says,), depth=10))


NO_LIMITS = Limits()


def searched(says: Mapping[str, Any], limits: Limits = NO_LIMITS) -> tuple[Explorer, Any]:
    explorer = Explorer(says)
    rows = hunt(ASKED, [OPEN, FAILED], "", limits, ExploreOptions(), explorer, failing=[1])
    return explorer, rows


def test_the_run_of_a_failure_is_looked_for_first() -> None:
    explorer, rows = searched(SHOWN)
    assert explorer.asked == ["hunt-1", "hunt-0"]
    assert rows == ({**SHOWN, "part": True}, {**SHOWN, "part": True})


def test_where_none_is_found_the_failure_stays_known() -> None:
    for says in (OPEN, FAILED, {**SHOWN, "answer": "yes"}):
        assert searched(says)[1][1] == FAILED


def test_nothing_is_looked_for_when_the_time_is_over() -> None:
    explorer, rows = searched(SHOWN, Limits(deadline=Deadline.after(0.0)))
    assert (explorer.asked, rows) == ([], (OPEN, FAILED))
