"""A shortest run to a marking with one of certain tokens, from the graph that the explorer writes.

found = token_run(net, storage, questions, [(place, value)], Path("net.trace.jsonl"), d)   # Run(steps=4, node=5, ...)

It is played by the token game, which writes the trace.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.colour_json import from_json
from pn2code.trace.writing import TraceFile, TraceUnwritableError
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits

MOST_NODES = 200_000
"""Of a graph that is written; in a larger one the run is not looked for."""


@frozen
class Run:
    """A run. `token`: which one it leads to, by number. `file` is None if the trace could not be written."""

    steps: int
    node: int
    transitions: tuple[str, ...]
    file: Path | None
    token: int = 0


@frozen
class _Graph:
    """What is needed of a graph: the node with a token, and by which arc each node was reached first."""

    node: int
    token: int
    parent: Mapping[int, tuple[int, Mapping[str, Any]]]

    def path(self) -> list[Mapping[str, Any]]:
        """The arcs from the first node."""
        arcs = []
        node = self.node
        while node in self.parent:
            node, arc = self.parent[node]
            arcs.append(arc)
        return arcs[::-1]


def token_run(
    net: FlatNet,
    storage: Mapping[str, str],
    questions: str,
    tokens: Sequence[tuple[int, Any]],
    trace: Path,
    d: Diagnostics,
) -> Run | None:
    """The run; None if the graph is too large, or after an error.

    Args:
        net: the net.
        storage: as for `Game`.
        questions: for the explorer: under which rules the net is explored.
        tokens: each with the index of its place, and its value in the form of traces.
        trace: where the trace goes.
        d: gets the errors.
    """
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        file = Path(name) / "graph.jsonl"
        options = ExploreOptions(
            graph=file,
            graph_limit=MOST_NODES,
            questions=questions,
            evidence=Path(name),
            quick=True,
        )
        limits = Limits(max_states=MOST_NODES, graph=True, traces=0)
        found = explore(net, storage, limits, d, options)
        if found is None or not file.exists():
            return None
        graph = _read(file, [(net.places[place].name, value) for place, value in tokens])
    return None if graph is None else _played(net, storage, graph, trace)


def _read(file: Path, tokens: Sequence[tuple[str, Any]]) -> _Graph | None:
    """Nodes are numbered breadth first: the first one with a token is one of the nearest."""
    wanted: dict[str, dict[str, int]] = {}
    for number, (place, value) in enumerate(tokens):
        wanted.setdefault(place, {}).setdefault(json.dumps(value), number)
    goal: tuple[int, int] | None = None
    parent: dict[int, tuple[int, Mapping[str, Any]]] = {}
    for row in _rows(file):
        if "node" in row:
            for place, values in wanted.items() if goal is None else ():
                held = (json.dumps(token[1]) for token in row["marking"][place])
                found = next((values[text] for text in held if text in values), None)
                if found is not None and goal is None:
                    goal = row["node"], found
        elif row["to"] != 1 and row["to"] not in parent and row["from"] < row["to"]:
            parent[row["to"]] = row["from"], row
    return None if goal is None else _Graph(*goal, parent)


def _rows(file: Path) -> Iterator[dict[str, Any]]:
    with file.open(encoding="utf-8", errors="surrogateescape") as lines:
        yield from map(json.loads, lines)


def _played(net: FlatNet, storage: Mapping[str, str], graph: _Graph, path: Path) -> Run | None:
    game = Game(net, storage, files=Files(None))
    named: list[str] = []
    kept: Path | None = path
    try:
        with closing(TraceFile(path)) as file:
            file.header(game, "reference", 1)
            for arc in graph.path():
                t = net.transitions[arc["index"]]
                outputs = t.code.outputs if t.code else ()
                bound = {
                    s: from_json(s.colset, arc["binding"][s.name])
                    for s in t.variables
                    if s not in outputs and s.colset is not None
                }
                if arc["t"] > game.marking.time:
                    game.set_time(arc["t"])
                file.occurrence(game, game.fire(BindingElement.make(t, bound), checked=False))
                named.append(t.name)
            file.end(game.marking.time, "steps")
    except TraceUnwritableError:
        kept = None
    except GameError:
        return None
    return Run(len(graph.path()), graph.node, tuple(named), kept, graph.token)
