"""What a robot can be told to do: small frozen values. The script interpreter makes them, an executor runs them.

All in SI units (m, rad, s); scripts and files use mm and degrees, converted once, in `pn2code.tdl`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from pn2code.base.frozen import frozen

Effect = Literal["takes", "releases", "creates", "removes", "couples", "uncouples"]
EFFECTS: tuple[Effect, ...] = (
    "takes",
    "releases",
    "creates",
    "removes",
    "couples",
    "uncouples",
)
CHANGES: tuple[Effect, ...] = ("couples", "uncouples")
"""Those of tools, which are in a rack or in use."""


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
class Along:
    """Where an external axis of the robot goes on a move: m of a track, rad of a turntable."""

    axis: str
    position: float
    is_track: bool


@frozen
class MoveJoint:
    """PTP to a TCP pose.

    Args:
        speed: the fraction (0..1] of the configured joint speed.
        frame: in which the pose is given: "world", or a name of `[frames]`.
        acceleration: the fraction (0..1] of the configured acceleration, as of all moves.
        along: external axes that move together with the arm, as of all moves but HOME; others stand still.
        tcp: which comes to the pose, a name of `[robots.NAME.tcps]` or a tool that must be in use, as of all moves to
            poses; "": that of the tool in use.
        arm_angle: rad, where the elbow of an arm with seven axes is at the end, as of all moves to poses; None: where
            the robot has it.
    """

    target: Pose
    speed: float = 1.0
    frame: str = "world"
    acceleration: float = 1.0
    along: tuple[Along, ...] = ()
    tcp: str = ""
    arm_angle: float | None = None


@frozen
class MoveAxes:
    """PTP to a joint position, rad (of axes that slide mm as if they were degrees); the rest as of `MoveJoint`."""

    axes: tuple[float, ...]
    speed: float = 1.0
    acceleration: float = 1.0
    along: tuple[Along, ...] = ()


@frozen
class MoveExternal:
    """External axes go somewhere, the joints of the arm stand still; the rest as of `MoveJoint`."""

    along: tuple[Along, ...]
    speed: float = 1.0
    acceleration: float = 1.0


@frozen
class MoveHome:
    """PTP to the arm's HOME joint position; external axes stay where they are."""

    speed: float = 1.0
    acceleration: float = 1.0


@frozen
class MoveLinear:
    """LIN: absolute in a frame, or incremental in the tool frame as it stands at the beginning.

    Args:
        frame: "world", "tool", or a name of `[frames]`; also of the poses on the way.
        speed: m/s; None: the configured linear speed.
        via: poses on the way, in order: the TCP goes on lines from one to the next, and does not stop.
        blend: m, how far before and behind them it leaves the lines at most; above 0 if there are any.
    """

    target: Pose
    frame: str = "world"
    speed: float | None = None
    acceleration: float = 1.0
    along: tuple[Along, ...] = ()
    tcp: str = ""
    arm_angle: float | None = None
    via: tuple[Pose, ...] = ()
    blend: float = 0.0


@frozen
class MoveCircular:
    """CIRC: on the arc through a place on the way to a pose; turning as a linear move does.

    Args:
        via: only its position matters.
        frame, speed: as of `MoveLinear`.
    """

    via: Pose
    target: Pose
    frame: str = "world"
    speed: float | None = None
    acceleration: float = 1.0
    along: tuple[Along, ...] = ()
    tcp: str = ""
    arm_angle: float | None = None


@frozen
class Handling:
    """What an action does to a part, or to a tool that can be changed, at its end.

    Args:
        effect: the tool takes it, or lets it go; or a part comes into the cell, or leaves it; or the coupling of the
            robot takes a tool, or lets it go.
        part: the kind of part, or the tool.
        place: where it comes or leaves, a name of `[places]`; "" for what a tool does: at its TCP.
    """

    effect: Effect
    part: str
    place: str = ""

    @property
    def is_of_tool(self) -> bool:
        """Whether it is a tool that is coupled or left, no part."""
        return self.effect in CHANGES

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


Move = MoveJoint | MoveAxes | MoveExternal | MoveHome | MoveLinear | MoveCircular
Command = Move | ToolAction | Measure | Wait


def without_pace(move: Move) -> Move:
    """The same move for all that differ only in how fast it is: where it leads."""
    if isinstance(move, MoveLinear | MoveCircular):
        return replace(move, speed=None, acceleration=1.0)
    return replace(move, speed=1.0, acceleration=1.0)


def tcp_of(command: Command) -> str:
    """The tool frame that a command refers to; "": that of the tool."""
    return command.tcp if isinstance(command, MoveJoint | MoveLinear | MoveCircular) else ""
