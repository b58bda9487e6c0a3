"""The token game against what the real CPN Tools engine recorded of nets that people published."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from helpers.engine import RANDOM, initial_differences, run_difference
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.net.front import load
from pn2code.semantics.game import Game
from pn2code.semantics.graph import state_space

pytestmark = pytest.mark.shared

FEWEST_SAME = {"initial markings": 110, "runs": 80, "state spaces": 40}
"""So many nets agree at least: a net that is suddenly refused does not go unnoticed."""
LARGEST_SPACE = 200
DIFFERENT_RUNS = {
    "TimedResourceAlloc/TimedResourceAlloc.cpn": "of equal colours we take the latest stamp, the engine one at random",
}


@cache
def flat_net(path: Path) -> FlatNet | None:
    return load(path, Diagnostics())


def records(shared: Path, kind: str) -> list[tuple[Path, FlatNet, dict[str, Any], bool]]:
    """Path, net, record, whether it draws random numbers, of each net that both accept."""
    folder = shared / "corpus" / kind
    found = []
    for file in sorted(folder.rglob("*.json")):
        path = shared / "corpus" / "nets" / str(file.relative_to(folder)).removesuffix(".json")
        net = flat_net(path)
        if net is not None:
            record = json.loads(file.read_text(encoding="utf-8"))
            found.append((path, net, record, bool(RANDOM.search(source(path)))))
    return found


def source(path: Path) -> str:
    return path.read_text(encoding="iso-8859-1")


def verdict(what: str, same: int, wrong: list[str]) -> None:
    assert not wrong, "\n".join(wrong)
    assert same >= FEWEST_SAME[what]


def test_initial_markings(shared: Path) -> None:
    same, wrong = 0, []
    for path, net, record, is_random in records(shared, "expected"):
        if record["initial_marking"]:
            differences = initial_differences(Game(net), record["initial_marking"], source(path))
            if not differences:
                same += 1
            elif not is_random:
                wrong.append(f"{path}: {differences}")
    verdict("initial markings", same, wrong)


def test_runs(shared: Path) -> None:
    same, wrong = 0, []
    for path, net, record, is_random in records(shared, "traces"):
        difference = run_difference(Game(net), record)
        if not difference:
            same += 1
        elif not is_random and not any(str(path).endswith(name) for name in DIFFERENT_RUNS):
            wrong.append(f"{path}: {difference}")
    verdict("runs", same, wrong)


def test_sizes_of_state_spaces(shared: Path) -> None:
    same, wrong = 0, []
    for path, net, record, is_random in records(shared, "expected"):
        size = record["state_space"]
        if size is None or size["nodes"] > LARGEST_SPACE:
            continue
        space = state_space(Game(net), max_nodes=2 * LARGEST_SPACE)
        ours = (len(space.nodes), len(space.arcs), len(space.dead))
        if ours == (size["nodes"], size["arcs"], size["dead_markings"]):
            same += 1
        elif not is_random:
            wrong.append(f"{path}: {ours} instead of {size}")
    verdict("state spaces", same, wrong)
