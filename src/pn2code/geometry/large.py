"""A layout of a cell that has too many states: what holds of a net that does more holds of the cell.

answer_of(looking, wider, part)             # answers.Layout

`wider` is the graph of a net that does all that the cell does, and more (`verify.controller.forgetting`): what is well
in all of its situations is well in all of the cell's. What is wrong in one of them may be nothing that the cell does.
So it is looked for in parts of the cell's own graph, breadth first and depth first; what is not found there is not
known. Proofs, and what they rest on, are in docs/reductions.md (*Geometry of large cells*).

Where no such net helps, parts of the cell's own graph are all there is:

sought_in(looking, why, part)               # answers.Layout, with `open`: never "yes", and a "no" has its run
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TypeVar

from pn2code.cell.partition import SUPERVISOR
from pn2code.geometry.answers import Layout, Move, Pair, Verdict
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.look import Look
from pn2code.geometry.words import reason
from pn2code.verify.exploring.limits import Order

MOST_OF_PART = 60_000
"""States of a part of the cell's own graph."""
SUPPOSED = "so it is in a net that does more than the cell, and no run of the cell was found that leads there"
MOST_NAMED = 4
"""Transitions in a sentence."""
PartOf = Callable[[Order, int], CellGraph | None]
"""A part of the cell's graph, in an order; of depth first with a number that tells the order of successors."""
WAYS = ((Order.BREADTH, 0), (Order.DEPTH, 0), (Order.DEPTH, 1), (Order.DEPTH, 2))
"""The parts in which something wrong is sought: next to the start, and along runs in three orders."""


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
        graph = part(order, 0)
        if graph is not None and graph.arcs:
            shown = looking.seen(looking.situations(graph))
            moves = {_which(m): m for m in shown.moves if m.answer == "no"} | moves
            pairs = {_which_pair(p): p for p in shown.pairs if p.answer == "no"} | pairs
            looking.progress.keep(moves.values(), pairs.values())
    found_moves = tuple(m if m.answer == "yes" else _supposed(m, moves) for m in seen.moves)
    found_pairs = tuple(_supposed_pair(p, pairs) for p in seen.pairs)
    return replace(
        layout,
        moves=(*found_moves, *moves.values()),
        pairs=(*found_pairs, *pairs.values()),
        queries=looking.comparison.sweeper.queries,
        seconds=time.perf_counter() - began,
    )


def sought_in(looking: Look, why: str, part: PartOf) -> Layout | None:
    """What parts of the cell's graph show where not all of it is known; None: there is no part.

    A move or pair that is wrong in a state of the cell is wrong. All else is open: what is well in some states may be
    wrong in others.

    Args:
        looking: of the layout.
        why: why the graph is not known, as a clause.
        part: a part of the cell's graph.
    """
    began = time.perf_counter()
    layout: Layout | None = None
    moves: dict[tuple[str, ...], Move] = {}
    pairs: dict[tuple[object, ...], Pair] = {}
    told: set[int] = set()
    sizes: list[int] = []
    for order, shuffle in WAYS:
        graph = part(order, shuffle)
        if graph is None or not graph.arcs:
            continue
        found = looking.situations(graph)
        seen = looking.seen(found)
        told |= {graph.elements[e].transition for _, e in found.activities if e >= 0}
        sizes.append(len(graph.arcs))
        _note_worst(moves, ((_which(m), m) for m in seen.moves))
        _note_worst(pairs, ((_which_pair(p), p) for p in seen.pairs))
        own = looking.layout_of(found, (), (), began)
        if layout is None:
            layout = own
        layout = replace(
            layout,
            states=max(layout.states, own.states),
            situations=max(layout.situations, own.situations),
            stopped=layout.stopped or own.stopped,
            open_at=layout.open_at or own.open_at,
        )
        looking.progress.keep(moves.values(), pairs.values())
        looking.keep_runs([*moves.values(), *pairs.values(), *layout.open_at])
        if not graph.why:
            break  # that was all of it
    if layout is None:
        return None
    return replace(
        layout,
        moves=tuple(moves.values()),
        pairs=tuple(pairs.values()),
        looked=looking.comparison.compared,
        queries=looking.comparison.sweeper.queries,
        open=f"{why}. {_how_far(looking, sizes, told)}",
        nearest=None,
        seconds=time.perf_counter() - began,
    )


_Key = TypeVar("_Key")
_Row = TypeVar("_Row", Move, Pair)
_RANK: dict[Verdict, int] = {"no": 0, "unknown": 1, "yes": 2}


def _note_worst(known: dict[_Key, _Row], more: Iterable[tuple[_Key, _Row]]) -> None:
    """Keeps of each the worst that was seen, the first of equal ones."""
    for key, row in more:
        if key not in known or _RANK[row.answer] < _RANK[known[key].answer]:
            known[key] = row


def _how_far(looking: Look, sizes: list[int], told: set[int]) -> str:
    """How much of a cell was looked at, in words."""
    partition = looking.graph.partition
    commands = [
        t
        for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True)
        if owner != SUPERVISOR and t.code is not None
    ]
    left = [f"`{t.name}`" for t in commands if t.index not in told]
    shown = f", not {', '.join(left[:MOST_NAMED])}" if left else ""
    more = f" and {len(left) - MOST_NAMED} more" if len(left) > MOST_NAMED else ""
    return (
        f"What is wrong was sought in parts of it, of {' and '.join(f'{n:,}' for n in sizes)} states: "
        f"{len(commands) - len(left)} of {len(commands)} transitions of robots and devices that have code segments are "
        f"under way in them{shown}{more}. A NO is certain; all else is about these parts alone"
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
