"""What an element of the graph of a cell is to somebody who asks how long things take."""

from __future__ import annotations

from enum import IntEnum

from pn2code.cell.partition import OwnerKind
from pn2code.geometry.graph import CLOCK, CellGraph


class Kind(IntEnum):
    """Kinds of elements."""

    STEP = 0
    """of a program that takes no time: it reads, publishes, rests, is over"""
    FIRING = 1
    """of the supervisor, which takes no time either"""
    TOLD = 2
    """of a robot or device: it takes the time of its commands"""
    ENDS = 3
    """the robots hear that the supervisor has finished: in lock-step what is under way is done to its end"""
    CLOCK = 4
    """one unit of model time goes by"""


def kinds(graph: CellGraph) -> list[Kind]:
    """That of each element, by its number."""
    owners = graph.partition.owners
    out = []
    for e in graph.elements:
        if e.owner == CLOCK:
            out.append(Kind.CLOCK)
        elif e.is_step:
            out.append(Kind.ENDS if e.transition == graph.running.ending else Kind.STEP)
        elif owners[e.owner].kind is OwnerKind.SUPERVISOR:
            out.append(Kind.FIRING)
        else:
            out.append(Kind.TOLD)
    return out


def stops(graph: CellGraph) -> frozenset[int]:
    """The states in which a script has stopped the cell."""
    return frozenset(i for i, m in enumerate(graph.marked) if graph.running.stopped in m)


def raises(graph: CellGraph) -> frozenset[int]:
    """The states in which a condition of a script may have raised an exception, which stops the cell."""
    return frozenset(i for i, m in enumerate(graph.marked) if graph.running.unsure in m)
