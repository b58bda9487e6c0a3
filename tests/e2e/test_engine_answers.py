"""The example nets, and some random ones, beside what the engine of CPN Tools answered, recorded by `./dev record`."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from tools.oracle.totals import compared

from helpers.netbuilder import cpn
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.net.front import load
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.game.token_game import Game
from pn2code.trace.recording import recording
from pn2code.trace.replay_recording import follow
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits

SPACES = 4
"""Random nets whose state spaces are explored, which takes a compilation each."""
EXAMPLES = sorted(p.parent.name for p in (Path(__file__).parents[2] / "examples").glob("*/*.cpn"))


def answer(root: Path, name: str) -> dict[str, Any]:
    """What was recorded of the net as it is now."""
    kept = json.loads((root / f"tests/golden/engine/{name}.json").read_text(encoding="utf-8"))
    now = hashlib.sha256((root / kept["net"]).read_bytes()).hexdigest()
    assert now == kept["sha256"], "the net has changed: ./dev record asks the engine again"
    return dict(kept)


def flat(root: Path, kept: dict[str, Any]) -> FlatNet:
    """The net, about which nothing is to be said."""
    d = Diagnostics()
    net = load(root / kept["net"], d, compute=compute)
    assert net is not None and kept["accepted"] and not d.items
    return net


def test_every_example_has_an_answer(root: Path) -> None:
    assert len(EXAMPLES) >= 5
    assert sorted(p.stem for p in (root / "tests/golden/engine").glob("*.json")) == EXAMPLES


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_run_of_the_engine_is_possible(root: Path, name: str) -> None:
    kept = answer(root, name)
    followed = follow(recording(kept["run"]), Game(flat(root, kept)))
    assert followed.ok and not followed.random, followed.why
    assert followed.steps == len(kept["run"]["steps"]) > 5
    assert kept["run"]["stop"] == "No more enabled transitions!"


@pytest.mark.parametrize("name", [*EXAMPLES][:: amount(2, 1)])
def test_the_state_space_is_that_of_the_engine(root: Path, name: str) -> None:
    kept = answer(root, name)
    found = explore(flat(root, kept), {}, Limits(traces=0), Diagnostics())
    assert found is not None and found.complete and found.graph is not None
    assert kept["space"] == {
        "nodes": found.nodes,
        "arcs": found.arcs,
        "scc": found.graph.scc_nodes,
        "dead": found.dead_count,
        "home": found.graph.home_count,
    }


def test_random_nets(root: Path, tmp_path: Path) -> None:
    """Verdict, initial marking and a run of each, state spaces of the first; more of them: `./dev oracle --nets`."""
    kept = json.loads((root / "tests/golden/engine_random.json").read_text(encoding="utf-8"))
    states: Counter[str] = Counter()
    for n, entry in enumerate(kept):
        path = tmp_path / f"net{n}.cpn"
        path.write_bytes(cpn(entry["text"]))
        space = entry["space"] if n < SPACES else None
        for question, verdict in compared(path, entry["marking"], entry["run"], space).items():
            assert verdict.state != "differs", f"{path.stem} {question}: {verdict.note}"
            states[verdict.state] += 1
    assert states["agrees"] > 2 * len(kept) > 20
