"""An automatic layout in layers, for pages whose file says nothing useful about positions.

In: nodes with sizes, edges in the direction of the flow. Out: a centre for each node, and bend points for edges that
pass over layers. The usual way (Sugiyama): each connected part is made free of cycles by turning edges around, nodes
get layers by their longest way from a start, long edges get a dummy in each layer between, the order inside layers is
improved by barycentres, and then nodes move towards their neighbours as far as the others let them. Deterministic.

Example:

    arrange({"p": (60, 40), "t": (60, 40)}, {"a": ("p", "t")})
    # positions {"p": (0, 0), "t": (0, 120)}, bends {}
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.drawing.geometry import Point

GAP_X, GAP_Y = 90.0, 80.0
"""Between the nodes of a layer, and between layers: room for inscriptions."""
_DUMMY = 10.0
_SWEEPS, _FEW_SWEEPS, _MANY = 12, 4, 4000
_ROW = 2400.0
_MOST_DUMMIES = 10_000


@frozen
class Arrangement:
    """Centres of nodes by id, bend points of edges by id (from the edge's start to its end)."""

    centres: dict[str, Point]
    bends: dict[str, tuple[Point, ...]]


@record
class _Part:
    """A connected part; nodes are numbered, dummies come after the real ones."""

    names: list[str]
    widths: list[float]
    heights: list[float]
    gap: tuple[float, float]
    layer: list[int] = field(default_factory=list)
    down: list[list[int]] = field(default_factory=list)
    up: list[list[int]] = field(default_factory=list)
    layers: list[list[int]] = field(default_factory=list)
    x: list[float] = field(default_factory=list)
    chains: dict[str, list[int]] = field(default_factory=dict)


def arrange(
    nodes: Mapping[str, tuple[float, float]],
    edges: Mapping[str, tuple[str, str]],
    layers: Mapping[str, int] | None = None,
    gap: tuple[float, float] = (GAP_X, GAP_Y),
) -> Arrangement:
    """Positions for nodes (id -> width, height) and bends for edges (id -> start, end).

    Args:
        nodes, edges: what is arranged.
        layers: the layer of each node, from 0, when the caller knows better; edges inside a layer get no bends.
        gap: between the nodes of a layer, and between layers.
    """
    centres: dict[str, Point] = {}
    bends: dict[str, tuple[Point, ...]] = {}
    leaving: dict[str, list[str]] = {}
    for edge, (start, _) in edges.items():
        leaving.setdefault(start, []).append(edge)
    left = top = row = 0.0
    for members in _connected(nodes, edges):
        part = _Part(members, [nodes[n][0] for n in members], [nodes[n][1] for n in members], gap)
        own = {e: edges[e] for n in members for e in leaving.get(n, ())}
        if layers is None:
            _layer(part, own)
        else:
            _take_layers(part, own, layers)
        _order(part)
        _place(part)
        at, below, right = _coordinates(part)
        if left > 0 and left + right > _ROW:
            left, top, row = 0.0, top + row + gap[1], 0.0
        for i, name in enumerate(part.names):
            centres[name] = (left + at[i][0], top + at[i][1])
        for edge, chain in part.chains.items():
            bends[edge] = tuple((left + at[i][0], top + at[i][1]) for i in chain)
        left, row = left + right + gap[0], max(row, below)
    return Arrangement(centres, bends)


def _connected(nodes: Iterable[str], edges: Mapping[str, tuple[str, str]]) -> list[list[str]]:
    """The connected parts, the larger ones first, each in order of the nodes."""
    neighbours: dict[str, list[str]] = {n: [] for n in nodes}
    for a, b in edges.values():
        neighbours[a].append(b)
        neighbours[b].append(a)
    number: dict[str, int] = {}
    count = 0
    for start in neighbours:
        if start in number:
            continue
        number[start] = count
        todo = [start]
        while todo:
            for n in neighbours[todo.pop()]:
                if n not in number:
                    number[n] = count
                    todo.append(n)
        count += 1
    parts: list[list[str]] = [[] for _ in range(count)]
    for n in neighbours:
        parts[number[n]].append(n)
    return sorted(parts, key=len, reverse=True)


def _layer(part: _Part, edges: Mapping[str, tuple[str, str]]) -> None:
    """Layers by longest ways, in the graph whose backward edges are turned; then the dummies."""
    number = {n: i for i, n in enumerate(part.names)}
    size = len(part.names)
    ends = {e: (number[a], number[b]) for e, (a, b) in edges.items()}
    following: list[list[int]] = [[] for _ in range(size)]
    coming = [0] * size
    for a, b in ends.values():
        following[a].append(b)
        coming[b] += 1
    # Depth first from sources: an edge to a node that is still open closes a cycle.
    position = [0] * size
    state = [0] * size
    clock = size
    for start in sorted(range(size), key=lambda i: (coming[i] > 0, i)):
        if state[start]:
            continue
        state[start] = 1
        stack = [(start, iter(following[start]))]
        while stack:
            node, rest = stack[-1]
            for b in rest:
                if not state[b]:
                    state[b] = 1
                    stack.append((b, iter(following[b])))
                    break
            else:
                clock -= 1
                position[node] = clock
                stack.pop()
    # `position` is a topological order of the graph without the edges that lead back in it.
    part.layer = [0] * size
    forward = {e: (a, b) if position[a] <= position[b] else (b, a) for e, (a, b) in ends.items()}
    leaving: list[list[int]] = [[] for _ in range(size)]
    for a, b in forward.values():
        leaving[a].append(b)
    for a in sorted(range(size), key=lambda i: position[i]):
        for b in leaving[a]:
            part.layer[b] = max(part.layer[b], part.layer[a] + 1)
    _add_dummies(part, ends, forward)


def _take_layers(
    part: _Part, edges: Mapping[str, tuple[str, str]], layers: Mapping[str, int]
) -> None:
    """The layers that the caller wants; then the dummies."""
    number = {n: i for i, n in enumerate(part.names)}
    lowest = min(layers[n] for n in part.names)
    part.layer = [layers[n] - lowest for n in part.names]
    ends = {e: (number[a], number[b]) for e, (a, b) in edges.items()}
    forward = {
        e: (a, b) if part.layer[a] < part.layer[b] else (b, a)
        for e, (a, b) in ends.items()
        if part.layer[a] != part.layer[b]
    }
    _add_dummies(part, ends, forward)


def _add_dummies(
    part: _Part, ends: dict[str, tuple[int, int]], forward: dict[str, tuple[int, int]]
) -> None:
    size = len(part.names)
    part.down = [[] for _ in range(size)]
    part.up = [[] for _ in range(size)]
    chains: dict[tuple[int, int], list[int]] = {}
    spare = _MOST_DUMMIES
    for edge, (a, b) in forward.items():
        if a == b:
            continue
        if (a, b) not in chains:
            chain = []
            before = a
            between = range(part.layer[a] + 1, part.layer[b])
            if len(between) <= spare:
                spare -= len(between)
                for layer in between:
                    dummy = len(part.layer)
                    part.layer.append(layer)
                    part.widths.append(_DUMMY)
                    part.heights.append(_DUMMY)
                    part.down.append([])
                    part.up.append([before])
                    part.down[before].append(dummy)
                    chain.append(dummy)
                    before = dummy
            part.down[before].append(b)
            part.up[b].append(before)
            chains[a, b] = chain
        chain = chains[a, b]
        if chain:
            part.chains[edge] = chain if ends[edge] == (a, b) else chain[::-1]


def _sweeps(part: _Part) -> int:
    """How often order and positions are improved: less for parts that nobody can follow by eye."""
    return _SWEEPS if len(part.layer) < _MANY else _FEW_SWEEPS


def _order(part: _Part) -> None:
    """The order inside each layer, by barycentres of the neighbours, downwards and upwards in turn."""
    depth = max(part.layer) + 1
    part.layers = [[] for _ in range(depth)]
    for i, layer in enumerate(part.layer):
        part.layers[layer].append(i)
    rank = [0.0] * len(part.layer)
    for members in part.layers:
        for k, i in enumerate(members):
            rank[i] = float(k)
    for sweep in range(_sweeps(part)):
        downwards = sweep % 2 == 0
        sides = part.up if downwards else part.down
        for members in part.layers if downwards else reversed(part.layers):
            weight = {
                i: sum(rank[n] for n in sides[i]) / len(sides[i]) if sides[i] else rank[i]
                for i in members
            }
            # The default keeps the weights of this round.
            members.sort(key=lambda i, w=weight: (w[i], rank[i]))  # type: ignore[misc]
            for k, i in enumerate(members):
                rank[i] = float(k)


def _place(part: _Part) -> None:
    """x coordinates: first packed, then drawn towards the neighbours without changing the order."""
    part.x = [0.0] * len(part.layer)

    def space(a: int, b: int) -> float:
        wide = part.widths[a] > _DUMMY and part.widths[b] > _DUMMY
        gap = part.gap[0] if wide else part.gap[0] / 3
        return (part.widths[a] + part.widths[b]) / 2 + gap

    for members in part.layers:
        at = 0.0
        for k, i in enumerate(members):
            at += space(members[k - 1], i) if k else 0.0
            part.x[i] = at
        for i in members:
            part.x[i] -= at / 2
    for sweep in range(_sweeps(part)):
        downwards = sweep % 2 == 0
        sides = part.up if downwards else part.down
        for members in part.layers if downwards else reversed(part.layers):
            wish = [
                sum(part.x[n] for n in sides[i]) / len(sides[i]) if sides[i] else part.x[i]
                for i in members
            ]
            # Pushed to the right only, to the left only: the mean of both keeps the order and the gaps.
            right, left = list(wish), list(wish)
            for k in range(1, len(members)):
                right[k] = max(right[k], right[k - 1] + space(members[k - 1], members[k]))
            for k in range(len(members) - 2, -1, -1):
                left[k] = min(left[k], left[k + 1] - space(members[k], members[k + 1]))
            for k, i in enumerate(members):
                part.x[i] = (left[k] + right[k]) / 2


def _coordinates(part: _Part) -> tuple[list[Point], float, float]:
    """Points (the part's corner at 0, 0), and its height and width."""
    y, tops = 0.0, []
    for members in part.layers:
        height = max((part.heights[i] for i in members), default=0.0)
        tops.append(y + height / 2)
        y += height + part.gap[1]
    shift = min(x - w / 2 for x, w in zip(part.x, part.widths, strict=True))
    right = max(x + w / 2 for x, w in zip(part.x, part.widths, strict=True))
    points = [
        (round(x - shift), round(tops[layer])) for x, layer in zip(part.x, part.layer, strict=True)
    ]
    return [(float(a), float(b)) for a, b in points], y - part.gap[1], right - shift
