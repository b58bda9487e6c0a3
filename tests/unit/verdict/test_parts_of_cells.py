"""A cell of which not all will be seen is looked at in part; with all markings of its net known, it may be seen."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.verdict import controller
from pn2code.verdict.opened import read
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.explorer_process import nothing
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.result import Exploration, Seen

MINIMAL = Path(__file__).parents[3] / "examples" / "minimal"


@pytest.mark.parametrize(("markings", "cut"), [(False, "memory"), (True, "")])
def test_no_room_for_the_graph(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, markings: bool, cut: str
) -> None:
    d = Diagnostics()
    opened = read(MINIMAL, {}, d)
    assert opened is not None
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None
    plans: list[tuple[Plan, Limits]] = []

    def examine(_partition: Any, plan: Plan, limits: Limits, *_rest: Any) -> None:
        plans.append((plan, limits))

    monkeypatch.setattr(controller.control, "examine", examine)
    limits = Limits()
    found = Exploration.of(opened.flat, nothing(opened.flat, limits, "memory"), 0.0)
    found = replace(found, seen=Seen(markings=markings))
    controller.look(opened, partition, found, limits, ExploreOptions(), tmp_path, d)
    ((plan, own),) = plans
    assert plan.cut == cut
    assert (own.max_states == limits.max_states) is markings
