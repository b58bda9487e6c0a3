"""Who may have to wait for others while it owes an answer, and where in the steps of the cell as it runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.cell.partition import SUPERVISOR
from pn2code.ml.core import terms as core
from pn2code.robot_scripts.machine import Machine, Step
from pn2code.verify.controller.running_steps import Steps
from pn2code.verify.controller.silence import Ready, Silence
from pn2code.verify.controller.unanswered import unanswered
from pn2code.verify.exploring.elements import colours


def silences(made: Steps) -> Iterator[Silence]:
    """Of each robot that may wait for others while it owes an answer."""
    for owner, owes in made.owes.items():
        program = made.machines[owner]
        states = []
        for place in program.control:
            ready = _ready(made, program, program.steps_from(place))
            if ready:
                states.append((place, ready))
        mine = [c.place for c in made.looked if c.writer == owner]
        if states:
            answers = tuple((place, made.seen[place]) for place in mine)
            who = made.partition.owners[owner].phrase
            awaited = tuple(_of_others(made, owner))
            steps = (*_before_waiting(made, owner), *made.clock)
            never = unanswered(program)
            yield Silence(who, owes, tuple(states), answers, steps, never, awaited)


def _ready(made: Steps, program: Machine, steps: Sequence[Step]) -> tuple[Ready, ...]:
    """When a script goes on that has come to where these are possible; empty: it waits for no message there."""
    needed = [[p for p, *_ in s.takes if p in program.channels] for s in steps]
    is_free = [_is_free(made, s) for s in steps]
    if not any(needed) or any(f and not n for f, n in zip(is_free, needed, strict=True)):
        return ()
    are_equal = len(set(map(frozenset, needed))) == 1
    found = []
    for s, messages, free in zip(steps, needed, is_free, strict=True):
        there = tuple((p, *_shown(made, p)) for p in messages)
        if are_equal or free:
            found.append(Ready(there))
        else:
            own = tuple(p for p, *_ in s.takes if p not in program.channels)
            found.append(Ready(there, s.transition.index, own))
    return tuple(found)


def _is_free(made: Steps, step: Step) -> bool:
    """Whether it can occur with whatever tokens there are."""
    bound: set[int] = set()
    for place, term, *_ in step.takes:
        colset = made.b.places[place].colset
        if colours(colset) == 1:
            continue
        match term.value:
            case core.Var(symbol=core.Symbol(uid=uid, colset=own)) if (
                uid not in bound and own is not None and own.resolved == colset.resolved
            ):
                bound.add(uid)
            case _:
                return False
    return not step.transition.guards


def _before_waiting(made: Steps, owner: int) -> Iterator[int]:
    """The steps of a program, but for its probes and those with which it stops."""
    first = len(made.partition.net.transitions)
    others = {*made.probes, *made.stops}
    for number, whose in enumerate(made.step_owner, first):
        if whose == owner and number not in others:
            yield number


def _of_others(made: Steps, reader: int) -> Iterator[str]:
    """The messages that a program gets from others than the supervisor, in words."""
    for c in made.partition.channels:
        if c.reader == reader and c.writer != SUPERVISOR:
            who = made.partition.owners[c.writer].phrase
            yield f"`{made.partition.net.places[c.place].short}` of {who}"


def _shown(made: Steps, place: int) -> tuple[int, ...]:
    return (made.out[place],) if place in made.out else ()
