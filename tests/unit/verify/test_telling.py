"""How far an exploration is, in words."""

from __future__ import annotations

from typing import Any, cast

import pytest

from pn2code.base.how_far import listening
from pn2code.diagnostics import Diagnostics
from pn2code.verify.controller import control, proofs
from pn2code.verify.controller.control_types import Plan
from pn2code.verify.exploring.telling import telling


def test_states_are_told_with_their_rate() -> None:
    said: list[str] = []
    tell = telling(said.append, "exploring")
    tell({"phase": "explore", "states": 12_345, "rate": 678.4, "frontier": 9})
    tell({"states": 7})
    tell({"phase": "graph", "states": 12_345})
    tell({"phase": "explore"})
    assert said == [
        "exploring: 12,345 states, 678 a second, 9 of them waiting",
        "exploring: 7 states, 0 of them waiting",
    ]


def test_what_generate_proves_is_told_to_whoever_listens(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also from the thread that hears the explorer."""

    def examine(_partition: Any, plan: Plan, *_rest: Any) -> None:
        plan.options.progress({"states": 1_200, "rate": 30.0, "frontier": 4})

    monkeypatch.setattr(control, "examine", examine)
    said: list[str] = []
    plan = Plan(storage={}, order_decides=False, capacities={}, premises=cast(Any, None))
    with listening(said.append):
        proofs._look(cast(Any, None), cast(Any, None), plan, Diagnostics())
    assert said == [
        "proving what the programs rely on: 1,200 states, 30 a second, 4 of them waiting"
    ]
