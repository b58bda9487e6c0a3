"""Linear temporal logic by the judge: a declarative tableau over the graph, and formulas on one lasso.

A *position* of a path is a node with the step that is taken there (at a dead node none, for ever). For each operator of
time in the formula a position guesses whether its formula holds at the next one. What a formula is worth at a position
then follows by its definition; a guess is right if the next position agrees, and if no `U` is put off for ever. So a
path on which the formula holds is a cycle of the positions with guesses where all agree (Lichtenstein and Pnueli 1985).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING

from pn2code.base.frozen import frozen
from pn2code.properties import meaning as m

if TYPE_CHECKING:
    from pn2code.properties.judge import Graph

TEMPORAL = ("X", "F", "G", "U", "R", "W")
NO_STEP = -1

Guess = tuple[bool, ...]


@frozen
class Position:
    """A node, the transition taken there (`NO_STEP`: none), and the node after it."""

    node: int
    step: int
    target: int


def positions(graph: Graph) -> list[Position]:
    """All of a graph."""
    moving = [Position(*arc) for arc in graph.arcs]
    return moving + [Position(n, NO_STEP, n) for n in sorted(graph.dead)]


def atom(graph: Graph, f: m.Formula, at: Position) -> bool:
    """What holds at a position whatever comes after."""
    if isinstance(f, m.Atom) and f.kind == "fires":
        return at.step == f.number
    return at.node in graph.nodes(f)


# --- all paths -------------------------------------------------------------------------------------


def some_path(graph: Graph, formula: m.Formula, fair: Sequence[m.Fairness] = ()) -> bool:
    """Whether a formula holds on some maximal fair path from the initial node."""
    return _Tableau(graph, formula, fair).is_satisfied()


State = tuple[Position, Guess]


class _Tableau:
    def __init__(self, graph: Graph, formula: m.Formula, fair: Sequence[m.Fairness]) -> None:
        self.graph = graph
        self.formula = formula
        self.fair = fair
        self.guessed = list(dict.fromkeys(_temporal(formula)))
        self.enabled = {x.transition: graph.enabled(x.transition) for x in fair}

    def value(self, f: m.Formula, at: Position, guess: Guess) -> bool:
        if isinstance(f, m.Atom):
            return atom(self.graph, f, at)
        parts = [self.value(x, at, guess) for x in f.parts]
        a, b = parts[0], parts[-1]
        later = f.operator in TEMPORAL and guess[self.guessed.index(f)]
        match f.operator:
            case "not":
                return not a
            case "and":
                return a and b
            case "or":
                return a or b
            case "implies":
                return not a or b
            case "iff":
                return a == b
            case "X":
                return later
            case "F":
                return a or later
            case "G":
                return a and later
            case "U" | "W":
                return b or (a and later)
            case "R":
                return b and (a or later)
            case other:
                raise AssertionError(other)

    def promised(self, f: m.Op) -> m.Formula:
        """The formula that is guessed to hold at the next position, or not."""
        return f.parts[0] if f.operator == "X" else f

    def is_settled(self, f: m.Op, at: Position, guess: Guess) -> bool:
        """What must be the case infinitely often, so that the guesses about `f` are not put off for ever."""
        a, b = (self.value(x, at, guess) for x in (f.parts[0], f.parts[-1]))
        own = self.value(f, at, guess)
        match f.operator:
            case "F" | "U":
                return b or not own
            case "G" | "R":
                return not b or own
            case "W":
                return (not a and not b) or own
            case _:
                return True

    def is_satisfied(self) -> bool:
        by_node: dict[int, dict[Guess, list[State]]] = {}
        start: list[State] = []
        for at in positions(self.graph):
            found = by_node.setdefault(at.node, {})
            for guess in product((False, True), repeat=len(self.guessed)):
                promise = tuple(self.value(self.promised(f), at, guess) for f in self.guessed)
                found.setdefault(promise, []).append((at, guess))
                if at.node == 0 and self.value(self.formula, at, guess):
                    start.append((at, guess))
        number: dict[State, int] = {s: i for i, s in enumerate(start)}
        states = list(start)
        edges: list[tuple[int, int]] = []
        for state in states:
            at, guess = state
            for other in by_node[at.target].get(guess, ()):
                if other not in number:
                    number[other] = len(states)
                    states.append(other)
                edges.append((number[state], number[other]))
        return any(self.accepts(states, edges, part) for part in _cyclic(range(len(states)), edges))

    def accepts(
        self, states: Sequence[State], edges: Sequence[tuple[int, int]], part: frozenset[int]
    ) -> bool:
        """Whether a fair path stays in a strongly connected part."""
        for f in self.guessed:
            if not any(self.is_settled(f, *states[s]) for s in part):
                return False
        for x in self.fair:
            occurs = any(states[s][0].step == x.transition for s in part)
            able = frozenset(s for s in part if states[s][0].node in self.enabled[x.transition])
            if occurs or not able:
                continue
            if not x.strong:
                if able == part:
                    return False
                continue
            # It must not be enabled any more: a path may stay in what is left.
            left = part - able
            inside = [(a, b) for a, b in edges if a in left and b in left]
            return any(self.accepts(states, inside, p) for p in _cyclic(sorted(left), inside))
        return True


def _temporal(f: m.Formula) -> Iterator[m.Op]:
    if isinstance(f, m.Op):
        for part in f.parts:
            yield from _temporal(part)
        if f.operator in TEMPORAL:
            yield f


def _cyclic(nodes: Sequence[int], edges: Sequence[tuple[int, int]]) -> Iterator[frozenset[int]]:
    """The strongly connected components that have a cycle."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    if not edges:
        return
    index = {n: i for i, n in enumerate(nodes)}
    rows, columns = [index[a] for a, _ in edges], [index[b] for _, b in edges]
    matrix = coo_array(([1] * len(edges), (rows, columns)), shape=(len(nodes), len(nodes)))
    _, label = connected_components(matrix.tocsr(), directed=True, connection="strong")
    own = {int(label[index[a]]) for a, b in edges if label[index[a]] == label[index[b]]}
    parts: dict[int, set[int]] = {}
    for n, i in index.items():
        if int(label[i]) in own:
            parts.setdefault(int(label[i]), set()).add(n)
    yield from map(frozenset, parts.values())


# --- one path --------------------------------------------------------------------------------------


@frozen
class Lasso:
    """A path: positions, and the one that comes after the last."""

    positions: tuple[Position, ...]
    loop: int

    def after(self, i: int) -> int:
        """The position after one."""
        return i + 1 if i + 1 < len(self.positions) else self.loop


def holds_on(graph: Graph, f: m.Formula, path: Lasso) -> bool:
    """Whether a formula holds on a lasso: by its definition, position by position."""
    return _worth(graph, f, path)[0]


def _worth(graph: Graph, f: m.Formula, path: Lasso) -> list[bool]:
    every = range(len(path.positions))
    if isinstance(f, m.Atom):
        return [atom(graph, f, at) for at in path.positions]
    parts = [_worth(graph, x, path) for x in f.parts]
    a, b = parts[0], parts[-1]

    def future(i: int) -> Iterator[int]:
        """This position and all after it, each once."""
        seen: set[int] = set()
        while i not in seen:
            seen.add(i)
            yield i
            i = path.after(i)

    def until(i: int) -> bool:
        for j in future(i):
            if b[j]:
                return True
            if not a[j]:
                return False
        return False

    match f.operator:
        case "not":
            return [not x for x in a]
        case "and":
            return [x and y for x, y in zip(a, b, strict=True)]
        case "or":
            return [x or y for x, y in zip(a, b, strict=True)]
        case "implies":
            return [not x or y for x, y in zip(a, b, strict=True)]
        case "iff":
            return [x == y for x, y in zip(a, b, strict=True)]
        case "X":
            return [a[path.after(i)] for i in every]
        case "F":
            return [any(a[j] for j in future(i)) for i in every]
        case "G":
            return [all(a[j] for j in future(i)) for i in every]
        case "U":
            return [until(i) for i in every]
        case "W":
            return [until(i) or all(a[j] for j in future(i)) for i in every]
        case "R":  # q up to and with the first p, or for ever
            return [
                all(b[j] or any(a[k] for k in _before(future(i), j)) for j in future(i))
                for i in every
            ]
        case other:
            raise AssertionError(other)


def _before(path: Iterator[int], end: int) -> Iterator[int]:
    for i in path:
        if i == end:
            return
        yield i


def is_fair(graph: Graph, fair: Sequence[m.Fairness], path: Lasso) -> bool:
    """Whether a lasso keeps to what is assumed."""
    cycle = path.positions[path.loop :]
    for x in fair:
        able = [at.node in graph.enabled(x.transition) for at in cycle]
        occurs = any(at.step == x.transition for at in cycle)
        if (any(able) if x.strong else all(able)) and not occurs:
            return False
    return True
