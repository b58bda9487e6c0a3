"""Büchi automata of formulas: on random graphs they accept where the judge's tableau finds a path, on random lassos
where the formula holds by definition; and they are small."""

from __future__ import annotations

from itertools import pairwise
from random import Random
from typing import TypeVar

import pytest

from pn2code.properties.judge import Graph
from pn2code.properties.judge_ltl import (
    NO_STEP,
    Lasso,
    Position,
    atom,
    holds_on,
    positions,
    some_path,
)
from pn2code.properties.ltl import Automaton, automaton
from pn2code.properties.ltl_expansion import TooLargeError
from pn2code.properties.meaning import TRUE, Atom, Fairness, Formula, Op
from pn2code.properties.questions import expanded

P, Q, R = (Atom("pred", i) for i in range(3))
S, T = Atom("fires", 0), Atom("fires", 1)

X = TypeVar("X")


def random_graph(r: Random, nodes: int) -> Graph:
    arcs = {
        (r.randrange(nodes), r.randrange(2), r.randrange(nodes))
        for _ in range(r.randint(1, 2 * nodes))
    }
    holds = tuple(frozenset(n for n in range(nodes) if r.random() < 0.5) for _ in range(3))
    return Graph((0.0,) * nodes, tuple(sorted(arcs)), holds)


def random_formula(r: Random, depth: int) -> Formula:
    if depth == 0 or r.random() < 0.15:
        return r.choice([P, Q, R, S, T, Atom("dead"), TRUE])
    operator = r.choice(
        ["not", "and", "or", "implies", "iff", "X", "F", "G", "U", "R", "W", "F", "G"]
    )
    count = 1 if operator in ("not", "X", "F", "G") else 2
    return Op(operator, tuple(random_formula(r, depth - 1) for _ in range(count)))


def accepts(graph: Graph, found: Automaton, at: list[Position], loop: int) -> bool:
    """Whether the automaton accepts a lasso: a cycle through an accepting state in the product."""
    steps: dict[tuple[int, int], set[tuple[int, int]]] = {}
    for i, position in enumerate(at):
        after = i + 1 if i + 1 < len(at) else loop
        for arc in found.arcs:
            if all(atom(graph, what, position) == positive for positive, what in arc.literals):
                steps.setdefault((i, arc.source), set()).add((after, arc.target))
    return _has_cycle(steps, {(0, 0)}, {s for s in steps if s[1] in found.accepting})


def accepts_some(graph: Graph, found: Automaton) -> bool:
    steps: dict[tuple[Position, int], set[tuple[Position, int]]] = {}
    every = positions(graph)
    for position in every:
        following = [x for x in every if x.node == position.target]
        for arc in found.arcs:
            if all(atom(graph, what, position) == positive for positive, what in arc.literals):
                steps.setdefault((position, arc.source), set()).update(
                    (x, arc.target) for x in following
                )
    start = {(x, 0) for x in every if x.node == 0}
    return _has_cycle(steps, start, {s for s in steps if s[1] in found.accepting})


def _has_cycle(steps: dict[X, set[X]], start: set[X], accepting: set[X]) -> bool:
    def reached(todo: set[X]) -> set[X]:
        seen, stack = set(todo), list(todo)
        while stack:
            for x in steps.get(stack.pop(), ()):
                if x not in seen:
                    seen.add(x)
                    stack.append(x)
        return seen

    return any(s in reached(steps.get(s, set())) for s in accepting & reached(start))


@pytest.mark.parametrize("seed", range(4))
def test_automata_and_tableau_agree(seed: int) -> None:
    r = Random(seed)
    seen = set()
    for _ in range(25):
        graph = random_graph(r, r.randint(1, 4))
        formula = random_formula(r, r.randint(1, 3))
        negated = r.random() < 0.5
        expected = some_path(graph, Op("not", (formula,)) if negated else formula)
        assert accepts_some(graph, automaton(formula, negated=negated)) == expected, formula
        seen.add(expected)
    assert seen == {True, False}


@pytest.mark.parametrize("seed", range(4))
def test_automata_and_lassos_agree(seed: int) -> None:
    r = Random(1000 + seed)
    seen = set()
    for _ in range(60):
        graph = random_graph(r, r.randint(1, 5))
        formula = random_formula(r, r.randint(1, 4))
        at = [r.choice([x for x in positions(graph) if x.node == 0])] if positions(graph) else []
        while at and (at[-1].step != NO_STEP or len(at) == 1) and len(at) < 9:
            at.append(r.choice([x for x in positions(graph) if x.node == at[-1].target]))
        loop = next((i for i, x in enumerate(at) if x.node == at[-1].target), None)
        if loop is None:
            continue
        try:
            automaton(formula), automaton(formula, negated=True)
        except TooLargeError:
            continue  # formulas of this kind are for nobody
        path = Lasso(tuple(at), loop)
        expected = holds_on(graph, formula, path)
        assert accepts(graph, automaton(formula), at, loop) == expected, formula
        assert accepts(graph, automaton(formula, negated=True), at, loop) != expected, formula
        seen.add(expected)
    assert seen == {True, False}


def op(operator: str, *parts: Formula) -> Formula:
    return Op(operator, parts)


@pytest.mark.parametrize(
    ("formula", "states"),
    [
        (op("G", P), 2),
        (op("F", P), 1),
        (op("G", op("F", P)), 2),
        (op("F", op("G", P)), 2),
        (op("F", op("F", op("G", op("F", op("G", P))))), 2),
        (op("G", op("implies", P, op("F", Q))), 2),
        (op("G", op("implies", S, op("X", op("F", T)))), 2),
        (op("U", P, Q), 2),
        (op("W", op("not", P), Q), 2),
        (op("and", S, T), 2),
        (op("implies", op("G", op("F", P)), op("G", op("F", Q))), 3),
        (TRUE, 1),
    ],
)
def test_automata_of_violations_are_small(formula: Formula, states: int) -> None:
    assert automaton(formula, negated=True).states == states


def test_no_step_is_two_steps() -> None:
    """`fires(a) && fires(b)` of different transitions: the empty automaton."""
    assert automaton(op("and", S, T)) == Automaton(1, (), ())
    assert automaton(op("not", TRUE)) == Automaton(1, (), ())


def test_conditions_on_a_node_are_one() -> None:
    whole = op("iff", op("and", P, op("not", Q)), op("or", R, Atom("dead")))
    found = automaton(op("G", whole))
    assert [arc.literals for arc in found.arcs] == [((True, whole),)]


def test_too_large() -> None:
    each = [
        op("F", op("and", Atom("pred", i), op("X", op("F", Atom("pred", 50 + i)))))
        for i in range(14)
    ]
    formula = each[0]
    for x in each[1:]:
        formula = op("and", formula, x)
    with pytest.raises(TooLargeError):
        automaton(formula)


def test_fairness() -> None:
    """Nodes 0 <-> 1 by 0 for ever, though 1 leads from 1 to 2."""
    graph = Graph((0.0,) * 3, ((0, 0, 1), (1, 0, 0), (1, 1, 2)), (frozenset({2}),))
    never = op("G", op("not", P))
    assert some_path(graph, never)
    assert some_path(graph, never, [Fairness(False, 1)])  # it is not enabled all the time
    assert not some_path(graph, never, [Fairness(True, 1)])
    both = Graph((0.0,) * 3, ((0, 0, 1), (1, 0, 0), (1, 1, 2), (0, 1, 2)), (frozenset({2}),))
    assert not some_path(both, never, [Fairness(False, 1)])
    away = Graph((0.0,) * 3, ((0, 0, 1), (1, 0, 0), (1, 1, 2), (0, 0, 0)), (frozenset({2}),))
    assert some_path(away, never, [Fairness(True, 1)])  # by staying where it is not enabled


def test_lassos_by_definition() -> None:
    graph = Graph((0.0,) * 2, ((0, 0, 1), (1, 1, 1)), (frozenset({0}), frozenset({1})))
    path = Lasso((Position(0, 0, 1), Position(1, 1, 1)), 1)
    for formula, expected in (
        (op("U", P, Q), True),
        (op("G", P), False),
        (op("F", op("G", Q)), True),
        (op("X", T), True),
        (op("R", Q, op("or", P, Q)), True),
        (op("R", P, Q), False),
        (op("W", P, R), False),
    ):
        if R not in (formula.parts if isinstance(formula, Op) else ()):
            assert holds_on(graph, formula, path) == expected, formula
    assert all(a.target == b.node for a, b in pairwise(path.positions))


@pytest.mark.parametrize("seed", range(3))
def test_what_the_explorer_does_not_know_is_said_otherwise(seed: int) -> None:
    """Weak until, release and implications by operators that it knows: at the same nodes, by the judge."""
    r = Random(2000 + seed)
    for _ in range(60):
        graph = random_graph(r, r.randint(1, 6))
        a, b = (
            Op("EX", (r.choice([P, Q, R]),)) if r.random() < 0.3 else r.choice([P, Q, R])
            for _ in "ab"
        )
        for operator in ("AW", "EW", "AR", "ER", "implies", "iff"):
            formula = Op(operator, (a, b))
            assert graph.nodes(expanded(formula)) == graph.nodes(formula), formula
