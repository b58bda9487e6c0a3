"""What of arms and devices is in a zone, and how fast it is there.

    watch = ZoneWatch(cell)
    watch.occupied("front", {"arm": q}, parts)          # whether an arm, or what it carries, is in it
    watch.too_fast({"arm": q}, {"arm": qd}, parts)      # TooFast, or None

Each link counts as the box around its shapes, so it may be a little larger than it is. No collision library is asked:
every backend knows the same.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from lxml import etree

from pn2code.base.frozen import frozen
from pn2code.robot.hulls import Hull
from pn2code.robot.part import Part, carried_to
from pn2code.robot.parts_table import PartKind
from pn2code.robot.placed_links import placed_links
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, inverse, matrix_of, rotation_xyz
from pn2code.robot.urdf import Urdf, hulls_of, mesh_file
from pn2code.robot.zones_table import Zone

_STEP = 1e-6
"""s: over which places are compared to know how fast they change."""
_ROUNDING = 1e-6
"""Of a speed: what is commanded as fast as may be in a zone is not too fast because numbers are rounded."""


@frozen(eq=False)
class _Box:
    """A link: the axis that moves it (0: none; one more than there are: the flange), its corners in that frame."""

    name: str
    axis: int
    corners: Array


@frozen(eq=False)
class TooFast:
    """A link that is faster in a zone than may be; `point`: of it, in the world."""

    zone: Zone
    robot: str
    link: str
    speed: float
    point: tuple[float, float, float]

    def words(self) -> str:
        """For people."""
        at = ", ".join(f"{1000.0 * v:.0f}" for v in self.point)
        most = self.zone.max_speed
        assert most is not None
        speed, allowed = _told_apart(1000.0 * self.speed, 1000.0 * most)
        return (
            f"`{self.link}` is {speed} mm/s fast at {at} mm, in zone `{self.zone.name}`, where "
            f"{allowed} mm/s are allowed"
        )

    @property
    def times(self) -> float:
        """So many times as fast as may be."""
        assert self.zone.max_speed is not None
        return self.speed / self.zone.max_speed


def is_faster(speed: Array, most: float) -> Array:
    """Whether speeds are above the greatest one that is allowed."""
    return np.asarray(speed > most * (1.0 + _ROUNDING))


def _told_apart(a: float, b: float) -> tuple[str, str]:
    """Two numbers with as many digits as it takes to see that they differ."""
    for digits in (1, 3, 6, 9):
        shown = f"{a:.{digits}f}", f"{b:.{digits}f}"
        if shown[0] != shown[1]:
            break
    return shown


class ZoneWatch:
    """Boxes around all links, and the zones."""

    def __init__(self, cell: RobotCell) -> None:
        self.cell = cell
        # Without zones nothing is asked, and meshes need not be read.
        moving, kinds = (cell.moving, cell.kinds) if cell.zones else ((), ())
        self._boxes = {r.name: tuple(_boxes(r)) for r in moving}
        self._kinds = {k.name: _corners(list(_of_kind(k))) for k in kinds}
        self._frames = {name: inverse(matrix_of(z.pose)) for name, z in cell.zones.items()}
        self.limited = tuple(z for z in cell.zones.values() if z.max_speed is not None)

    def placed(self, robot: str, q: Array, parts: Iterable[Part]) -> Iterator[tuple[str, Array]]:
        """Each link, and each part that goes with the robot: its name and its corners in the world, (8, 3)."""
        own = self.cell.robot(robot)
        frames = [np.eye(4), *(f[0] for f in own.kinematics.link_frames(np.asarray(q)[None]))]
        base = own.T_world_base
        for box in self._boxes[robot]:
            frame = base @ frames[box.axis]
            yield box.name, box.corners @ frame[:3, :3].T + frame[:3, 3]
        for part in parts:
            corners = self._kinds[part.kind.name]
            if part.carrier != robot or corners is None:
                continue
            frame = carried_to(own, q, part)
            yield f"{robot}/{part.name}", corners @ frame[:3, :3].T + frame[:3, 3]

    def boxes(self, robot: str) -> Iterator[tuple[str, int, Array]]:
        """Each link: its name, the axis that moves it as `placed_links` has it, its corners (8, 3) in that frame."""
        for box in self._boxes[robot]:
            yield box.name, box.axis, box.corners

    def part_box(self, kind: str) -> Array | None:
        """The corners of the box around parts of a kind, (8, 3), in their frame; None: they have no shape."""
        return self._kinds[kind]

    def off(self, zone: str, corners: Array) -> float:
        """m: how far a box is from a zone at least; negative: it is in it."""
        frame = self._frames[zone]
        own = corners @ frame[:3, :3].T + frame[:3, 3]
        return _off(own, np.array(self.cell.zones[zone].size) / 2.0)

    def gaps(self, zone: str, points: Array) -> Array:
        """m: how far points are from a zone; 0: they are in it."""
        frame = self._frames[zone]
        own = np.abs(points @ frame[:3, :3].T + frame[:3, 3])
        half = np.array(self.cell.zones[zone].size) / 2.0
        return np.asarray(np.linalg.norm(np.maximum(own - half, 0.0), axis=-1))

    def in_limited(self, joints: Mapping[str, Array], parts: Iterable[Part]) -> Iterator[str]:
        """Of which robots and devices something is in a zone where speeds are limited."""
        parts = tuple(parts)
        for name, q in joints.items():
            placed = (corners for _, corners in self.placed(name, q, parts))
            if any(self._is_in(z, corners) for corners in placed for z in self.limited):
                yield name

    def _is_in(self, zone: Zone, corners: Array) -> bool:
        """Whether a box is in a zone; balls around both tell it soon where they are far apart."""
        middle = (corners[0] + corners[7]) / 2.0
        away = middle - (zone.pose.x, zone.pose.y, zone.pose.z)
        across = math.dist(corners[0], corners[7]) + math.hypot(*zone.size)
        return math.hypot(*away) <= across / 2.0 + _STEP and self.off(zone.name, corners) <= 0.0

    def occupied(self, zone: str, joints: Mapping[str, Array], parts: Iterable[Part]) -> bool:
        """Whether an arm, or what it carries, is in a zone."""
        parts = tuple(parts)
        return any(
            self.off(zone, corners) <= 0.0
            for robot in self.cell.robots
            if robot.name in joints
            for _, corners in self.placed(robot.name, joints[robot.name], parts)
        )

    def too_fast(
        self, joints: Mapping[str, Array], speeds: Mapping[str, Array], parts: Iterable[Part]
    ) -> TooFast | None:
        """What is faster in a zone than may be there, with its fastest point; of several what is so most times.

        `speeds`: rad/s, m/s.
        """
        parts = tuple(parts)
        worst: TooFast | None = None
        for name, q in joints.items():
            qd = speeds.get(name)
            if qd is None or not np.any(qd):
                continue
            now = list(self.placed(name, q, parts))
            before, after = (
                [c for _, c in self.placed(name, q + s * _STEP * qd, parts)] for s in (-1.0, 1.0)
            )
            for i, (link, corners) in enumerate(now):
                fast = np.linalg.norm(after[i] - before[i], axis=1) / (2.0 * _STEP)
                for zone in self.limited:
                    assert zone.max_speed is not None
                    if (
                        is_faster(fast.max(), zone.max_speed)
                        and self.off(zone.name, corners) <= 0.0
                    ):
                        x, y, z = corners[int(fast.argmax())].tolist()
                        found = TooFast(zone, name, link, float(fast.max()), (x, y, z))
                        worst = found if worst is None else max(worst, found, key=lambda f: f.times)
        return worst


def _of_kind(kind: PartKind | ToolKind) -> Iterator[Hull | None]:
    """The shapes of a part or tool, in its frame; None: one cannot be read."""
    if isinstance(kind, PartKind):
        yield from Hull.of(kind.shape) or (None,)
        return
    tree = kind.tool.urdf
    for link in tree.links:
        frame = np.eye(4)
        for joint in tree.chain(link):
            frame = frame @ joint.T_parent_joint
        for hull in _shapes(tree, link):
            yield None if hull is None else hull.at(frame)


def unread(cell: RobotCell) -> Iterator[str]:
    """The links with a shape that cannot be read, so that nobody knows whether they are in a zone."""
    for tool in cell.tools.values():
        if any(shape is None for shape in _of_kind(tool)):
            yield tool.name
    for robot in cell.moving:
        for link, (tree, name) in _trees(robot).items():
            if any(shape is None for shape in _shapes(tree, name)):
                yield f"{robot.name}/{link}"


def _trees(robot: CellRobot) -> dict[str, tuple[Urdf, str]]:
    """Each link of a robot and its tool, in which file and under which name it is."""
    trees: dict[str, tuple[Urdf, str]] = {x: (robot.arm.urdf, x) for x in robot.arm.urdf.links}
    if robot.tool is not None:
        trees |= {f"tool_{x}": (robot.tool.urdf, x) for x in robot.tool.urdf.links}
    return trees


def _boxes(robot: CellRobot) -> Iterator[_Box]:
    trees = _trees(robot)
    for link, axis, frame in placed_links(robot):
        corners = _corners(list(_shapes(*trees[link])))
        if corners is not None:
            own = corners @ frame[:3, :3].T + frame[:3, 3]
            yield _Box(f"{robot.name}/{link}", axis, own)


def _shapes(tree: Urdf, link: str) -> Iterator[Hull | None]:
    """The collision shapes of a link, in its frame; None: one cannot be read."""
    element = next(e for e in tree.xml.findall("link") if e.get("name") == link)
    for collision in element.findall("collision"):
        try:
            hulls = tuple(_shape(collision.find("geometry"), tree)) or (None,)
            origin = collision.find("origin")
            frame = np.eye(4)
            if origin is not None:
                frame[:3, 3] = _numbers(origin.get("xyz", "0 0 0"))
                frame[:3, :3] = rotation_xyz(*_numbers(origin.get("rpy", "0 0 0")))
        except ValueError:  # what should be numbers is none
            hulls = (None,)
        for hull in hulls:
            yield hull.at(frame) if hull is not None else None


def _shape(geometry: etree._Element | None, tree: Urdf) -> Iterator[Hull]:
    """A shape, or its convex pieces; nothing: it cannot be read."""
    for shape in geometry if geometry is not None else ():
        match shape.tag:
            case "box":
                x, y, z = _numbers(shape.get("size", ""))
                yield Hull.box((x, y, z))
            case "cylinder":
                yield Hull.cylinder(float(shape.get("radius", "")), float(shape.get("length", "")))
            case "sphere":
                across = 2.0 * float(shape.get("radius", ""))
                yield Hull.box((across, across, across))
            case "capsule":  # `length` is that without its round ends
                across = 2.0 * float(shape.get("radius", ""))
                yield Hull.box((across, across, float(shape.get("length", "")) + across))
            case "mesh":
                scale = np.array(_numbers(shape.get("scale", "1 1 1")))
                for hull in Hull.around(mesh_file(shape, tree.path.parent), 1.0, hulls_of(shape)):
                    yield Hull(hull.corners * scale, hull.normals, hull.middle * scale)


def _numbers(text: str) -> tuple[float, float, float]:
    x, y, z = (float(w) for w in text.split())
    return x, y, z


def _corners(hulls: list[Hull | None]) -> Array | None:
    """Of the box around some shapes, (8, 3), in the order of `product`; None: there are none."""
    points = [h.corners for h in hulls if h is not None]
    if not points:
        return None
    found = np.vstack(points)
    return np.array(
        list(itertools.product(*zip(found.min(axis=0), found.max(axis=0), strict=True)))
    )


_TURNS = np.stack([np.cross(np.eye(3)[i], np.eye(3)) for i in range(3)])
"""Of `x`, `y`, `z`: `b @ _TURNS[i]` is the cross product of that with `b`."""


def _off(corners: Array, half: Array) -> float:
    """How far a box is at least from one around the origin with these half lengths."""
    edges = corners[[4, 2, 1]] - corners[0]
    axes = np.vstack([np.eye(3), edges, *(edges @ turn for turn in _TURNS)])
    long = np.sqrt(np.einsum("ij,ij->i", axes, axes))
    axes = axes[long >= 1e-9] / long[long >= 1e-9, None]
    along = corners @ axes.T
    reach = np.abs(axes) @ half
    return float(np.maximum(along.min(axis=0) - reach, -along.max(axis=0) - reach).max())
