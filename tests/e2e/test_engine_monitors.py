"""Nets with monitors beside the recorded answers of the engine of CPN Tools.

Statistics, logs, files, breakpoints, and which monitors are wrong.
`./dev oracle --monitored` asks the engine again.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from tools.oracle.monitored import answers, here
from tools.oracle.monitored_nets import CASES

from pn2code.semantics.game.report import places

KEPT = answers()
OTHER_NAMES = {"avrg": "avg", "vari": "variance"}
"""Statistics that the reports here call otherwise."""


def number(text: str) -> float:
    """As SML prints it."""
    return float(text.replace("~", "-"))


def test_every_net_has_an_answer() -> None:
    assert CASES.keys() == KEPT.keys()


@pytest.mark.parametrize("name", CASES)
def test_monitors_as_in_the_engine(name: str, tmp_path: Path) -> None:
    kept: dict[str, Any] = KEPT[name]
    net, outcome, monitors, files, d = here(CASES[name], tmp_path)
    said = {found[1] for i in d.items if (found := re.match(r"monitor `([^`]*)`", i.message))}
    assert said - {"NoList"} == kept["errors"].keys()
    rows = {row["name"]: row for row in outcome.monitors}
    assert rows.keys() == {m.name for m in monitors} - kept["errors"].keys()
    for monitor, statistics in kept["statistics"].items():
        found = {n: rows[monitor][OTHER_NAMES.get(n, n)] for n in statistics}
        assert found == pytest.approx({n: number(x) for n, x in statistics.items()}, rel=1e-11)
    wrong = {f"{m.ml_name}.log" for m in monitors if m.name in kept["errors"]}
    assert files == {n: text for n, text in kept["files"].items() if n not in wrong}
    assert outcome.steps == kept["step"]
    if outcome.why == "error":
        assert "raised when monitoring" in kept["stop"] and outcome.failure is not None
        return
    assert outcome.steps == len(kept["steps"])
    assert ("Breakpoint: " in kept["stop"]) == (outcome.why == "breakpoint")
    if outcome.breakpoint is not None:
        assert kept["stop"].endswith(f"Breakpoint: {outcome.breakpoint['name']}")
    assert outcome.final is not None and number(kept["time"] or "0") == outcome.final.time
    ours = {(r["id"], r["instance"]): r["marking"] for r in places(net, outcome.final)}
    assert ours == {(i, n): marking for i, n, marking in kept["marking"]}
