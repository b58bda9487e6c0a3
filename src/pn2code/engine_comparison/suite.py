"""The semantics suite: for tiny nets the whole graph of the real engine, and the values of expressions."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pn2code.diagnostics import Diagnostics
from pn2code.engine_comparison.finding import AGREES, Finding, State, differs
from pn2code.engine_comparison.graphs import engine_arcs, engine_nodes, our_arcs, our_nodes
from pn2code.net import front
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.effects import Effects, outside
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game

MAX_NODES = 300


def names(suite: Path) -> list[str]:
    """The nets of the suite, sorted."""
    return sorted(f.stem for f in suite.glob("*.json"))


INTENDED = {
    "E20_same_colour": "of equal available tokens with different stamps the engine takes one at random, and its state "
    "space has the other successor only by chance; here the latest is taken",
    "E34_nonlinear": "a variable twice in one pattern: the engine takes tokens whose components differ and then raises "
    "an exception; here the components must be equal",
}
"""Where the answer shall be another one than the engine's."""


def compare_graph(suite: Path, name: str) -> Finding:
    """Every marking and every binding element of a net's state space."""
    found = _compare(suite, name)
    if found.state is State.DIFFERS and name in INTENDED:
        return Finding(State.INTENDED, INTENDED[name])
    return found


def _compare(suite: Path, name: str) -> Finding:
    recorded: dict[str, Any] = json.loads((suite / f"{name}.json").read_text(encoding="utf-8"))
    d = Diagnostics()
    net = front.load(suite / f"{name}.cpn", d, compute=compute)
    if net is None or not recorded["accepted"]:
        if (net is not None) == recorded["accepted"]:
            return AGREES
        said = "accepted" if net else "; ".join(e.message for e in d.errors[:2])
        return differs(f"here: {said}")
    graph = recorded["graph"]
    try:
        game = Game(net)
        space = state_space(game, max_nodes=MAX_NODES)
    except GameError as error:
        return AGREES if graph is None else differs(error.message)
    if graph is None:
        return AGREES if not space.complete else differs("a state space, where the engine has none")
    ours, theirs = set(our_nodes(game, space)), set(engine_nodes(net, graph).values())
    if ours != theirs and outside(Effects(net.program), net):
        return Finding(State.RANDOM, "a value is drawn")
    if ours != theirs:
        return differs(f"{len(ours - theirs)} markings only here, {len(theirs - ours)} only there")
    arcs, their_arcs = our_arcs(game, space), engine_arcs(net, graph)
    if arcs != their_arcs:
        more, less = len(arcs - their_arcs), len(their_arcs - arcs)
        return differs(f"{more} binding elements only here, {less} only there")
    return Finding(State.AGREES, f"{len(ours)} markings, {len(arcs)} arcs")
