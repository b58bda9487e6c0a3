"""A layout of a cell that has too many states: what holds of a net that does more holds of the cell.

answer_of(looking, wider, part)             # answers.Layout

`wider` is the graph of a net that does all that the cell does, and more (`verify.controller.forgetting`): what is well
in all of its situations is well in all of the cell's. What is wrong in one of them may be nothing that the cell does.
So it is looked for in parts of the cell's own graph, breadth first and depth first; what is not found there is not
known. Proofs, and what they rest on, are in docs/reductions.md (*Geometry of large cells*).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from pn2code.geometry.answers import Layout, Move, Pair
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.look import Look
from pn2code.geometry.words import reason
from pn2code.verify.exploring.limits import Order

MOST_OF_PART = 60_000
"""States of a part of the cell's own graph."""
SUPPOSED = "so it is in a net that does more than the cell, and no run of the cell was found that leads there"
PartOf = Callable[[Order], CellGraph | None]


def answer_of(looking: Look, wider: CellGraph, part: PartOf) -> Layout:
    """All that is known.

    Args:
        looking: with the graph of the cell, as far as it is known.
        wider: that of the net that does more.
        part: a part of the cell's graph, in an order.
    """
    began = time.perf_counter()
    found = looking.situations(wider)
    seen = looking.seen(found)
    layout = replace(looking.layout_of(found, seen.moves, seen.pairs, began), is_wider=True)
    if found.sees:
        layout = replace(layout, open=layout.open or reason("sees"))
    if layout.answer == "yes":
        return layout
    moves: dict[tuple[str, ...], Move] = {}
    pairs: dict[tuple[object, ...], Pair] = {}
    wrong = {_which(m) for m in seen.moves if m.answer == "no"}
    touching = {_which_pair(p) for p in seen.pairs if p.answer == "no"}
    for order in Order:
        if wrong <= moves.keys() and touching <= pairs.keys():
            break
        graph = part(order)
        if graph is not None and graph.arcs:
            shown = looking.seen(looking.situations(graph))
            moves = {_which(m): m for m in shown.moves if m.answer == "no"} | moves
            pairs = {_which_pair(p): p for p in shown.pairs if p.answer == "no"} | pairs
    found_moves = tuple(m if m.answer == "yes" else _supposed(m, moves) for m in seen.moves)
    found_pairs = tuple(_supposed_pair(p, pairs) for p in seen.pairs)
    return replace(
        layout,
        moves=(*found_moves, *moves.values()),
        pairs=(*found_pairs, *pairs.values()),
        queries=looking.comparison.sweeper.queries,
        seconds=time.perf_counter() - began,
    )


def _which(move: Move) -> tuple[str, ...]:
    return move.robot, move.transition, move.command, move.begins


def _which_pair(pair: Pair) -> tuple[object, ...]:
    return pair.robots, pair.transitions, pair.doing


def _supposed(move: Move, known: dict[tuple[str, ...], Move]) -> Move:
    """What is known of a move that is not well in the net that does more; it is taken from what is known."""
    if _which(move) in known:
        return known.pop(_which(move))
    if move.answer == "unknown":
        return move
    return replace(move, answer="unknown", problem=f"{move.problem}; {SUPPOSED}")


def _supposed_pair(pair: Pair, known: dict[tuple[object, ...], Pair]) -> Pair:
    """The same of two that do not surely keep apart."""
    if _which_pair(pair) in known:
        return known.pop(_which_pair(pair))
    if pair.answer == "unknown":
        return pair
    return replace(pair, answer="unknown", says=f"{pair.says}; {SUPPOSED}")
