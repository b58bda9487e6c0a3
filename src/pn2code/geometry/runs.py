"""Runs of the net that lead to a situation, as traces that can be repeated and drawn."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.geometry.graph import CLOCK, CellGraph
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game
from pn2code.trace.parties import EVIDENCE, VERIFY
from pn2code.trace.writing import TraceFile, TraceUnwritableError


@frozen
class Run:
    """A run.

    Args:
        steps: its length; the last `under_way` of them are what is under way, and need not have ended.
        transitions: the last ones.
        file: the trace; None: it could not be written.
    """

    steps: int
    under_way: int
    transitions: tuple[str, ...]
    file: Path | None


def write(
    graph: CellGraph,
    way: Sequence[int],
    under_way: Sequence[int],
    file: Path,
    initial: str | None,
) -> Run:
    """Plays the elements of a way, then what is under way, and writes the trace."""
    net = graph.partition.net
    game = Game(net, graph.storage, files=Files(None))
    elements = [graph.elements[i] for i in (*way, *under_way)]
    names: list[str] = []
    written: Path | None = file
    try:
        trace = TraceFile(file)
    except TraceUnwritableError:
        trace, written = TraceFile(None), None
    with closing(trace):
        trace.header(game, VERIFY, 1, initial)
        for e in elements:
            if e.owner == CLOCK:
                game.set_time(game.marking.time + 1)
                continue
            if e.is_step:
                continue
            t = net.transitions[e.transition]
            occurred = game.fire(BindingElement.make(t, graph.binding(e)), checked=False)
            trace.occurrence(game, occurred)
            names.append(t.name)
        trace.end(game.marking.time, EVIDENCE)
    return Run(len(names), len(under_way), tuple(names[-6:]), written)
