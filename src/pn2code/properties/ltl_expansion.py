"""What a formula asks of the node that a path is at, and of what follows: a graph of sets of formulas (Couvreur)."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.base.frozen import frozen, record
from pn2code.properties.ltl_forms import TRUE, Forms
from pn2code.properties.meaning import Atom

MOST_STATES = 2_000
"""States of an automaton; formulas of people have a dozen."""
MOST_EDGES = 5_000
"""Edges out of a state before equal ones are one."""


class TooLargeError(Exception):
    """The automaton of a formula gets too many states."""


Label = frozenset[int]
"""Literals, by number of their form."""
State = frozenset[int]


@frozen
class _Edge:
    """An edge of the automaton: what must be seen now, what must hold next, what is postponed."""

    label: Label
    target: State
    postponed: frozenset[int]

    def covers(self, other: _Edge) -> bool:
        """Whether it asks for no more than another."""
        return (
            self.label <= other.label
            and self.target <= other.target
            and self.postponed <= other.postponed
        )


@record
class Graph:
    """States 0, 1, ..; of each its edges with the number of their target."""

    edges: list[list[tuple[Label, int, frozenset[int]]]]
    conditions: tuple[int, ...]


def expanded(forms: Forms, formula: int) -> Graph:
    """The graph of a formula, by its number; states with the same edges are one.

    Raises:
        TooLargeError: it has more than `MOST_STATES` states.
    """
    start: State = frozenset({formula} - {TRUE})
    numbers = {start: 0}
    order = [start]
    edges: list[list[tuple[Label, int, frozenset[int]]]] = []
    for state in order:
        own = []
        for edge in _edges(forms, state):
            if edge.target not in numbers:
                if len(order) >= MOST_STATES:
                    raise TooLargeError
                numbers[edge.target] = len(order)
                order.append(edge.target)
            own.append((edge.label, numbers[edge.target], edge.postponed))
        edges.append(own)
    conditions = sorted({u for own in edges for _, _, postponed in own for u in postponed})
    return _merged(Graph(edges, tuple(conditions)))


def _edges(forms: Forms, state: State) -> list[_Edge]:
    """All edges from a set of obligations; none covers another."""
    found: dict[_Edge, None] = {}
    none: frozenset[int] = frozenset()
    start = (state, none, none, none)
    seen = {start}
    stack = [start]

    def push(*edges: tuple[frozenset[int], frozenset[int], State, frozenset[int]]) -> None:
        for edge in edges:
            if edge not in seen:
                seen.add(edge)
                stack.append(edge)

    # What is left to look at, what holds by now, what must hold next, what is postponed.
    while stack:
        todo, done, later, postponed = stack.pop()
        if len(seen) > MOST_EDGES:
            raise TooLargeError
        if not todo:
            label = frozenset(x for x in done if forms.forms[x][0] == "lit")
            found[_Edge(label, later, postponed)] = None
            continue
        number = min(todo, key=lambda x: (forms.forms[x][0] in ("or", "U", "R"), x))
        rest, now = todo - {number}, done | {number}
        match forms.forms[number]:
            case ("true",):
                push((rest, now, later, postponed))
            case ("lit", *_):
                if not any(_excludes(forms, number, x) for x in done):
                    push((rest, now, later, postponed))
            case ("and", int(a), int(b)):
                push((rest | ({a, b} - now), now, later, postponed))
            case ("or", int(a), int(b)):
                choices = (now,) if {a, b} & now else ({b}, {a})
                push(*((rest | (x - now), now, later, postponed) for x in choices))
            case ("X", int(a)):
                push((rest, now, later | {a}, postponed))
            case ("U", int(a), int(b)):
                if b not in now:
                    again = (later | {number}, postponed | {number})
                    push((rest | ({a} - now), now, *again))
                push((rest | ({b} - now), now, later, postponed))
            case ("R", int(a), int(b)):
                if a not in now:
                    push((rest | ({b} - now), now, later | {number}, postponed))
                push((rest | ({a, b} - now), now, later, postponed))
            case _:
                pass  # false: no way
    return _least(list(found))


def _excludes(forms: Forms, a: int, b: int) -> bool:
    """Whether two literals cannot hold together: opposites, or two different steps."""
    x, y = forms.forms[a], forms.forms[b]
    if y[0] != "lit":
        return False
    if x[2] == y[2]:
        return x[1] != y[1]
    steps = all(isinstance(w, Atom) and w.kind == "fires" for w in (x[2], y[2]))
    return steps and x[1] is True and y[1] is True


def _least(found: Sequence[_Edge]) -> list[_Edge]:
    kept: list[_Edge] = []
    for edge in dict.fromkeys(found):
        if not any(other.covers(edge) for other in kept):
            kept = [x for x in kept if not edge.covers(x)] + [edge]
    return kept


def _merged(graph: Graph) -> Graph:
    """States with equal edges as one, as long as there are any."""
    while True:
        first: dict[frozenset[tuple[Label, int, frozenset[int]]], int] = {}
        new = [first.setdefault(frozenset(own), len(first)) for own in graph.edges]
        if len(first) == len(graph.edges):
            return graph
        edges: list[list[tuple[Label, int, frozenset[int]]]] = [[] for _ in first]
        for state, own in enumerate(graph.edges):
            if not edges[new[state]]:
                edges[new[state]] = list(dict.fromkeys((x, new[to], p) for x, to, p in own))
        graph = Graph(edges, graph.conditions)
