"""Stops of robots and devices, drawn at random: each works for a while, then stands until it is put right.

    stops = Stops({"robot1": Rate(between=600.0, lasting=30.0)}, seed=1)
    trajectory, seconds = stops.held_up("robot1", trajectory)       # seconds: of each stop on the way

Both times are exponential: how long a side works before it stops (only commands count), and how long it stands. A stop
comes in the middle of a command, and is over before the command goes on where it was. One seed gives one row of stops
for each side, whatever the others do.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.active_motion import Motion
from pn2code.robot.trajectories import Trajectory
from pn2code.robot.transforms import Array

MOST = 1000
"""Stops in one command: more are none that anybody means."""
_NUMBER = r"\d+(?:\.\d+)?"


@frozen
class Rate:
    """Mean seconds of work between two stops, and mean seconds that a stop lasts."""

    between: float
    lasting: float


def parse(text: str) -> tuple[str, Rate] | None:
    """`WHO:BETWEEN/LASTING`, as `robot1:600/30`; None: it is none, or a mean is 0."""
    found = re.fullmatch(rf"([^:]+):({_NUMBER})/({_NUMBER})", text.strip())
    if found is None:
        return None
    rate = Rate(float(found[2]), float(found[3]))
    return (found[1], rate) if rate.between > 0.0 and rate.lasting > 0.0 else None


class Stops:
    """Draws them, from one run to the next."""

    def __init__(self, rates: Mapping[str, Rate], seed: int) -> None:
        self._rates = rates
        self._random = {who: random.Random(f"{seed} stops {who}") for who in rates}
        self._left = {who: self._between(who) for who in rates}

    def _between(self, who: str) -> float:
        return self._random[who].expovariate(1.0 / self._rates[who].between)

    def held_up(self, who: str, trajectory: Trajectory) -> tuple[Trajectory, list[float]]:
        """A command with its stops, and how long each lasts (s)."""
        if who not in self._rates:
            return trajectory, []
        pauses: list[tuple[float, float]] = []
        worked = 0.0
        while self._left[who] < trajectory.duration - worked and len(pauses) < MOST:
            worked += self._left[who]
            lasting = self._random[who].expovariate(1.0 / self._rates[who].lasting)
            pauses.append((worked, lasting))
            self._left[who] = self._between(who)
        self._left[who] -= trajectory.duration - worked
        if not pauses:
            return trajectory, []
        return Paused(trajectory, tuple(pauses)), [seconds for _, seconds in pauses]


@frozen(eq=False)
class Paused:
    """A trajectory that stands for a while, once or more often.

    Args:
        pauses: when on its own clock, and for how long (s), in order.
    """

    trajectory: Trajectory
    pauses: tuple[tuple[float, float], ...]

    @property
    def duration(self) -> float:
        """Seconds, with the pauses."""
        return self.trajectory.duration + sum(seconds for _, seconds in self.pauses)

    def _own(self, times: Array) -> Array:
        """Times on the clock of the trajectory."""
        out = np.asarray(times, dtype=np.float64)
        for at, seconds in self.pauses:
            out = np.where(out <= at, out, np.maximum(at, out - seconds))
        return out

    def q(self, t: float) -> Array:
        """Joint position."""
        return self.trajectory.q(float(self._own(np.asarray(t))))

    def qd(self, t: float) -> Array:
        """Joint speed; while it stands, zero."""
        before = 0.0
        for at, seconds in self.pauses:
            if at + before <= t <= at + before + seconds:
                return np.zeros_like(self.trajectory.qd(at))
            before += seconds
        return self.trajectory.qd(float(self._own(np.asarray(t))))

    def sample(self, times: Array) -> Array:
        """Joint positions at many times."""
        return self.trajectory.sample(self._own(times))

    def fraction(self, t: float) -> float:
        """At which fraction of the way it is at a time."""
        return self.trajectory.fraction(float(self._own(np.asarray(t))))

    @property
    def length(self) -> float:
        """m: of the way on which the TCP is led."""
        return self.trajectory.length

    def on_way(self, s: Array) -> Array:
        """Joint positions at fractions of the way, which has no time in it."""
        return self.trajectory.on_way(s)


def paused(motion: Motion, now: float) -> Motion:
    """A motion that stands from now on, without end."""
    path = motion.trajectory
    inner, pauses = (path.trajectory, path.pauses) if isinstance(path, Paused) else (path, ())
    at = float(Paused(inner, pauses)._own(np.asarray(now - motion.began)))
    return replace(motion, trajectory=Paused(inner, (*pauses, (at, math.inf))))


def resumed(motion: Motion, now: float) -> Motion:
    """A motion that stands without end goes on now; any other is as it was."""
    path = motion.trajectory
    if not isinstance(path, Paused) or path.pauses[-1][1] != math.inf:
        return motion
    at = path.pauses[-1][0]
    before = sum(seconds for _, seconds in path.pauses[:-1])
    lasted = max(now - motion.began - before - at, 0.0)
    return replace(motion, trajectory=replace(path, pauses=(*path.pauses[:-1], (at, lasted))))
