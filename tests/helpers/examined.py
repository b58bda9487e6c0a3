"""All examinations of a net with what its whole graph says of them."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

from helpers.random_linear import holds, random_linear, temporal_parts
from helpers.random_tables import Graph, random_branching, random_condition
from pn2code.contest.engine import Space
from pn2code.contest.examinations import Asked, Part, asked
from pn2code.contest.formulas import Fireable, Formula, Op, Tokens
from pn2code.contest.tables import Tables
from pn2code.contest.words import GLOBAL

FORMULAS = 6
"""Of each kind."""
MOST_PARTS = 3


def examined(
    draw: random.Random, graph: Graph, tables: Tables | None = None
) -> tuple[list[Asked], dict[str, bool | int]]:
    """Lines with what is to be said of them.

    Args:
        draw: for the formulas.
        graph: of the net.
        tables: the net as the tool has read it; None: as it was made.
    """
    own = graph.tables
    tables = own if tables is None else tables
    expected: dict[str, bool | int] = {**truths(graph)}
    lines: list[Asked] = []
    for name in GLOBAL:
        lines += asked(tables, name, Path())
    for number, (kind, f) in enumerate(questions(draw, own)):
        lines.append(Asked(str(number), formula=f, kind=kind))
        expected[str(number)] = holds(graph, f) if kind == "ltl" else 0 in graph.where(f)
    for p in own.places:
        lines.append(bound(tables, p))
        expected[p] = max(sum(m[i] for i in own.places[p]) for m in graph.markings)
    return lines, expected


def sizes(found: Space | None) -> tuple[int, int, int, int]:
    """What an engine says of the sizes of a graph, as `Graph.sizes` has them."""
    assert found is not None
    return found.states, found.arcs, found.tokens_in_place, found.tokens_in_marking


def truths(graph: Graph) -> dict[str, bool]:
    """What the examinations without formulas say."""
    tables = graph.tables
    totals = [
        [sum(m[p] for p in places) for m in graph.markings] for places in tables.places.values()
    ]
    can = [graph.where(Op("E", (Op("F", (fireable(t),)),))) for t in tables.transitions]
    everywhere = len(graph.markings)
    return {
        "ReachabilityDeadlock": any(not s for s in graph.successors),
        "OneSafe": all(max(total) <= 1 for total in totals),
        "StableMarking": any(len(set(total)) == 1 for total in totals),
        "QuasiLiveness": all(0 in where for where in can),
        "Liveness": all(len(where) == everywhere for where in can),
    }


def fireable(name: str) -> Formula:
    """That a transition is enabled."""
    return Fireable((name,))


def questions(draw: random.Random, tables: Tables) -> Iterator[tuple[str, Formula]]:
    """Random formulas of all kinds."""
    for _ in range(FORMULAS):
        path, operator = draw.choice(["EF", "AG"])
        yield "ctl", Op(path, (Op(operator, (random_condition(draw, tables),)),))
        yield "ctl", random_branching(draw, tables, 3)
        while True:
            f = random_linear(draw, tables, 3)
            if len(temporal_parts(f)) <= MOST_PARTS:
                break
        yield "ltl", Op("A", (f,))


def bound(tables: Tables, place: str) -> Asked:
    """The question for the most tokens of a place."""
    return Asked(place, (Part("bound", tables.bound(0, Tokens((place,))).split(" ", 1)[1]),))
