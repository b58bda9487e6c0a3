"""A small state space, node by node, as the explorer writes it; and what a picture of it says.

graph = read(net, Path("graph.jsonl"))
graph.nodes[0].marks            # (("Think", "1`1++ 1`2"), ...) of the initial marking
graph.arcs[0].label             # "Take p=1"
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.game.marking import place_from_json, place_text, variable_text
from pn2code.semantics.game.report import time_text
from pn2code.semantics.values.colour_json import from_json
from pn2code.semantics.values.colours import TEXTS


@frozen
class Node:
    """A marking.

    Args:
        number: from 1, breadth first.
        time: model time as a text, "" in an untimed net.
        marks: (place, multi-set as CPN ML in one line) of the places that are marked, in the order of the net.
        depth: the fewest steps from the initial marking.
        component: number of its strongly connected component, from 0 in the order of their first nodes.
    """

    number: int
    time: str
    marks: tuple[tuple[str, str], ...]
    depth: int
    component: int

    @property
    def text(self) -> str:
        """All that is marked, a place below the other."""
        lines = [f"time {self.time}"] if self.time else []
        lines += [f"{place}: {tokens}" for place, tokens in self.marks]
        return "\n".join(lines) or "empty"


@frozen
class Arc:
    """A binding element that occurs at a node; nodes by number.

    Args:
        source, target: nodes.
        transition: its name.
        binding: (variable, value as CPN ML).
    """

    source: int
    target: int
    transition: str
    binding: tuple[tuple[str, str], ...]

    @property
    def values(self) -> str:
        """`p=1, q=2`."""
        return ", ".join(f"{name}={value}" for name, value in self.binding)

    @property
    def label(self) -> str:
        """`Take p=1, q=2`."""
        return f"{self.transition} {self.values}" if self.binding else self.transition


@frozen
class StateGraph:
    """A whole state space.

    Args:
        nodes: in the order of their numbers; the first is the initial marking.
        arcs: each binding element once.
        dead, home: numbers of nodes.
        cyclic: components with more than one node, or with an arc from a node to itself.
        components: how many there are.
        path: positions in `arcs` that lead to the first dead marking; () when there is none.
    """

    nodes: tuple[Node, ...]
    arcs: tuple[Arc, ...]
    dead: frozenset[int]
    home: frozenset[int]
    cyclic: frozenset[int]
    components: int
    path: tuple[int, ...]

    def edges(self) -> dict[tuple[int, int], list[int]]:
        """Positions in `arcs` by source and target: parallel arcs are one line in a picture."""
        found: dict[tuple[int, int], list[int]] = {}
        for i, arc in enumerate(self.arcs):
            found.setdefault((arc.source, arc.target), []).append(i)
        return found


def read(net: FlatNet, path: Path) -> StateGraph:
    """What the explorer has written with `--write-graph`.

    Raises:
        OSError: it cannot be read.
    """
    nodes: list[Mapping[str, Any]] = []
    arcs: dict[Arc, None] = {}
    transitions = _transition_names(net)
    with path.open(encoding="utf-8", errors="surrogateescape") as file:
        for line in file:
            row = json.loads(line)
            if "node" in row:
                nodes.append(row)
                continue
            t = net.transitions[row["index"]]
            binding = tuple(_binding(t, row["binding"]))
            arcs[Arc(row["from"], row["to"], transitions[t.index], binding)] = None
    return _graph(net, nodes, tuple(arcs))


def _graph(net: FlatNet, rows: Sequence[Mapping[str, Any]], arcs: tuple[Arc, ...]) -> StateGraph:
    size = len(rows)
    component = _components(size, arcs)
    depth, parent = _depths(size, arcs)
    places = _place_names(net)
    nodes = []
    for row in rows:
        number = row["node"]
        marks = []
        for place, name in zip(net.places, places, strict=True):
            data = row["marking"][place.name]
            if data:
                held = place_from_json(place.colset, data)
                shown = place_text(TEXTS, place.colset, held, earlier_first=True)
                marks.append((name, " ".join(shown.split("\n"))))
        time = time_text(row["t"]) if net.timed else ""
        nodes.append(Node(number, time, tuple(marks), depth[number], component[number]))
    left = {arc.source for arc in arcs}
    dead = frozenset(n for n in range(1, size + 1) if n not in left)
    open_ends = {
        component[arc.source] for arc in arcs if component[arc.source] != component[arc.target]
    }
    last = set(component.values()) - open_ends
    home = (
        frozenset(n for n, c in component.items() if c in last) if len(last) == 1 else frozenset()
    )
    sizes = Counter(component.values())
    cyclic = {c for c, n in sizes.items() if n > 1}
    cyclic |= {component[arc.source] for arc in arcs if arc.source == arc.target}
    path: list[int] = []
    at = min(dead, default=1)
    while at in parent:
        path.append(parent[at])
        at = arcs[parent[at]].source
    return StateGraph(
        tuple(nodes), arcs, dead, home, frozenset(cyclic), len(sizes), tuple(reversed(path))
    )


def _components(size: int, arcs: Iterable[Arc]) -> dict[int, int]:
    """The component of each node, numbered in the order of their first nodes."""
    from scipy.sparse import coo_array  # takes a while, and most runs draw nothing
    from scipy.sparse.csgraph import connected_components

    ends = [(arc.source - 1, arc.target - 1) for arc in arcs]
    rows, columns = ([a for a, _ in ends], [b for _, b in ends])
    matrix = coo_array(([1] * len(ends), (rows, columns)), shape=(size, size))
    _, label = connected_components(matrix.tocsr(), directed=True, connection="strong")
    number: dict[int, int] = {}
    return {n + 1: number.setdefault(int(label[n]), len(number)) for n in range(size)}


def _depths(size: int, arcs: Sequence[Arc]) -> tuple[dict[int, int], dict[int, int]]:
    """The depth of each node, and the arc by which a shortest way comes to it, as the explorer finds it."""
    leaving: list[list[int]] = [[] for _ in range(size + 1)]
    for i, arc in enumerate(arcs):
        leaving[arc.source].append(i)
    depth = {1: 0}
    parent: dict[int, int] = {}
    level = [1]
    while level:
        following = []
        for n in sorted(level):
            for i in leaving[n]:
                target = arcs[i].target
                if target not in depth:
                    depth[target] = depth[n] + 1
                    parent[target] = i
                    following.append(target)
        level = following
    return depth, parent


def _binding(t: FlatTransition, data: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for symbol in t.variables:
        if symbol.name in data:
            assert symbol.colset is not None, "a net variable has a colour set"
            value = from_json(symbol.colset, data[symbol.name])
            yield symbol.name, variable_text(TEXTS, symbol, value)


def _place_names(net: FlatNet) -> list[str]:
    """The short ones, where they are unique."""
    count = Counter(p.short for p in net.places)
    return [_line(p.short if p.short and count[p.short] == 1 else p.name) for p in net.places]


def _transition_names(net: FlatNet) -> list[str]:
    count = Counter(t.short for t in net.transitions)
    return [_line(t.short if t.short and count[t.short] == 1 else t.name) for t in net.transitions]


def _line(name: str) -> str:
    return " ".join(name.split())
