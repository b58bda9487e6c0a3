"""What may happen in one moment: sets of steps of a cell, of which the explorer says how long their runs are.

moments = Moments.of(partition, machines, others)
moments.sets()              # transitions, and how many of robots may follow each other

A run in lock-step stops where more than `MOST_AT_ONCE` commands are carried out, or messages exchanged, without time
passing. Each of its rounds has a transition of a robot, or a command of one. A transition whose commands surely take
time ends the moment of its robot, but not that of others: what stands before and after it in a run may still be one
moment, in which each robot has at most one such transition.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind
from pn2code.robot_scripts.machine import Machine, Step
from pn2code.tdl.interpret import MOST_AT_ONCE, MOST_OCCURRENCES
from pn2code.verify.controller.commands import Commands, seconds


@frozen
class Steps:
    """A set of steps.

    Args:
        transitions: their numbers in the net of the running cell.
        most: so many transitions of robots may follow each other in a run of them.
    """

    transitions: tuple[int, ...]
    most: int


@frozen
class Moments:
    """The sets.

    Args:
        scripts: steps for which a script surely neither waits nor carries out a command.
        alone: steps for which it may neither wait for a message nor take time, if moves take none.
        moving: whatever may take no time, if moves take time.
        still: the same, if moves take none.
    """

    scripts: Steps
    alone: Steps
    moving: Steps
    still: Steps

    @staticmethod
    def of(partition: Partition, machines: Sequence[Machine], others: Iterable[int]) -> Moments:
        """Those of a cell; `others`: the steps of its model that are no occurrences, without those of the clock."""
        moves, none = Commands(partition), Commands(partition, moves=False)
        surely = tuple(_alone(partition, machines, moves, surely=True))
        alone = tuple(_alone(partition, machines, none, surely=False))
        added = tuple(others)
        return Moments(
            Steps(surely, MOST_OCCURRENCES - 1),
            Steps(alone, MOST_AT_ONCE // _at_once(machines, none) - 1),
            _untimed(partition, machines, moves, added),
            _untimed(partition, machines, none, added),
        )

    def sets(self) -> tuple[Steps, ...]:
        """All of them, in the order of the questions."""
        return (self.scripts, self.alone, self.moving, self.still)


def _alone(
    partition: Partition, machines: Iterable[Machine], commands: Commands, *, surely: bool
) -> Iterator[int]:
    """Transitions of robots for which their scripts neither wait for a message nor carry out a command.

    A delay that is not zero lets a step of the clock come before what follows. One that is zero is a wait for no time,
    unless nothing but a zero is written there: a script that repeats it stands still in time, but does not stop.

    Args:
        partition: the cell.
        machines: its programs.
        commands: which commands take time.
        surely: whether only those count of which that is certain: a command may stand on a branch, a delay may be zero.
    """
    channels = {c.place for c in partition.channels}
    for program in machines:
        for step in program.steps:
            t = step.transition
            waits_for = any(a.place in channels and a.kind is not ArcKind.OUTPUT for a in t.arcs)
            action = None if t.code is None else t.code.action
            acts = action is not None and (
                commands.may_come(action) if surely else commands.must_come(action)
            )
            if not (waits_for or acts or (surely and _may_pause(step))):
                yield t.index


def _untimed(
    partition: Partition, machines: Sequence[Machine], commands: Commands, added: Sequence[int]
) -> Steps:
    """All steps but those whose commands surely take time."""
    timed: set[int] = set()
    robots = 0
    for program in machines:
        own = {
            s.transition.index
            for s in program.steps
            if s.transition.code is not None and commands.must_come(s.transition.code.action)
        }
        timed |= own
        robots += bool(own)
    untimed = [t.index for t in partition.net.transitions if t.index not in timed]
    # In one moment there are at most `robots` transitions that take time, and such a run before and after each. A round
    # may also have nothing but the beginning or the end of a script, or the supervisor's first cycle.
    rounds = MOST_AT_ONCE // _at_once(machines, commands) - len(machines) - 2
    return Steps((*untimed, *added), max(0, (rounds - robots) // (robots + 1)))


def _at_once(machines: Iterable[Machine], commands: Commands) -> int:
    """The most commands and waits of one transition that may take no time; 1 where it has none."""
    most = 1
    for program in machines:
        for step in program.steps:
            code = step.transition.code
            own = 0 if code is None else commands.at_once(code.action)
            most = max(most, own + _may_pause(step))
    return most


def _may_pause(step: Step) -> bool:
    """Whether a delay of a robot's transition becomes a wait, for however long."""
    delays = [e for outcome in step.outcomes for _, e in outcome.delays]
    delays += [] if step.transition.delay is None else [step.transition.delay]
    return any(seconds(e) != 0.0 for e in delays)
