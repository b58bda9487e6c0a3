"""Belts: how far they run.

told = until_stop(device, parts, command)       # as the command says, or until the first part comes to the stop

Where a belt has a stop, a place, it stops as soon as a part on it is as far along as the place. While one is there, it
does not run. Belts that run as one (`drives`) stop as one.
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


def line_of(device: CellRobot, axis: ExternalAxis) -> frozenset[str]:
    """What may run when this belt does, as `feeder/belt`: all belts of its line; of another axis that alone."""
    lines = [{a.name, *a.belt.drives} for a in device.belts if a.belt is not None]
    names = {axis.name}.union(*(line for line in lines if axis.name in line))
    return frozenset(f"{device.name}/{name}" for name in names)


def stopping(device: CellRobot, command: Command) -> dict[str, ExternalAxis]:
    """The belts that a command tells to run, of which one in their line has a stop.

    How far they run depends on the parts on them.
    """
    if not isinstance(command, MoveExternal):
        return {}
    told = {a.axis for a in command.along}
    return {
        a.name: a
        for a in device.belts
        if a.name in told and any(b.belt is not None and b.belt.stop for b in _moved(device, a))
    }


def told_to_run(device: CellRobot, command: Command) -> frozenset[str]:
    """The belts that a command tells to run, as `feeder/belt`, whether they do or a part waits at their stop."""
    if not isinstance(command, MoveExternal):
        return frozenset()
    told = {a.axis for a in command.along}
    run = (b for a in device.belts if a.name in told for b in _moved(device, a))
    return frozenset(f"{device.name}/{b.name}" for b in run)


def _moved(device: CellRobot, axis: ExternalAxis) -> list[ExternalAxis]:
    """A belt, and those that it drives."""
    names = [name for name, _ in device.axes.moved(axis.name, 0.0)]
    return [a for a in device.belts if a.name in names]


def _stopped(device: CellRobot, parts: Parts, told: Along, axis: ExternalAxis) -> Along:
    line = _moved(device, axis)
    most = told.position
    for belt in line:
        if belt.belt is None or not belt.belt.stop:
            continue
        frame = inverse(device.T_world_base @ belt.T_base_axis)
        stop = (frame @ matrix_of(parts.cell.places[belt.belt.stop]))[0, 3]
        for part in (p for b in line for p in parts.riders(f"{device.name}/{b.name}")):
            left = float(stop - (frame @ parts.world(part))[0, 3])
            if left > -part.kind.tolerance - parts.slack:
                most = min(most, max(left, 0.0))
    return replace(told, position=most)
