"""For which activity of the supervisor a robot works."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from pn2code.run.engine import Engine
from pn2code.run.record import ActivityRecord, RunRecord


class Bare(Engine):
    """An engine of which only the orders are looked at."""

    __slots__ = ()

    def __init__(self) -> None:
        self.record = RunRecord("cell", "", "fake")
        self.supervisor_depth, self.activity, self._activity_start = 2, "", 0.0
        self._ordered_by = {}
        self._owner_of = {"Top.One.Pass": "one", "Top.Two.Say": "two"}
        self._commanded = {
            "Top.Sup.Load.Order": ("one",),
            "Top.Sup.Finish": ("three",),
            "Top.One.Pass": ("two", "supervisor"),
            "Top.Two.Say": ("three",),
        }

    def fires(self, transition: str, t: float) -> None:
        self._enter_activity({"transition": transition}, t)


def test_an_order_that_is_passed_on_belongs_to_the_same_activity() -> None:
    engine = Bare()
    engine.fires("Top.Sup.Load.Order", 1.0)
    engine._pass_on("Top.One.Pass")
    engine.fires("Top.Sup.Finish", 2.0)
    assert engine._ordered_by["two"] == "Load" and engine._ordered_by["three"] == ""
    engine._pass_on("Top.Two.Say")
    assert engine._ordered_by["three"] == "Load"


def test_a_firing_on_the_page_of_the_supervisor_ends_an_activity() -> None:
    engine = Bare()
    engine.fires("Top.Sup.Load.Order", 1.0)
    engine.fires("Top.Sup.Finish", 2.0)
    assert engine.record.activities == [ActivityRecord("Load", 1.0, 2.0)]
    assert engine.activity == ""


def test_who_was_ordered_by_nobody_passes_nothing_on() -> None:
    engine: Any = SimpleNamespace(
        _owner_of={"T": "one"}, _ordered_by={}, _commanded={"T": ("two",)}
    )
    Engine._pass_on(engine, "T")
    assert engine._ordered_by == {}
