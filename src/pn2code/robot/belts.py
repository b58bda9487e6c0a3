"""Belts: how far they run.

told = until_stop(device, parts, command)       # as the command says, or until the first part comes to the stop

Where a belt has a stop, a place, it stops as soon as a part on it is as far along as the place. While one is there, it
does not run.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.robot.commands import Along, Command, MoveExternal
from pn2code.robot.external import ExternalAxis
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import inverse, matrix_of


def until_stop(device: CellRobot, parts: Parts, command: Command) -> Command:
    """A command with belts that run as far as the parts on them let them."""
    belts = stopping(device, command)
    if not belts:
        return command
    assert isinstance(command, MoveExternal)
    along = tuple(
        _stopped(device, parts, a, belts[a.axis]) if a.axis in belts else a for a in command.along
    )
    return replace(command, along=along)


def stopping(device: CellRobot, command: Command) -> dict[str, ExternalAxis]:
    """The belts with a stop that a command tells to run: how far they do depends on the parts on them."""
    if not isinstance(command, MoveExternal):
        return {}
    told = {a.axis for a in command.along}
    return {
        a.name: a for a in device.belts if a.belt is not None and a.belt.stop and a.name in told
    }


def told_to_run(device: CellRobot, command: Command) -> frozenset[str]:
    """The belts that a command tells to run, as `feeder/belt`, whether they do or a part waits at their stop."""
    if not isinstance(command, MoveExternal):
        return frozenset()
    belts = {a.name for a in device.belts}
    return frozenset(f"{device.name}/{a.axis}" for a in command.along if a.axis in belts)


def _stopped(device: CellRobot, parts: Parts, told: Along, axis: ExternalAxis) -> Along:
    assert axis.belt is not None
    frame = inverse(device.T_world_base @ axis.T_base_axis)
    stop = (frame @ matrix_of(parts.cell.places[axis.belt.stop]))[0, 3]
    most = told.position
    for part in parts.riders(f"{device.name}/{axis.name}"):
        left = float(stop - (frame @ parts.world(part))[0, 3])
        if left > -part.kind.tolerance:
            most = min(most, max(left, 0.0))
    return replace(told, position=most)
