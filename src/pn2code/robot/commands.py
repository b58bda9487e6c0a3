"""What a robot can be told to do: small frozen values. The script interpreter makes them, an executor runs them.

All in SI units (m, rad, s); scripts and files use mm and degrees, converted once, in `pn2code.tdl`.
"""

from __future__ import annotations

from typing import Literal

from pn2code.base.frozen import frozen

Frame = Literal["world", "tool"]
Effect = Literal["takes", "releases", "creates", "removes"]
EFFECTS: tuple[Effect, ...] = ("takes", "releases", "creates", "removes")


@frozen
class Pose:
    """Position (m) and orientation (rad) of one frame in another: fixed-axis XYZ angles, R = Rz(rz) Ry(ry) Rx(rx)."""

    x: float
    y: float
    z: float
    rx: float
    ry: float
    rz: float


@frozen
class MoveJoint:
    """PTP to a TCP pose in the world frame; `speed` is the fraction (0..1] of the configured joint speed."""

    target: Pose
    speed: float = 1.0


@frozen
class MoveHome:
    """PTP to the robot's HOME joint position."""

    speed: float = 1.0


@frozen
class MoveLinear:
    """LIN: absolute in the world frame, or incremental in the tool frame as it stands at the beginning.

    `speed` in m/s; None: the configured linear speed.
    """

    target: Pose
    frame: Frame = "world"
    speed: float | None = None


@frozen
class Handling:
    """What an action does to a part, at its end.

    Args:
        effect: the tool takes it, or lets it go; or a part comes into the cell, or leaves it.
        part: the kind of part.
        place: where it comes or leaves, a name of `[places]`; "" for what a tool does: at its TCP.
    """

    effect: Effect
    part: str
    place: str = ""

    def __str__(self) -> str:
        """As in a script."""
        return f"{self.effect} {self.part}" + (f" at {self.place}" if self.place else "")


@frozen
class ToolAction:
    """An action of the end effector (drill, insert, ...) that takes `duration` seconds, and what it does to a part."""

    action: str
    duration: float
    handling: Handling | None = None


@frozen
class Measure:
    """Look at a reference; the result is its measured Pose in the world frame."""

    nominal: Pose


@frozen
class Wait:
    """Stand still for `duration` seconds."""

    duration: float


Command = MoveJoint | MoveHome | MoveLinear | ToolAction | Measure | Wait
