"""Whether what stands on a part that a tool carries stays level enough on the whole way, and not at samples only.

level(robot, leg, riders)           # ("yes" | "no" | "unknown", why)

In a piece of the way nothing turns by more than its axes do together from the middle of the piece, on lines and arcs no
more than the line says. What leans less in the middle by that much leans less anywhere in the piece.
"""

from __future__ import annotations

import numpy as np

from pn2code.geometry.answers import Verdict
from pn2code.geometry.contents import Load
from pn2code.geometry.legs import Leg
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.part import carried_to
from pn2code.robot.riders import MOST_TILT, leaning, tilt
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.trajectories import JointTrajectory, LinearTrajectory, Trajectory

_MOST_PIECES = 4000
_SMALL = 1e-6
"""rad"""


def level(robot: CellRobot, leg: Leg, riders: Load) -> tuple[Verdict, str]:
    """Whether nothing leans too far."""
    path = leg.path
    if path is None:
        return "yes", ""
    turns = _turns(robot, path)
    pieces = [(i / 8.0, (i + 1) / 8.0) for i in range(8)]
    looked = 0
    while pieces:
        looked += len(pieces)
        if looked > _MOST_PIECES:
            return (
                "unknown",
                f"whether what it carries stays level is not known after {_MOST_PIECES:,} pieces",
            )
        middles = np.array([(a + b) / 2.0 for a, b in pieces])
        further = []
        for (a, b), q in zip(pieces, path.on_way(middles), strict=True):
            room = turns * (b - a) / 2.0 + _SMALL
            for part in riders:
                leans = tilt(part, carried_to(robot, q, part))
                if leans > MOST_TILT + _SMALL:
                    return "no", leaning(leg.robot, part.kind.name, leans)
                if not leans + room <= MOST_TILT:
                    if room < 4.0 * _SMALL:
                        return (
                            "unknown",
                            "it tilts what stands on what it carries as far as is permitted",
                        )
                    further += [(a, (a + b) / 2.0), ((a + b) / 2.0, b)]
                    break
        pieces = further
    return "yes", ""


def _turns(robot: CellRobot, path: Trajectory) -> float:
    """rad: how far the TCP turns at most on the whole way."""
    turning = np.array([not robot.arm.slides(i) for i in range(len(robot.arm.axes))])
    if isinstance(path, JointTrajectory):
        own = np.arange(len(turning)) < robot.kinematics.joints.stop
        return float(np.abs(path.turns)[turning & own].sum())
    if isinstance(path, AlongTrajectory):
        return float(path.led.line.angle + np.abs(path.delta)[turning].sum())
    return float(path.line.angle) if isinstance(path, LinearTrajectory) else 0.0
