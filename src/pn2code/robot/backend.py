"""What shows and measures the robots: the protocol, and how to open one.

A backend holds no motion of its own: it puts robots at joint positions and answers questions about
them. So every backend gives the same trajectories.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Literal, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pn2code.base.frozen import frozen
from pn2code.robot.part import Part
from pn2code.robot.transforms import Array

ClearanceKind = Literal["robots", "scene", "self"]
Picture: TypeAlias = NDArray[np.uint8]
BackendName = Literal["fake", "bullet"]


@frozen
class Clearance:
    """The least distance of one group of parts.

    Args:
        kind: between robots, from a robot to the scene, or of a robot to itself.
        robot: the (first) robot.
        a: name of the part, "robot1/link_4"; b: of the other, "panel/skin".
        distance: m; negative when they overlap.
        allowed: overlap that is permitted between these two, m; None: they must keep apart.
        point: where, on `a`, in the world; other: the nearest point on `b`.
        stands: `a` stands on `b`, so the overlap is permitted on joint moves as well.
        second: between robots, the other one.
        rides: the robots of which only a turntable, or what stands on it, is near; plates: of each which one, of a
            device the axis on which it stands.
        is_early: the move leads to this contact, but is not near enough to touch anything yet, or no more.
        short: m, by how much less is permitted somewhere in the piece of a move in the middle of which this is.
    """

    kind: ClearanceKind
    robot: str
    a: str
    b: str
    distance: float
    allowed: float | None = None
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    other: tuple[float, float, float] = (0.0, 0.0, 0.0)
    stands: bool = False
    second: str = ""
    rides: tuple[str, ...] = ()
    plates: tuple[str, ...] = ()
    is_early: bool = False
    short: float = 0.0

    def permitted(self, *, is_free: bool) -> float | None:
        """The overlap that is permitted, m; `is_free`: on a joint move, which permits only what stands to do so."""
        return self.allowed if self.stands or not is_free else None

    @property
    def counts(self) -> bool:
        """Whether it is one of the distances that a run is judged by: no contact, or a deeper one than is permitted."""
        return self.allowed is None or self.distance < -self.allowed


def closest(items: Iterable[Clearance]) -> Iterator[Clearance]:
    """Of each kind and robot the nearest pair that must keep apart; and all permitted contacts."""
    best: dict[tuple[str, str], Clearance] = {}
    for c in items:
        if c.allowed is not None:
            yield c
            continue
        key = (c.kind, c.robot)
        if key not in best or c.distance < best[key].distance:
            best[key] = c
    yield from best.values()


BEFORE = 0.12
"""m: what is no further before a place belongs to what is looked at there."""


@frozen
class Camera:
    """Where a picture is taken from.

    Args:
        eye: position of the camera in the world, m; target: what it looks at.
        field_of_view: vertical, degrees.
    """

    name: str
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    field_of_view: float = 45.0


@frozen
class Beside:
    """What a part is near to.

    Args:
        name: of the other thing.
        distance: m; negative when they overlap.
    """

    name: str
    distance: float


class Backend(Protocol):
    """Robots at joint positions, parts, distances, pictures."""

    @property
    def name(self) -> BackendName:
        """Which one."""

    def set_joints(self, robot: str, q: Sequence[float] | Array) -> None:
        """Puts a robot at a joint position, rad."""

    def tcp(self, robot: str) -> Array:
        """`T_world_tcp` as the backend has it."""

    def clearances(self, limit: float) -> tuple[Clearance, ...] | None:
        """The closest pair of each kind and robot that is nearer than `limit` (m).

        Pairs that may touch (`allowed`) are listed as well, each on its own, when they are near. None:
        this backend does not measure distances.
        """

    def set_part(self, part: Part) -> None:
        """Shows a part where it is from now on: in the world, in the tool of a robot, or on a turntable."""

    def remove_part(self, name: str) -> None:
        """The part has left the cell."""

    def around(self, name: str, limit: float) -> tuple[Beside, ...] | None:
        """How near a part is to each thing, part and turntable that are nearer than `limit` (m).

        The arms are left out. None: this backend does not measure distances.
        """

    def light_zone(self, name: str) -> None:
        """Something was too fast in a zone: pictures show it so from now on."""

    def hidden(
        self, eye: tuple[float, float, float], points: Sequence[tuple[float, float, float]]
    ) -> int:
        """How many of some places something else hides from an eye: what is further before them than `BEFORE`."""

    def render(self, camera: Camera, width: int, height: int) -> Picture | None:
        """A picture (height, width, 3), 0..255; None: this backend has no eyes."""

    def close(self) -> None:
        """Releases what it holds; afterwards it must not be used."""


class BackendUnavailableError(Exception):
    """A backend that cannot be had here; the message says why and what to do (a user's matter)."""
