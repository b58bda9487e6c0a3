"""For which activity of the supervisor a robot works."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from pn2code.run.activities import Activities
from pn2code.run.record import ActivityRecord

OWNERS = ("supervisor", "one", "two", "three")
FIRED = {
    "Top.Sup.Load.Order": (0, "one"),
    "Top.Sup.Finish": (0, "three"),
    "Top.One.Pass": (1, "two", "supervisor"),
    "Top.Two.Say": (2, "three"),
}
"""By transition: its owner's number, and to whom it writes."""


@pytest.fixture
def activities() -> Activities:
    """Of a cell in which the place of each channel has the number of its reader."""
    partition: Any = SimpleNamespace(
        owners=[SimpleNamespace(name=name) for name in OWNERS],
        channels=[SimpleNamespace(place=i, reader=i) for i in range(len(OWNERS))],
        transition_owner=[owner for owner, *_ in FIRED.values()],
        net=SimpleNamespace(
            transitions=[
                SimpleNamespace(
                    name=name, arcs=[SimpleNamespace(place=OWNERS.index(x)) for x in readers]
                )
                for name, (_, *readers) in FIRED.items()
            ]
        ),
    )
    return Activities(partition, 2, [])


def test_an_order_that_is_passed_on_belongs_to_the_same_activity(activities: Activities) -> None:
    activities.fires("Top.Sup.Load.Order", 1.0)
    activities.pass_on("Top.One.Pass")
    activities.fires("Top.Sup.Finish", 2.0)
    assert activities.of("two") == "Load" and activities.of("three") == ""
    activities.pass_on("Top.Two.Say")
    assert activities.of("three") == "Load"


def test_a_firing_on_the_page_of_the_supervisor_ends_an_activity(activities: Activities) -> None:
    activities.fires("Top.Sup.Load.Order", 1.0)
    activities.fires("Top.Sup.Finish", 2.0)
    assert activities._ended == [ActivityRecord("Load", 1.0, 2.0)]
    assert activities.now == ""


def test_who_was_ordered_by_nobody_passes_nothing_on(activities: Activities) -> None:
    activities.pass_on("Top.One.Pass")
    activities.fires("Top.Sup.Load.Order", 1.0)
    assert activities.of("two") == "Load"
    activities.fires("Top.Sup.Finish", 2.0)
    assert activities.of("two") == ""
