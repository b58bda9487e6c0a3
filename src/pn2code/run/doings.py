"""What the robots and devices of a run are doing, in words, for the messages with which a run ends."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.run.command_words import words
from pn2code.run.runner import RobotRunner


def doings(robots: Sequence[RobotRunner]) -> str:
    """What everybody was doing: script line, net transition, command."""
    parts = []
    for r in robots:
        if r.motion is None:
            parts.append(f"{r.name} at rest")
            continue
        parts.append(f"{r.at(r.line)}: {r.name}: {words(r.motion.command, _slides(r))}")
    return "under way: " + "; ".join(parts)


def stuck(robots: Sequence[RobotRunner], now: float) -> str:
    """For what everybody waits, where nothing will ever happen."""
    waits = [
        f"{r.name} waits for {' or '.join(r.waiting.names)} ({r.script}:{r.waiting.line})"
        if r.waiting
        else f"{r.name} has ended"
        for r in robots
    ]
    return (
        f"the cell is stuck at {now:.3f} s: the supervisor has nothing to do and waits for the robots, "
        + ", ".join(waits)
    )


def repeats_without_time(robots: Sequence[RobotRunner], now: float, commands: int) -> str:
    """Who goes on for ever without time passing, after so many commands."""
    busy = [r for r in robots if r.waiting is None and not r.finished]
    names = " and ".join(r.name for r in busy) or "a program"
    return (
        f"{names} carried out {commands:,} commands at {now:.3f} s without time passing: a script repeats "
        "commands that take no time"
    )


def _slides(robot: RobotRunner) -> tuple[bool, ...]:
    """Which axes of an arm slide."""
    return () if robot.arm is None else tuple(robot.arm.robot.kinematics.alone.slides.tolist())
