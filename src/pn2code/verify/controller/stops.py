"""Where a robot's script stops because no transition fits: then the whole cell stops.

At a place the script decides among the transitions there (docs/tdl.md, "Translation"). It stops when none of them is
enabled and none waits for a message any more. A transition *waits* when what it asks of the robot's own data and of the
messages that are there holds, and another of its messages is missing. Waiting is no step, so it becomes a *probe*: a
transition that never occurs, and while it is enabled holds back the stop, which comes last.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core import terms as core
from pn2code.net.builder import Arc
from pn2code.net.flat import ArcKind, BindEquation, FlatTransition
from pn2code.net.uses import NetVariables
from pn2code.robot_scripts.machine import Machine, analyse

MOST_MESSAGES = 4
"""Of one transition of a robot."""


class NoProgramError(Exception):
    """The page of a robot is no program; the text says whose."""


def machine(partition: Partition, owner: int) -> Machine:
    """A robot's part of the net.

    Raises:
        NoProgramError: it is not that of a program.
    """
    found = analyse(partition, partition.owners[owner], Diagnostics())
    if found is None:
        raise NoProgramError(
            f"the page of {partition.owners[owner].phrase} is not that of a program"
        )
    return found


def waits(
    partition: Partition,
    t: FlatTransition,
    is_there: Callable[[int], list[Arc]],
    missing: Callable[[int], Arc],
) -> Iterator[tuple[list[Arc], list[core.Exp]]]:
    """Arcs and guards of the probes of a transition: for each way in which some of its messages are missing.

    Args:
        partition: the cell.
        t: the transition.
        is_there: more arcs of a message that is there.
        missing: an arc that tests that a message is missing.
    """
    channels = {c.place for c in partition.channels}
    inputs = [a for a in t.arcs if a.kind in (ArcKind.INPUT, ArcKind.BOTH)]
    taken = [a.place for a in inputs if a.place in channels]
    uses = NetVariables(partition.net.program.variables)
    for count in range(1, len(taken) + 1):
        for absent in combinations(taken, count):
            kept = [a for a in inputs if a.place not in absent]
            arcs = [missing(place) for place in absent]
            for a in kept:
                assert a.inscription is not None
                arcs.append(Arc(ArcKind.INPUT, a.place, a.inscription.value, a.inscription.form))
                arcs += is_there(a.place) if a.place in channels else []
            known = _variables(uses, *(a.inscription.value for a in kept if a.inscription))
            for step in t.plan:
                if isinstance(step, BindEquation) and _variables(uses, step.value) <= known:
                    known |= _variables(uses, t.guards[step.guard])
            yield arcs, [g for g in t.guards if _variables(uses, g) <= known]


def _variables(uses: NetVariables, *expressions: core.Exp) -> set[int]:
    return {symbol.uid for symbol in uses.of(*expressions)}
