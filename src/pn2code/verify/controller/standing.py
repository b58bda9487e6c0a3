"""Where external axes can stand when a move begins that does not tell them: not every place is as good for a pose.

standing = Standing(arms)
for command in standing.complete("left", commands):   # of one transition, with what earlier ones of it have told axes
    ...
standing.ways("left", command)                  # the command with each place where the others can stand

An axis stands at HOME or where some command has told it to go, whatever the order of commands.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Protocol

from pn2code.robot.commands import Along, Move, MoveCircular, MoveHome, MoveJoint, MoveLinear

MOST_WAYS = 10_000
"""Ways to stand that are looked at for a move."""


class Axes(Protocol):
    """What is known of external axes."""

    def external_homes(self, robot: str) -> Mapping[str, tuple[Along, ...]]:
        """Of each axis where it begins, in each layout."""

    def undecided(self, robot: str, command: Move) -> frozenset[str]:
        """The axes on which it depends whether a move is possible, and which it does not tell."""


class Standing:
    """The places of all external axes."""

    def __init__(self, axes: Axes) -> None:
        self._axes = axes
        self._places: dict[tuple[str, str], dict[Along, None]] = {}

    def complete(self, robot: str, commands: Iterable[Move]) -> Iterator[Move]:
        """The moves of a transition, with what earlier ones of it have told axes that they depend on."""
        known: dict[str, Along] = {}
        for command in commands:
            if isinstance(command, MoveHome):
                continue
            for a in command.along:
                known[a.axis] = a
                self._of(robot, a.axis)[a] = None
            missing = self._axes.undecided(robot, command)
            told = tuple(known[axis] for axis in sorted(missing & known.keys()))
            yield replace(command, along=(*command.along, *told)) if told else command

    def _of(self, robot: str, axis: str) -> dict[Along, None]:
        key = (robot, axis)
        if key not in self._places:
            homes = self._axes.external_homes(robot).get(axis, ())
            self._places[key] = dict.fromkeys(homes)
        return self._places[key]

    def ways(self, robot: str, command: Move) -> list[Move] | None:
        """A move with each place where the axes can stand that it depends on; None: too many."""
        assert isinstance(command, MoveJoint | MoveLinear | MoveCircular), "others do not depend"
        missing = sorted(self._axes.undecided(robot, command))
        places = [list(self._of(robot, axis)) for axis in missing]
        out: list[Move] = []
        for chosen in itertools.islice(itertools.product(*places), MOST_WAYS + 1):
            out.append(replace(command, along=(*command.along, *chosen)))
        return out if len(out) <= MOST_WAYS else None
