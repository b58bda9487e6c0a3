"""`check --geometry` of a large cell says how many states it has seen: to explore them may take minutes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pn2code.diagnostics import Diagnostics
from pn2code.geometry import graph
from pn2code.geometry.check import examine
from pn2code.verdict.opened import read
from pn2code.verify.exploring.limits import Limits

MINIMAL = Path(__file__).parents[3] / "examples" / "minimal"


@pytest.mark.bullet
def test_an_exploration_is_told_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def explore(*args: Any) -> None:
        tell = args[-1].progress
        tell({"states": 12_345, "frontier": 678})
        tell({"phase": "components", "states": 12_345})

    monkeypatch.setattr(graph, "explore", explore)
    d = Diagnostics()
    opened = read(MINIMAL, {}, d)
    assert opened is not None
    said: list[str] = []
    assert examine(opened, None, Limits(), tmp_path, d, say=said.append) is None
    assert said == ["exploring: 12,345 states, 678 of them waiting"]
