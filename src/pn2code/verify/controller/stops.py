"""Where a robot's script stops because no transition fits: then the whole cell stops.

At a place the script decides among the transitions there (docs/tdl.md, "Translation"). It stops when none of them is
enabled and none waits for a message any more. When a transition *waits* follows from the order in which the script
asks. A message that it waits for before anything else (`awaited_first`) holds it back whatever the conditions are;
another one does where these are there, and what can be asked of them and of the robot's own data holds. What is asked
only when all messages are there holds nothing back before. Waiting is no step, so it becomes a *probe*: a transition
that never occurs, and while it is enabled holds back the stop, which comes last.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set

from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core import terms as core
from pn2code.ml.core.reals import may_hold_reals
from pn2code.ml.core.types import BOOL, TFun, tuple_of
from pn2code.net.builder import Arc
from pn2code.net.flat import ArcKind, BindEquation, FlatArc, FlatTransition, Form
from pn2code.net.uses import NetVariables
from pn2code.robot_scripts.analyse import analyse
from pn2code.robot_scripts.machine import Machine, Step
from pn2code.robot_scripts.translate import awaited_first
from pn2code.verify.controller.unsure import is_total


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
    program: Machine,
    step: Step,
    is_there: Callable[[int], list[Arc]],
    missing: Callable[[int], Arc],
    token: Callable[[int, str], core.Exp],
) -> Iterator[tuple[list[Arc], list[core.Exp]]]:
    """Arcs and guards of the probes of a transition: one for each message that may be missing.

    Args:
        partition: the cell.
        program: the robot's.
        step: the transition.
        is_there: more arcs of a message that is there.
        missing: an arc that tests that a message is missing.
        token: a new variable for a token of a place, with a name.
    """
    at = next(p for p, *_ in step.takes if p in program.control)
    taken = [p for p, *_ in step.takes if p in program.channels]
    first = awaited_first(partition, program, at) if taken else frozenset()
    for place in taken:
        if place in first:
            yield [Arc(ArcKind.INPUT, at, token(at, "control"), Form.TOKEN), missing(place)], []
    late = [p for p in taken if p not in first]
    if not late:
        return
    arcs, guards = _asked(partition, step.transition, set(late), is_there, token)
    for place in late:
        yield [missing(place), *arcs], guards


def _asked(
    partition: Partition,
    t: FlatTransition,
    late: Set[int],
    is_there: Callable[[int], list[Arc]],
    token: Callable[[int, str], core.Exp],
) -> tuple[list[Arc], list[core.Exp]]:
    """Arcs and guards of what a transition asks of its tokens without those of some places."""
    channels = {c.place for c in partition.channels}
    inputs = [a for a in t.arcs if a.kind in (ArcKind.INPUT, ArcKind.BOTH)]
    uses = NetVariables(partition.net.program.variables)
    kept = [a for a in inputs if a.place not in late]
    arcs: list[Arc] = []
    datatypes = partition.net.program.datatypes
    own = [a for a in kept if not _is_condition(a, datatypes)]
    known = _variables(uses, *(a.inscription.value for a in own if a.inscription))
    asked: list[tuple[core.Exp, core.Exp]] = []
    for i, a in enumerate(kept):
        assert a.inscription is not None
        value = a.inscription.value
        if _is_condition(a, datatypes):
            found = token(a.place, f"found{i}")
            asked.append((found, value))
            value = found
        arcs.append(Arc(ArcKind.INPUT, a.place, value, a.inscription.form))
        arcs += is_there(a.place) if a.place in channels else []
    for step in t.plan:
        if isinstance(step, BindEquation) and _variables(uses, step.value) <= known:
            known |= _variables(uses, t.guards[step.guard])
    guards = [g for g in t.guards if _variables(uses, g) <= known]
    # What depends on a missing message is not asked before it is there.
    of_arcs = (_equal(x, value) for x, value in asked if _variables(uses, value) <= known)
    return arcs, [*guards, *of_arcs]


def _is_condition(arc: FlatArc, datatypes: Mapping[str, core.DatatypeDec]) -> bool:
    """Whether the inscription says which token it must be by an expression that binds nothing and may raise."""
    inscription = arc.inscription
    if inscription is None or inscription.form is not Form.TOKEN:
        return False
    (term,) = inscription.terms
    value = inscription.value
    # Numbers of type `real` have no equality in CPN ML.
    return (
        term.pattern is None and not is_total(value) and not may_hold_reals(value.type, datatypes)
    )


def _equal(a: core.Exp, b: core.Exp) -> core.Apply:
    pair = tuple_of(a.type, a.type)
    function = core.Builtin("=", TFun(pair, BOOL), b.span)
    return core.Apply(function, core.RecordExp((("1", a), ("2", b)), pair, b.span), BOOL, b.span)


def _variables(uses: NetVariables, *expressions: core.Exp) -> set[int]:
    return {symbol.uid for symbol in uses.of(*expressions)}
