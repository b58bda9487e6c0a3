"""External axes: of a robot tracks and lifts that carry the arm, turntables that carry the work piece; of a device all
that moves (`devices`).

axes = read_axes(t, "left", base, folder)       # of [robots.left.axes]
axes.tracks, axes.tables

A robot's joint position has its tracks first (m), then the joints of its arm (rad), then its turntables (rad).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from pn2code.base.frozen import frozen
from pn2code.robot import codes
from pn2code.robot.commands import Pose
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.solid_objects import read_solids
from pn2code.robot.table_poses import read_pose
from pn2code.robot.transforms import Array, inverse, matrix_of, rotation_about

if TYPE_CHECKING:
    from pn2code.robot.table import Table


@frozen
class Belt:
    """What a belt has beside its length.

    Args:
        drives: belts of the same device that go on where it ends, and run with it.
        farthest: m: so far it may be told to run: its length, with that of those.
    """

    width: float
    stop: str = ""
    drives: tuple[str, ...] = ()
    farthest: float = 0.0


@frozen(eq=False)
class ExternalAxis:
    """A track or a turntable; m or rad.

    Args:
        is_track: it slides, its positions are m (mm in scripts); else it turns.
        T_base_axis: of a turntable its frame at zero, in the frame of the robot's `base`; of a track nothing.
        direction: unit vector, in `base` where the arm goes, or the z of a turntable in its frame.
        radius, height: of the plate of a turntable; objects: what is on it, in its frame.
        belt: of a belt, which runs on and on: its width and the place where a part stops it ("": nowhere); its commands
            say how far it runs, at most `upper`, its length. `objects` is its body, which stands.
    """

    name: str
    is_track: bool
    T_base_axis: Array
    direction: Array
    lower: float
    upper: float
    velocity: float
    acceleration: float
    jerk: float
    home: float
    radius: float = 0.0
    height: float = 0.0
    objects: tuple[SceneObject, ...] = ()
    belt: Belt | None = None

    @property
    def unit(self) -> str:
        """Of its positions in cell.toml."""
        return "m" if self.is_track else "degrees"

    @property
    def highest(self) -> float:
        """The greatest position that a command may name."""
        return self.upper if self.belt is None else self.belt.farthest

    def at(self, position: ArrayLike) -> Array:
        """Its frame after its own motion, in that of the robot's `base`; of positions (n,) all of them, (n, 4, 4)."""
        position = np.asarray(position, float)
        step = np.tile(np.eye(4), (*position.shape, 1, 1))
        if self.is_track:
            step[..., :3, 3] = position[..., None] * self.direction
        else:
            step[..., :3, :3] = rotation_about(self.direction, position)
        return np.asarray(self.T_base_axis @ step)

    def described(self) -> tuple[object, ...]:
        """All of it, in what can be compared."""
        numbers = (self.lower, self.upper, self.velocity, self.acceleration, self.jerk, self.home)
        place = (*self.T_base_axis.ravel().tolist(), *self.direction.tolist())
        return (
            self.name,
            self.is_track,
            place,
            numbers,
            self.radius,
            self.height,
            self.objects,
            self.belt,
        )


@frozen(eq=False)
class Clamp:
    """Two axes that are commanded as one: the jaws of a clamp, each half of its gap from the middle.

    Args:
        axis: what is commanded, the gap.
        jaws: the names of both axes.
        place: where a part is that it holds, a name of `[places]`; "": nothing is said.
        may_be_empty: whether it may close when none is there.
    """

    axis: ExternalAxis
    jaws: tuple[str, str]
    place: str = ""
    may_be_empty: bool = False


@frozen(eq=False)
class Externals:
    """The external axes of a robot, in the order of the file; of a device `tables` are all of them.

    Args:
        clamps: those of `tables` that are commanded together.
    """

    tracks: tuple[ExternalAxis, ...] = ()
    tables: tuple[ExternalAxis, ...] = ()
    clamps: tuple[Clamp, ...] = ()

    def __iter__(self) -> Iterator[ExternalAxis]:
        yield from self.tracks
        yield from self.tables

    def __bool__(self) -> bool:
        return bool(self.tracks or self.tables)

    def index(self, name: str, arm: int) -> int:
        """Where an axis is in the joint position of a robot whose arm has so many joints; KeyError: it has none."""
        for i, axis in enumerate(self.tracks):
            if axis.name == name:
                return i
        for i, axis in enumerate(self.tables):
            if axis.name == name:
                return len(self.tracks) + arm + i
        raise KeyError(name)

    def axis(self, name: str) -> ExternalAxis | None:
        """The one that is commanded by that name."""
        own = {jaw for c in self.clamps for jaw in c.jaws}
        named = (*(a for a in self if a.name not in own), *(c.axis for c in self.clamps))
        return next((a for a in named if a.name == name), None)

    def moved(self, name: str, position: float) -> Iterator[tuple[str, float]]:
        """The axes that one of that name moves, each with where it is then."""
        clamp = next((c for c in self.clamps if c.axis.name == name), None)
        if clamp is None:
            own = self.axis(name)
            driven = own.belt.drives if own is not None and own.belt is not None else ()
            yield from ((belt, position) for belt in (name, *driven))
        else:
            yield from ((jaw, position / 2.0) for jaw in clamp.jaws)

    @property
    def directions(self) -> Array:
        """Of the tracks, (tracks, 3)."""
        return np.array([a.direction for a in self.tracks]).reshape(-1, 3)


def read_axes(t: Table, robot: str, base: Pose, folder: Path) -> Externals:
    """The table `axes` of a robot; what is wrong is reported."""
    if not t.has("axes"):
        return Externals()
    named = t.table("axes")
    T_base_world = inverse(matrix_of(base))
    found = [
        axis
        for name, table in named.named(t.inner("axes"))
        if (axis := _axis(table, name, robot, T_base_world, folder)) is not None
    ]
    return Externals(
        tuple(a for a in found if a.is_track), tuple(a for a in found if not a.is_track)
    )


def _axis(
    t: Table,
    name: str,
    robot: str,
    T_base_world: Array,
    folder: Path,
) -> ExternalAxis | None:
    before = len(t.d.errors)
    kind = t.text("kind")
    if kind != t.data.get("kind", kind):
        return None  # what else there may be is not known
    is_track = kind == "track"
    factor = 1.0 if is_track else math.radians(1.0)
    numbers = {k: t.number(k) for k in ("from", "to", "home", "speed", "acceleration", "jerk")}
    for key in ("from", "to"):
        t.has(key)
    place, direction = np.eye(4), np.array([0.0, 0.0, 1.0])
    radius = height = 0.0
    objects: tuple[SceneObject, ...] = ()
    if is_track:
        direction = np.array(t.numbers("direction"))
        if not np.linalg.norm(direction) > 1e-9:
            t.wrong("direction", t.expected("direction"))
            direction = np.array([1.0, 0.0, 0.0])
        direction = direction / np.linalg.norm(direction)
    else:
        place = T_base_world @ matrix_of(read_pose(t, "pose"))
        radius, height = t.number("radius"), t.number("height")
        objects = read_solids(t.tables("objects"), folder)
    t.done()
    unit = "m" if is_track else "degrees"
    if len(t.d.errors) == before:
        if not numbers["from"] < numbers["to"]:
            t.wrong("to", "a number above `from`")
        elif not numbers["from"] <= numbers["home"] <= numbers["to"]:
            t.d.error(
                codes.ROBOT_VALUE,
                f"external axis `{name}` of robot `{robot}` begins at {numbers['home']:g} {unit}, outside "
                f"{numbers['from']:g} .. {numbers['to']:g}",
                t.at("home") if "home" in t.data else t.at(),
                hint="`home` is where it is when a run begins; without the key that is 0",
            )
    if len(t.d.errors) != before:
        return None
    lower, upper, home, *pace = (
        factor * numbers[k] for k in ("from", "to", "home", "speed", "acceleration", "jerk")
    )
    speed, acceleration, jerk = pace
    return ExternalAxis(
        name, is_track, place, direction, lower, upper, speed, acceleration, jerk, home,
        radius, height, objects,
    )  # fmt: skip
