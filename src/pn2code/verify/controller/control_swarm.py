"""The checks of a cell by a swarm of searches in the cell as it runs (docs/verify.md, "Swarm").

    control = swarmed(partition, running, plan, limits, d, closed)

Searches look at single markings, so they find what one marking shows: a dead one that is no end, a script that stops, a
channel with two messages, a place beyond its capacity, an exception, a property that a marking violates. Each has its
run, and the token game plays it as the programs choose (`played`). Walks also look at all that follows a marking, where
that is little: if no end is in it, the cell is blocked although it goes on. That nothing was found is no answer: what
is *yes* here follows from the structure of the net. What needs the graph (the orders of firings) or values of tokens
(messages, poses, room for lists) is not asked.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.deadline import TimeIsOverError
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.properties import codes
from pn2code.semantics.game.token_game import GameError
from pn2code.semantics.values.data import MlException, MlLimit
from pn2code.trace.script import TraceRefusedError
from pn2code.verify.controller.control_answers import (
    OTHERS,
    Keeper,
    cell_answers,
    drawn,
    refusal,
    settled,
    silent,
    unknown,
)
from pn2code.verify.controller.control_questions import of_cell
from pn2code.verify.controller.control_types import (
    BOUNDED,
    CONFLUENT,
    FINITE,
    MEMORY,
    MESSAGES,
    REACH,
    Check,
    Control,
    Plan,
)
from pn2code.verify.controller.overtaking import is_in_order
from pn2code.verify.controller.ownership import ownership
from pn2code.verify.controller.played import Played, why_not
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring import nondeterminism
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits, Reduction
from pn2code.verify.exploring.programs import Sizes
from pn2code.verify.exploring.result import Exploration

_Holds = Callable[[Played], bool]
_ENDS, _STOPS = 0, 1
"""Rows of the answers about the cell, without the properties."""
_OPEN: Mapping[str, Any] = {"answer": "unknown", "why": "swarm", "trace": None}


def swarmed(
    partition: Partition,
    running: Running,
    plan: Plan,
    limits: Limits,
    d: Diagnostics,
    closed: Exploration | None,
) -> Control | None:
    """All checks, and what the searches say of properties; None after an error that was reported.

    Args:
        partition: the cell.
        running: the cell as it runs.
        plan: how; the questions of `plan.options.ending` end the swarm, and so do violated checks, if those are asked.
        limits: of the swarm.
        d: gets the errors.
        closed: what is known of the closed net.
    """
    count = len(plan.properties.properties)
    with tempfile.TemporaryDirectory(prefix="pn2code-") as name:
        options = replace(
            plan.options,
            sizes=Sizes.start(running.net, plan.storage),
            generated=None,
            traces=Path(name),
            graph=None,
            questions=of_cell(running, plan, by_markings=True),
            predicates=plan.properties.predicates,
            evidence=plan.evidence or Path(name),
            ending=(*_own_endings(plan), *(count + i for i in _check_endings(running, plan))),
            stem="cell",
        )
        own = replace(
            limits,
            traces=1,
            graph=True,
            reductions=(Reduction.TIME,) if partition.net.timed else (),
        )
        found = explore(running.net, plan.storage, own, d, options)
        if found is None:
            return None
        goals = [*_of_properties(plan), *_of_checks(running, plan)]
        padded = [*found.answers, *[_OPEN] * (len(goals) - len(found.answers))]
        said = [
            _looked_at(row, running, plan, limits, holds, d)
            for row, holds in zip(padded, goals, strict=True)
        ]
        answers, rows = tuple(said[:count]), said[count:]
        trap = rows.pop()
        rows[_ENDS] = _blocked(rows[_ENDS], trap, found)
        keep = Keeper(plan, running)
        if running.unsure is not None:
            rows = rows[:-1]
        checks = [
            *(unknown(one, {"why": "graphless"}) for one in (FINITE, BOUNDED, CONFLUENT)),
            *cell_answers(partition, found, rows, plan, keep, closed),
        ]
        if partition.channels:
            checks.append(unknown(MESSAGES, {"why": "colourless"}))
        checks.append(unknown(MEMORY, {"why": "colourless"}))
        poses = plan.poses(partition)
        if poses is not None and poses.moving:
            checks.append(unknown(REACH, {"why": "colourless"}))
        checks.append(ownership(partition))
        refused = refusal(partition, found, keep)
    if refused is not None:
        checks = [refused if c.name == refused.name else c for c in checks]
    why = nondeterminism.undetermined(partition.net)
    control = Control(
        partition,
        _certain(checks, why),
        found,
        running,
        answers=answers,
        closed=closed,
        late=plan.premises.replies.late or silent(running, rows),
        premises=plan.premises,
    )
    return settled(control)


def _certain(checks: Sequence[Check], why: str) -> tuple[Check, ...]:
    """Without what rests on random numbers."""
    return tuple(drawn(c, why) if why else c for c in checks)


# --- what ends it --------------------------------------------------------------------------------


def _own_endings(plan: Plan) -> Iterator[int]:
    """Of the properties that end a swarm those that are about the cell."""
    properties = plan.properties.properties
    yield from (i for i in plan.options.ending if not properties[i].of_net)


def _check_endings(running: Running, plan: Plan) -> Iterator[int]:
    """The rows of checks of which one that fails is enough."""
    if plan.checks:
        first = OTHERS + len(running.silences)
        last = first + len(running.partition.channels) + len(plan.capacities)
        trap = last + (running.unsure is not None)
        yield from (_ENDS, _STOPS, *range(first, last), trap)


# --- what a run has to come to -------------------------------------------------------------------


def _of_properties(plan: Plan) -> Iterator[_Holds | None]:
    """Of each property: nothing, since its run is looked at when it has got a name (`verdict.properties`)."""
    yield from (None for _ in plan.properties.properties)


def _of_checks(running: Running, plan: Plan) -> Iterator[_Holds | None]:
    """Of each row about the cell that a marking decides."""

    def beyond(place: int, most: int) -> _Holds:
        return lambda played: len(played.marking.places[place]) > most

    def is_stuck(played: Played) -> bool:
        final = running.partition.final_places
        is_over = bool(final) and len(played.marking.places[running.over]) > 0
        return played.is_dead() and not is_over

    yield is_stuck
    yield beyond(running.stopped, 0)
    yield from (None for _ in range(OTHERS - 2 + len(running.silences)))
    yield from (beyond(c.place, 1) for c in running.partition.channels)
    yield from (beyond(place, most) for place, most in plan.capacities.items())
    if running.unsure is not None:
        yield beyond(running.unsure, 0)
    yield lambda played: not played.may_reach(running.over)


def _looked_at(
    row: Mapping[str, Any],
    running: Running,
    plan: Plan,
    limits: Limits,
    holds: _Holds | None,
    d: Diagnostics,
) -> Mapping[str, Any]:
    """What a search says, if its run is one of the programs; else nothing is known."""
    if row["answer"] != "no":
        return row
    if row.get("trace") is None:
        return _OPEN
    trace = Path(row["trace"])
    if nondeterminism.undetermined(running.partition.net):
        return row  # the token game would draw other numbers, and its steps are others
    try:
        with limits.deadline.enforced():
            problem = why_not(running, plan.storage, trace, holds)
            if problem is None and not is_in_order(running, plan.storage, trace):
                return _OPEN  # whether scripts can overlook messages so is not known
    except TimeIsOverError:
        return row
    except MlLimit:  # the explorer has no such limit
        return row
    except (TraceRefusedError, GameError, OSError, ValueError, MlException) as error:
        problem = str(error)
    if problem is None:
        return row
    d.error(
        codes.EVIDENCE,
        f"a run that a swarm has found is none of the programs: {problem}",
        Origin(running.partition.net.file),
        hint="the explorer and the token game differ: this is a bug in pn2code",
    )
    return _OPEN


def _blocked(
    dead: Mapping[str, Any], trap: Mapping[str, Any], found: Exploration
) -> Mapping[str, Any]:
    """Of both answers about the end one, as the graph would have given it."""
    if dead["answer"] == "no":
        return {**dead, "why": "deadlock", "value": found.nodes}
    if trap["answer"] == "no":
        return {**trap, "why": "endless", "value": found.nodes}
    return {**dead, "why": dead.get("why") or "swarm"}
