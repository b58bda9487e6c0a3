"""What a part stands on: floor, things of the scene, plates of turntables, other parts.

    ground = Ground.of(cell)
    rest = ground.rest(kind, T_world_part, others, plates)
    rest.on                 # ("table", "box.1"): what is beneath it, with no more than a gap between
    rest.inside             # m: so far its middle is inside of the area on which it stands

Nothing here asks a collision library, so every backend knows the same. A part stands where something is at most
`REST_GAP` beneath its lowest face, and its middle is above the area where that is so: else it would tip over. What is
steeper than 45 degrees carries nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.carried import plate_of
from pn2code.robot.external import ExternalAxis
from pn2code.robot.geometry import Body, bodies
from pn2code.robot.hulls import (
    Face,
    Hull,
    around,
    face,
    inside,
    middle_of,
    overlap,
    part_below,
    shrunk,
)
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.transforms import Array, matrix_of

REST_GAP = 0.005
"""m: a part that is released may fall so far."""
SEARCHED = 0.5
"""m: what is further below is not told."""
ROUNDING = 1e-6
"""m: what is further away by no more is as far away: numbers of a net and of cell.toml add up so well."""
_STEEP = 0.7
"""Of the z of a normal: at most 45 degrees."""
_ANY = 0.1
EDGE = 1e-4
"""m: what lies over one another by no more does not carry anything."""
_UPRIGHT = 1e-4


@frozen(eq=False)
class Plate:
    """What takes parts along that stand on it: a turntable, a belt, another axis of a device.

    Args:
        robot: whose it is; axis: which of its axes.
        hulls: of it and what is on it, in its own frame.
        reach: m: nothing of it is further from its axis.
        upright: whether it turns about a line that is upright, so that what lies on it stays where it is.
        does: what it does when it moves, for messages.
    """

    robot: CellRobot
    axis: ExternalAxis
    hulls: tuple[Hull, ...]
    reach: float
    upright: bool
    does: str = "turns"

    @property
    def T_world_axis(self) -> Array:  # noqa: N802
        """Where the frame of its axis is, which stands."""
        return self.robot.T_world_base @ self.axis.T_base_axis


@frozen
class Rest:
    """How a part stands.

    Args:
        on: what is beneath it.
        below: the nearest thing below it, "": there is none within `SEARCHED`; gap: m to that.
        inside: m: how far its middle is inside of the area on which it stands; negative: outside.
    """

    on: tuple[str, ...]
    below: str
    gap: float
    inside: float

    def trouble(self, slack: float = 0.0) -> str:
        """Why it does not stand, as a clause; "": it does. `slack` (m): by how much it may be worse."""
        if not self.on:
            under = (
                f"`{self.below}`, the nearest thing below it, is {_shown(self.gap)} mm away"
                if self.below
                else f"there is nothing below it within {1000.0 * SEARCHED:g} mm"
            )
            return f"in the air: {under} (at most {1000.0 * REST_GAP:g} mm)"
        if self.inside < -slack:
            off = f", by {-1000.0 * self.inside:.1f} mm" if math.isfinite(self.inside) else ""
            names = " and ".join(f"`{x}`" for x in self.on)
            return f"where it tips over: its middle is not above what it stands on, {names}{off}"
        return ""


def _shown(gap: float) -> str:
    """A gap in mm that is too wide, with as many digits as tell it from what is permitted."""
    return next(
        text
        for digits in (1, 2, 3, 6, 12)
        if float(text := f"{1000.0 * gap:.{digits}f}") > 1000.0 * REST_GAP or digits == 12
    )


@frozen(eq=False)
class _Thing:
    name: str
    hull: Hull


class Ground:
    """All that stands in a cell, but for parts."""

    def __init__(self, cell: RobotCell) -> None:
        self._things = [_Thing(b.name, hull) for b in bodies(cell) for hull in _hulls(b)]
        extents = [t.hull.extent for t in self._things]
        self._low = np.array([low for low, _ in extents]).reshape(-1, 3)
        self._high = np.array([high for _, high in extents]).reshape(-1, 3)
        self.plates = dict(_plates(cell))
        self._kinds = {k.name: _shapes_of(k) for k in cell.parts.values()}
        self._tops: dict[int, Face | None] = {}

    @staticmethod
    @lru_cache(maxsize=8)
    def of(cell: RobotCell) -> Ground:
        """That of a cell, which is kept."""
        return Ground(cell)

    def radius(self, kind: str) -> float:
        """m: of a ball around the frame of a part of a kind."""
        return max(h.radius for h in self._kinds[kind])

    def corners_of(self, kind: str, frame: Array) -> Array:
        """Of the pieces of a part of a kind that is there, and of its frame, (n, 3)."""
        return np.vstack([frame[None, :3, 3], *(h.at(frame).corners for h in self._kinds[kind])])

    def middle(self, kind: PartKind, frame: Array) -> Array:
        """Where the middle of a part is, in the world."""
        return middle_of(self.placed(kind, frame))

    def placed(self, kind: PartKind, frame: Array) -> list[Hull]:
        """The pieces of a part that is there, in the world."""
        return [h.at(frame) for h in self._kinds[kind.name]]

    def pieces(self, thing: str) -> list[Hull]:
        """Of a thing of the scene, in the world; none: there is no such thing, or it moves."""
        return [t.hull for t in self._things if t.name == thing]

    def rest(
        self,
        kind: PartKind,
        frame: Array,
        others: Iterable[tuple[str, PartKind, Array]],
        plates: Mapping[str, Array],
        slack: float = 0.0,
    ) -> Rest:
        """How a part stands.

        Args:
            frame: `T_world_part`; others: the other parts that stand: name, kind, where.
            plates: where the turntables are, in the world.
            slack: m: what is so much further away, or overlaps by so much less, still counts.
        """
        hulls, others = self.placed(kind, frame), tuple(others)
        on: set[str] = set()
        areas: list[Array] = []
        below, gap = "", math.inf
        for hull in hulls:
            more, nearest, least = self._beneath(hull, others, plates, slack, areas)
            on |= more
            if least < gap:
                below, gap = nearest, least
        if gap > SEARCHED:
            below = ""
        area = around(np.vstack(areas)) if areas else np.zeros((0, 2))
        return Rest(tuple(sorted(on)), below, gap, inside(area, middle_of(hulls)[:2]))

    def _beneath(
        self,
        hull: Hull,
        others: Iterable[tuple[str, PartKind, Array]],
        plates: Mapping[str, Array],
        slack: float,
        areas: list[Array],
    ) -> tuple[set[str], str, float]:
        """What a piece stands on, and the nearest thing below it; `areas` gets where it does."""
        lowest = underside(hull)
        low, high = hull.extent
        half = float(hull.middle[2] - low[2])
        own_faces = [narrowed(x, EDGE - slack) for x in (lowest.core, lowest.polygon)]
        on: set[str] = set()
        below, gap = "", math.inf
        reach = REST_GAP + slack + ROUNDING
        for name, top in self._near(low, high, half, others, plates):
            found = []
            # What is round has a narrow face, and much that is nearly as low: its surface is between these two.
            for mine, other in zip(own_faces, (top.core, top.polygon), strict=True):
                common = overlap(mine, other)
                if len(common):
                    found.append((common, lowest.heights(common) - top.heights(common)))
            least = min((float(gaps.min()) for _, gaps in found), default=math.inf)
            if least <= -half:
                continue
            if least < gap:
                below, gap = name, least
            if least <= reach:
                on.add(name)
                areas += [part_below(common, gaps, reach) for common, gaps in found]
        return on, below, gap

    def _near(
        self,
        low: Array,
        high: Array,
        half: float,
        others: Iterable[tuple[str, PartKind, Array]],
        plates: Mapping[str, Array],
    ) -> Iterator[tuple[str, Face]]:
        """What could be beneath a box: its name, and its face that looks up."""

        def may(least: Array, most: Array) -> bool:
            across = (least[:2] <= high[:2]).all() and (most[:2] >= low[:2]).all()
            return bool(across and most[2] >= low[2] - SEARCHED and least[2] <= low[2] + half)

        if self._things:
            across = (self._low[:, :2] <= high[:2]).all(axis=1)
            across &= (self._high[:, :2] >= low[:2]).all(axis=1)
            across &= self._high[:, 2] >= low[2] - SEARCHED
            across &= self._low[:, 2] <= low[2] + half
            for i in np.flatnonzero(across).tolist():
                if i not in self._tops:
                    self._tops[i] = upside(self._things[i].hull)
                top = self._tops[i]
                if top is not None:
                    yield self._things[i].name, top
        for name, frame in plates.items():
            for own in self.plates[name].hulls:
                hull = own.at(frame)
                if may(*hull.extent) and (found := upside(hull)) is not None:
                    yield name, found
        for name, kind, frame in others:
            for hull in self.placed(kind, frame):
                if may(*hull.extent) and (found := upside(hull)) is not None:
                    yield name, found


def narrowed(polygon: Array, by: float) -> Array:
    """A polygon without its edge; as it is, if nothing else is left."""
    out = shrunk(polygon, by)
    return out if len(out) >= 3 else polygon


def _shapes_of(kind: PartKind) -> tuple[Hull, ...]:
    hulls = Hull.of(kind.shape)
    assert hulls, "cells with parts that are no bodies are refused"
    return hulls


def underside(hull: Hull) -> Face:
    """The face with which a piece stands on something."""
    lowest = face(hull, up=False, steep=_ANY, within=REST_GAP)
    assert lowest is not None, "some face of a convex piece looks down"
    return lowest


def upside(hull: Hull) -> Face | None:
    """The face on which something can stand; None: it is too steep."""
    return face(hull, up=True, steep=_STEEP, within=REST_GAP)


def _hulls(body: Body) -> Iterator[Hull]:
    for solid in body.solids:
        x, y, z = solid.size
        own = Hull.box((x, y, z)) if solid.kind == "box" else Hull.cylinder(x, z)
        yield own.at(matrix_of(solid.pose))
    look = body.hull
    if look is not None and look.file is not None:
        for found in Hull.around(look.file, look.scale, body.pieces):
            yield found.at(matrix_of(look.pose))


def _plates(cell: RobotCell) -> Iterator[tuple[str, Plate]]:
    for device in cell.devices:
        for axis in device.carrying:
            if axis.belt is None:
                yield f"{device.name}/{axis.name}", _plate(device, axis, "moves")
        for belt in device.belts:
            # Its body is a thing of the scene, which stands.
            width = belt.belt.width if belt.belt is not None else 0.0
            own_reach = float(np.hypot(belt.upper, width / 2.0))
            yield f"{device.name}/{belt.name}", Plate(device, belt, (), own_reach, True, "runs")
    for robot in cell.robots:
        for axis in robot.axes.tables:
            yield f"{robot.name}/{axis.name}", _plate(robot, axis, "turns", plate_of(axis))


def _plate(robot: CellRobot, axis: ExternalAxis, does: str, *more: SceneObject) -> Plate:
    hulls = []
    for thing in (*more, *axis.objects):
        hulls += [own.at(matrix_of(thing.pose)) for own in Hull.of(thing)]
    corners = np.vstack([np.zeros((1, 3)), *(h.corners for h in hulls)])
    reach = float(np.linalg.norm(corners if axis.is_track else corners[:, :2], axis=1).max())
    up = (robot.T_world_base @ axis.T_base_axis)[:3, :3] @ axis.direction
    # A line leads what stands on it along, however it is inclined.
    upright = axis.is_track or bool(abs(abs(float(up[2])) - 1.0) <= _UPRIGHT**2)
    return Plate(robot, axis, tuple(hulls), reach, upright, does)
