"""Data collectors with functions are compiled with the net; they collect what the token game's collect."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from helpers import monitors
from helpers.monitors import SAME, Spec

pytestmark = pytest.mark.cc

NET = """
    net Collected
      standard
      colset RL = real timed;
      colset TI = int timed;
      globref seen = ([] : INT list);
      var n : INT;
      var r : RL;
      var k : TI;
      place P : TI = 1`0
      place R : RL = 1`1.5
      place C : TI = 1`1
      trans T code input (n); action (seen := n :: !seen)
        in P : n
        out P : (n + 1)@+2
      trans Half
        in R : r
        out R : (if r > 0.001 then r / ~3.0 else r + 7.25)@+1
      trans Tick
        in C : k
        out C : (k + 1)@+(k mod 5)
"""


def collector(
    name: str, node: str, predicate: str, observer: str, stop: str = "NONE", **options: str
) -> Spec:
    rules = f"fun pred (bindelem) = let fun one {predicate} | one _ = false in one bindelem end"
    sees = f"fun obs (bindelem) = let fun one {observer} in one bindelem end"
    functions = {
        "Predicate": rules,
        "Observer": sees,
        "Init function": "fun init () = NONE",
        "Stop": f"fun stop () = {stop}",
    }
    return Spec(name, "Data collection", [node], functions, options)


ODD = collector(
    "odd", "Top.T", "(Top'T (1, {n})) = n mod 2 = 1",
    "(Top'T (1, {n})) = n * n - length (!seen) - IntInf.toInt (step ()) | one _ = ~1",
)  # fmt: skip
REAL = collector(
    "real", "Top.Half", "(Top'Half (1, {r})) = r < 5.0",
    "(Top'Half (1, {r})) = r * 1.1 | one _ = 0.0",
)  # fmt: skip
INFINITE = collector(
    "infinite", "Top.Half", "(Top'Half (1, {r})) = true",
    "(Top'Half (1, {r})) = 1.0 / (if r < 0.0 then 0.0 else r) | one _ = 0.0",
)  # fmt: skip
TIMED = collector(
    "timed", "Top.Tick", "(Top'Tick (1, {k})) = true",
    "(Top'Tick (1, {k})) = k mod 7 | one _ = 0", Timed="true",
)  # fmt: skip
TIMED_REAL = collector(
    "timed real", "Top.Tick", "(Top'Tick (1, {k})) = k > 3",
    "(Top'Tick (1, {k})) = Real.fromInt (k mod 7) / 10.0 | one _ = 0.0", Timed="true",
)  # fmt: skip
NEVER = collector(
    "never", "Top.Half", "(Top'Half (1, {r})) = false", "(Top'Half (1, {r})) = r | one _ = 0.0"
)
SIZE = Spec("size", "Marking size", ["Top.P"])
STOP = Spec(
    "stop", "Breakpoint", ["Top.T"],
    {"Predicate": "fun pred (bindelem) = let fun one (Top'T (1, {n})) = n = 37 | one _ = false in one bindelem end"},
)  # fmt: skip


def simulated(folder: Path, specs: Sequence[Spec], *options: object) -> dict[str, Any]:
    return monitors.simulated(folder / "collected.cpn", NET, specs, 400, *options)


@pytest.mark.parametrize(
    "specs",
    [[ODD], [REAL, NEVER, INFINITE], [TIMED, TIMED_REAL], [SIZE, TIMED, ODD, STOP, REAL]],
    ids=["integers", "reals", "timed", "many"],
)
def test_collectors_are_compiled(tmp_path: Path, specs: Sequence[Spec]) -> None:
    compiled = simulated(tmp_path, specs)
    reference = simulated(tmp_path, specs, "--engine", "reference")
    assert (compiled["engine"], compiled["interpreted"]) == ("compiled", [])
    assert {k: repr(compiled[k]) for k in SAME} == {k: repr(reference[k]) for k in SAME}
    counts = {m["name"]: m["count"] for m in compiled["monitors"] if "count" in m}
    assert set(counts) == {s.name for s in specs} - {"stop"}
    assert all(count > 10 for name, count in counts.items() if name != "never")
    assert compiled["why"] == ("breakpoint" if STOP in specs else "steps")


ALWAYS = "(Top'T (1, {n})) = true"
INTERPRETED = [
    collector("big", "Top.T", ALWAYS, "(Top'T _) = IntInf.pow (2, 70) | one _ = 0"),
    collector("drawn", "Top.T", ALWAYS, "(Top'T _) = discrete (1, 6) | one _ = 0"),
    collector("last", "Top.T", ALWAYS, "(Top'T _) = 1 | one _ = 0", "SOME (length (!seen))"),
    collector("raises", "Top.T", ALWAYS, "(Top'T (1, {n})) = 12 div (20 - n) | one _ = 0"),
]


@pytest.mark.parametrize("spec", INTERPRETED, ids=lambda spec: spec.name)
def test_what_cannot_be_compiled_is_interpreted_and_said(tmp_path: Path, spec: Spec) -> None:
    compiled = simulated(tmp_path, [ODD, spec])
    reference = simulated(tmp_path, [ODD, spec], "--engine", "reference")
    assert {k: repr(compiled[k]) for k in SAME} == {k: repr(reference[k]) for k in SAME}
    assert compiled["why"] == ("error" if spec.name == "raises" else "steps")
    assert compiled["interpreted"] == ["odd", spec.name]
