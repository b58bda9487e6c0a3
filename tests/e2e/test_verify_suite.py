"""The semantics suite: the compiled explorer finds the real engine's graph, marking by marking, binding by binding."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from helpers.explored import Explorers
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.engine_comparison.graphs import engine_arcs, engine_nodes, written
from pn2code.engine_comparison.suite import INTENDED
from pn2code.net import front

pytestmark = pytest.mark.cc

SUITE = Path(
    os.environ.get("PN2CODE_SHARED", Path(__file__).parents[3] / "shared"), "semantics-suite"
)
RANDOM = ("E31b_discrete",)
"""Draw a value."""


NAMES = sorted(f.stem for f in SUITE.glob("*.json"))
"""`test_compiled_core.py` has all of them in the ordinary run."""


@pytest.mark.parametrize("name", NAMES[:: amount(3, 1)])
def test_graph(explorers: Explorers, name: str) -> None:
    recorded = json.loads((SUITE / f"{name}.json").read_text(encoding="utf-8"))
    net = front.load(SUITE / f"{name}.cpn", Diagnostics())
    assert (net is not None) == recorded["accepted"]
    if net is None:
        return
    graph = recorded["graph"]
    found = explorers.explore(net, "--max-states", 300)
    report = found.report
    if name in INTENDED:
        return
    if graph is None:
        assert not report["complete"], "a state space, where the engine has none"
        return
    assert report["complete"], report["error"]
    assert report["nodes"] == len(found.nodes)
    nodes, arcs = written(net, found.lines)
    size = recorded["state_space"]
    assert report["dead_count"] == size["dead_markings"]
    assert (report["nodes"], report["arcs"]) == (size["nodes"], size["arcs"])
    if name not in RANDOM:
        assert sorted(nodes) == sorted(engine_nodes(net, graph).values())
        assert arcs == engine_arcs(net, graph)
