"""Random formulas of linear time, and whether they hold, worked out in Python from the whole graph.

Nothing of the automata of the tool is used: a state says which parts of the formula hold from here on (Lichtenstein,
Pnueli 1985), and a fair strongly connected component of markings with such states is a run.
"""

from __future__ import annotations

import random
from itertools import product

from helpers.random_tables import Graph, random_condition
from pn2code.contest.formulas import Formula, Op, Truth
from pn2code.contest.rewriting import is_plain
from pn2code.contest.tables import Tables


def random_linear(
    draw: random.Random, tables: Tables, depth: int = 3, operators: str = "XFGU"
) -> Formula:
    """A formula about a path."""
    kind = draw.randrange(12) if depth else 0
    if kind < 2:
        return random_condition(draw, tables, 1)
    if kind == 2:
        return Op("not", (random_linear(draw, tables, depth - 1, operators),))
    if kind < 5:
        parts = tuple(random_linear(draw, tables, depth - 1, operators) for _ in range(2))
        return Op("and" if kind == 3 else "or", parts)
    operator = draw.choice(operators)
    parts = tuple(
        random_linear(draw, tables, depth - 1, operators) for _ in range(1 + (operator == "U"))
    )
    return Op(operator, parts)


def holds(graph: Graph, f: Formula) -> bool:
    """Whether a formula, or several of all paths joined, holds in the initial marking."""
    match f:
        case Truth(value):
            return value
        case Op("not", (p,)):
            return not holds(graph, p)
        case Op("and", parts) if not is_plain(f):
            return all(holds(graph, p) for p in parts)
        case Op("or", parts) if not is_plain(f):
            return any(holds(graph, p) for p in parts)
        case Op("A", (p,)):
            return not _exists(graph, Op("not", (p,)))
    return 0 in graph.where(f)


def temporal_parts(f: Formula) -> list[Op]:
    """Those that begin with an operator of time."""
    if is_plain(f):
        return []
    assert isinstance(f, Op)
    own = [f] if f.operator in "XFGU" else []
    return list(dict.fromkeys([*own, *(x for p in f.parts for x in temporal_parts(p))]))


Node = tuple[int, tuple[bool, ...]]


def _exists(graph: Graph, f: Formula) -> bool:
    """Whether a run satisfies a formula."""
    parts = temporal_parts(f)
    index = {p: i for i, p in enumerate(parts)}
    where: dict[Formula, set[int]] = {}

    def value(g: Formula, node: Node) -> bool:
        if is_plain(g):
            if g not in where:
                where[g] = graph.where(g)
            return node[0] in where[g]
        if g in index:  # type: ignore[comparison-overlap]
            return node[1][index[g]]  # type: ignore[index]
        assert isinstance(g, Op)
        if g.operator == "not":
            return not value(g.parts[0], node)
        return (all if g.operator == "and" else any)(value(p, node) for p in g.parts)

    guesses = list(product((False, True), repeat=len(parts)))

    def follows(node: Node, after: Node) -> bool:
        for part in parts:
            now, then = value(part, node), value(part, after)
            match part:
                case Op("X", (p,)):
                    wanted = value(p, after)
                case Op("F", (p,)):
                    wanted = value(p, node) or then
                case Op("G", (p,)):
                    wanted = value(p, node) and then
                case Op(_, (p, q)):
                    wanted = value(q, node) or (value(p, node) and then)
                case _:
                    raise AssertionError(part)
            if now != wanted:
                return False
        return True

    def fair(component: list[Node]) -> bool:
        for part in parts:
            match part:
                case Op("F", (p,)):
                    done = any(not value(part, n) or value(p, n) for n in component)
                case Op("G", (p,)):
                    done = any(value(part, n) or not value(p, n) for n in component)
                case Op("U", (_, q)):
                    done = any(not value(part, n) or value(q, n) for n in component)
                case _:
                    done = True
            if not done:
                return False
        return True

    known: dict[Node, list[Node]] = {}

    def successors(node: Node) -> list[Node]:
        if node not in known:
            found = [(m, g) for m in sorted(set(graph.next(node[0]))) for g in guesses]
            known[node] = [n for n in found if follows(node, n)]
        return known[node]

    starts = [(0, g) for g in guesses if value(f, (0, g))]
    return any(fair(c) for c in _components(starts, successors))


def _components(starts, successors):  # type: ignore[no-untyped-def]
    """The strongly connected components with an arc inside."""
    index: dict[Node, int] = {}
    low: dict[Node, int] = {}
    open_: dict[Node, None] = {}
    for root in starts:
        if root in index:
            continue
        index[root] = low[root] = len(index)
        open_[root] = None
        stack = [(root, iter(successors(root)))]
        while stack:
            node, rest = stack[-1]
            for after in rest:
                if after not in index:
                    index[after] = low[after] = len(index)
                    open_[after] = None
                    stack.append((after, iter(successors(after))))
                    break
                if after in open_:
                    low[node] = min(low[node], index[after])
            else:
                stack.pop()
                if stack:
                    low[stack[-1][0]] = min(low[stack[-1][0]], low[node])
                if low[node] == index[node]:
                    component = []
                    while True:
                        last, _ = open_.popitem()
                        component.append(last)
                        if last == node:
                            break
                    if len(component) > 1 or node in successors(node):
                        yield component
